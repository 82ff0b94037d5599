"""What was asked of a study cannot be done."""


class StudyError(ValueError):
    """One line that names the option, the key or the file and says what to do."""
