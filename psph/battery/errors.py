"""What was asked of the battery cannot be done."""


class BatteryError(ValueError):
    """One line that says what to do."""
