"""Elastic solids: laws of stress, and what the pairs of a solid sum."""
