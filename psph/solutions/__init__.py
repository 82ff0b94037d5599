"""Exact solutions: flows that are known at every place and time, to start from and to judge by."""
