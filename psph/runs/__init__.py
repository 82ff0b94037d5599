"""A run's life: start, resume, guards, records, and what is said of it before and after."""
