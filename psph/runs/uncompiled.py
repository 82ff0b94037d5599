"""A formula of a user's file that fails or that the compiler refuses, in one line instead of a hundred."""

import linecache
import re
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
from numba.core.errors import NumbaError

from psph.case.extensions import PREFIX
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


def failed(error: BaseException) -> Uncompiled | None:
    """The line for what a formula has raised in a trial call; None where no file of a case is."""
    used = {module.__file__ for name, module in [*sys.modules.items()] if name.startswith(PREFIX)}
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if frame.filename in used:
            why = _cure(frame.line or "") if isinstance(error, TypeError) else str(error)
            name = Path(frame.filename).name
            return Uncompiled(f"{name}: line {frame.lineno}: `{frame.line}` cannot be computed: {why}")
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
