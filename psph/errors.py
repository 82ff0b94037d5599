"""Errors that a person can do something about: they end the command with one plain message."""


class Foreseen(Exception):
    """Its message says what is wrong and what to do; ``exit_code`` is what the command returns."""

    exit_code = 1


class Refused(Foreseen, ValueError):
    """What was asked cannot be done; nothing was started."""

    exit_code = 2


class Failed(Foreseen, RuntimeError):
    """What was begun could not be brought to its end."""

    exit_code = 3
