"""Motions of rigid things: poses, the parts that a motion is made of, and walls that move so."""
