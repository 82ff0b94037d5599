"""What was asked of the stability analysis cannot be done."""

from psph.errors import Refused


class StabilityError(Refused):
    """One line that names the option and says what to do."""
