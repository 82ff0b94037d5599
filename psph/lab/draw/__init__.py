"""The scene of a case before it runs: a picture, and a page that turns in the browser."""
