"""Walls: friction, and walls that no fluid touches."""
