"""Errors of a case, one line each, with what to do."""

import difflib
from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from psph.errors import Refused, one_line, shortened

MOST_LINES = 100
"""More are left out."""

LONGEST_KEY = 60


class CaseError(Refused):
    """A case that cannot be run.  ``lines``: one message each, with file, key and what to do."""

    def __init__(self, lines: Iterable[str]):
        self.lines = [one_line(line) for line in islice(lines, MOST_LINES)]
        super().__init__("\n".join(self.lines))


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that ``word`` was likely meant to be, or None: the one that has it as a part."""
    by_lower_case = {name.lower(): name for name in known}
    whole = [name for name in by_lower_case if word.lower() in name.split("_")]
    if len(whole) == 1:
        return by_lower_case[whole[0]]
    near = difflib.get_close_matches(word.lower(), by_lower_case, n=1)
    return by_lower_case[near[0]] if near else None


def advise(word: str, known: Iterable[str]) -> str:
    """Name the nearest known word, those that are as near, or all of them where none is near."""
    known = list(known)
    if (near := nearest(word, known)) is None:
        return f"known here: {', '.join(known) or 'none'}"
    as_near = [one for one in known if _alike(word, one) == _alike(word, near)]
    return f"did you mean {' or '.join(repr(one) for one in as_near)}?"


def _alike(word: str, other: str) -> float:
    return difflib.SequenceMatcher(None, other.lower(), word.lower()).ratio()


def refuse_if_neither(word: str, commands: Iterable[str]) -> None:
    """Raise Refused where a word on the command line is neither a command nor a case file."""
    if word.endswith(".toml") or Path(word).exists():
        return
    case = Path(word).with_suffix(".toml") if Path(word).name.strip(".") else Path(word)
    advice = f"did you mean {case}?" if case.exists() else advise(word, commands)
    raise Refused(one_line(f"{word}: neither a command nor a case file; {advice}"))


def dotted(keys: Iterable[str | int]) -> str:
    """Keys and positions as a person writes them: ``perturbations[0].velocity``."""
    text = ""
    for key in keys:
        text += f"[{key}]" if isinstance(key, int) else f".{shortened(key, LONGEST_KEY)}"
    return text.removeprefix(".")


def with_points(value: tuple[float, ...], dimensions: int) -> str:
    """The guess that decimal commas have made too many numbers of a list; empty where they can not have.

    Without digits other than 0 behind such a comma it is rather a vector of three dimensions.
    """
    words, spare, seen = [f"{x:g}" for x in value], len(value) - dimensions, False
    for place in range(len(words) - 2, -1, -1):
        whole, part = words[place : place + 2]
        if spare > 0 and whole.lstrip("-").isdigit() and part.isdigit():
            words[place : place + 2] = [f"{whole}.{part}"]
            spare -= 1
            seen = seen or part != "0"
    return f"; a decimal comma? [{', '.join(words)}]" if seen and spare == 0 else ""
