"""The gallery of the documentation: a page with picture, film and text for each shipped case."""
