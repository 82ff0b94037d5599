"""Errors of the battery."""

from psph.errors import Refused


class BatteryError(Refused):
    """One line that says what to do."""
