"""Gauges on the frames of a run, and fields on planes and grids of points."""
