"""Kinds of matter that psph has, a room each: how they declare themselves (psph.kinds)."""
