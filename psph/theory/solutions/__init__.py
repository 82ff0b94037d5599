"""Exact solutions: flows known at every point and time, for initial states and errors."""
