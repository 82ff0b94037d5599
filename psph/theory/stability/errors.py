"""Errors of the stability analysis."""

from psph.errors import Refused


class StabilityError(Refused):
    """One line that names the option and says what to do."""
