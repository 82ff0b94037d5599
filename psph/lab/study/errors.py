"""Errors of a study."""

from psph.errors import Refused, one_line


class StudyError(Refused):
    """One line that names the option, the key or the file and says what to do."""

    def __init__(self, message: str):
        super().__init__(one_line(message))
