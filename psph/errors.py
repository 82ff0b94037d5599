"""Errors that a person can do something about: they end the command with one plain message."""

import re
import shlex

UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")
"""What breaks a line, steers a terminal or is no character: control codes and half characters."""

LONGEST_LINE, LONGEST_QUOTE = 1000, 100
"""Characters of a message, and of what it repeats of what a person wrote."""


def one_line(text: str) -> str:
    """A message that quotes what others wrote, as one line of bounded length."""
    plain = UNPRINTABLE.sub(lambda found: ascii(found[0])[1:-1], text)
    return shortened(plain, LONGEST_LINE)


def shortened(text: str, longest: int) -> str:
    """A text of no more than so many characters; dots stand for the rest."""
    return text if len(text) <= longest else f"{text[: longest - 4]} ..."


def typed(*words: object) -> str:
    """A command of psph as a person types it, whatever is in its words: a path with a blank is quoted."""
    return f"`python -m psph {shlex.join(map(str, words))}`"


class Foreseen(Exception):
    """Its message says what is wrong and what to do; ``exit_code`` is what the command returns."""

    exit_code = 1


class Refused(Foreseen, ValueError):
    """What was asked cannot be done; nothing was started."""

    exit_code = 2


class Failed(Foreseen, RuntimeError):
    """What was begun could not be brought to its end."""

    exit_code = 3


class Unbearable(Failed):
    """A run whose matter cannot go on, on any machine: where many cases run, others go on."""
