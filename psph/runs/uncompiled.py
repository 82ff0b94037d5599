"""A formula of a user's file that the compiler refuses, in one line instead of its own hundred."""

import linecache
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
from numba.core.errors import NumbaError

from psph.engine.jit import PACKAGE
from psph.errors import Refused

PLACE = re.compile(
    r"(?:\bat (?P<at>/.+?\.py) \((?P<line>\d+)\))|(?:File \"(?P<file>.+?\.py)\", line (?P<row>\d+))"
)
"""How the compiler names a line: what is innermost comes first."""

BRANCH = re.compile(r"\b(if|elif|while|and|or|not)\b")

NOT_THEIRS = (PACKAGE, Path(numba.__file__).parent)
"""Sources that no user wrote."""


class Uncompiled(Refused):
    """A formula is written with what the compiler does not know."""


@contextmanager
def in_one_line() -> Iterator[None]:
    """Raise Uncompiled where the compiler refuses a line of a user's file; psph's own faults stay."""
    try:
        yield
    except NumbaError as error:
        if not (place := _place(str(error))):
            raise
        path, number = place
        line = linecache.getline(str(path), number).strip()
        raise Uncompiled(f"{path.name}: line {number}: `{line}` cannot be compiled: {_cure(line)}") from None


def _place(said: str) -> tuple[Path, int] | None:
    """The innermost line of a user's file that a message names."""
    for found in PLACE.finditer(said):
        path = Path(found["at"] or found["file"]).absolute()
        if path.exists() and not any(path.is_relative_to(folder) for folder in NOT_THEIRS):
            return path, int(found["line"] or found["row"])
    return None


def _cure(line: str) -> str:
    if BRANCH.search(line):
        return (
            "a formula of pairs is computed for several neighbours at once; use where(condition, a, b) of "
            "psph.formula, and & or | between conditions"
        )
    return (
        "use numbers and tuples with the operators, whole powers, min, max, abs, np.sqrt, np.exp, where() of "
        "psph.formula and the functions of psph.vectors (docs/recipes/effect.md)"
    )
