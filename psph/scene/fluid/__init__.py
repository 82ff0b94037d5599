"""Fluids of a scene: their state at the start, what drives them, and what is likely a slip."""
