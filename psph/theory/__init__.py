"""Exact solutions, and the linear theory of lattices under pressure."""
