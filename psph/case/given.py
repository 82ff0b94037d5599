"""Effects, kernels, motions and tables that a Python script gives a case, in place of a file beside it."""

import hashlib
import re
from collections.abc import Iterator, Sequence
from types import CodeType
from typing import TYPE_CHECKING

from psph.case.errors import CaseError

if TYPE_CHECKING:
    from psph.physics.catalogue import Catalogue

HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")

PYTHON = "python:"
"""What ``use`` has before the name of a class that no file holds."""


def names_of(given: "Catalogue") -> list[str]:
    """What ``use`` says of each class: its name, and a digest of its formulas."""
    kinds = dict.fromkeys(entry.effect for entries in given for entry in entries)
    return [f"{PYTHON}{kind.__name__}-{_digest(kind)}" for kind in kinds]


def not_given(used: Sequence[str], given: Sequence[str]) -> Iterator[str]:
    """What a case uses from Python and is not there as it was, in words."""
    here = {_class(name): name for name in given}
    for name in used:
        if not name.startswith(PYTHON) or name in given:
            continue
        kind = _class(name)
        if kind in here:
            yield f"{kind} has another formula than the run began with; take the old one, or begin a new run"
        else:
            yield (
                f"{kind} came from a Python script, not from a file; go on in that script: "
                f"psph.resume(folder, effects=[{kind}])"
            )


def without_python(file: str, data: dict) -> list[str]:
    """Take out of the tables of a run's case what a script gave; what that was, in words.

    For those who read a run and do not go on with it.  Raises CaseError where it is the kernel, without which
    nothing is known of the particles.
    """
    used = [name for name in data.get("use", []) if str(name).startswith(PYTHON)]
    if used:
        data["use"] = [name for name in data["use"] if name not in used]
    for kind in map(_class, used):
        key = key_of(kind)
        if data.get("space", {}).get("kernel") == key:
            raise CaseError([f"{file}: space.kernel: {kind} came from a Python script, not from a file"])
        for table in ("physics", "tables"):
            data.get(table, {}).pop(key, None)
        for wall in data.get("walls", {}).values():
            wall.get("motion", {}).pop(key, None)
    return [f"{kind} came from a Python script and is left out here" for kind in map(_class, used)]


def key_of(name: str) -> str:
    """The key of a class: ``SurfaceCohesion`` is ``surface_cohesion``."""
    return HUMP.sub("_", name).lower()


def _class(name: str) -> str:
    return name.removeprefix(PYTHON).rpartition("-")[0]


def _digest(kind) -> str:
    """Of the compiled methods of a class, its constants and parameters; the same in every process."""
    digest = hashlib.sha256(repr((kind._fields, kind._field_defaults)).encode())
    for name, value in sorted(vars(kind).items()):
        code = getattr(getattr(value, "__func__", value), "__code__", None)
        if not name.startswith("_"):
            said = _code(code) if code else repr(value) if isinstance(value, PLAIN) else ""
            digest.update(f"{name} {said}\n".encode())
    return digest.hexdigest()[:12]


PLAIN = (int, float, str, bool)


def _code(code: CodeType) -> str:
    inner = [_code(one) if isinstance(one, CodeType) else repr(one) for one in code.co_consts]
    return repr((code.co_code, code.co_names, inner))
