"""Gauges of a run: each a table of its own, with its own interval."""

from psph.output.gauges.make import gauges_of

__all__ = ["gauges_of"]
