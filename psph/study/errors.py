"""What was asked of a study cannot be done."""

from psph.errors import Refused


class StudyError(Refused):
    """One line that names the option, the key or the file and says what to do."""
