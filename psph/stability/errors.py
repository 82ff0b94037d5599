"""What was asked of the stability analysis cannot be done."""


class StabilityError(ValueError):
    """One line that names the option and says what to do."""
