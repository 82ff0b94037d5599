"""psph: smoothed particle hydrodynamics for free-surface flow, parallel over MPI."""

__version__ = "0.1.0"
