"""What was asked of the battery cannot be done."""

from psph.errors import Refused


class BatteryError(Refused):
    """One line that says what to do."""
