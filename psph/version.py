"""The version of psph."""

__version__ = "0.2.0"
