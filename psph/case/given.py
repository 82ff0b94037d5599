"""Effects, kernels, motions and tables that a Python script gives a case, in place of a file beside it."""

import hashlib
from collections.abc import Iterator, Sequence
from types import CodeType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from psph.physics.catalogue import Catalogue

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


def _class(name: str) -> str:
    return name.removeprefix(PYTHON).rpartition("-")[0]


def _digest(kind) -> str:
    """Of the compiled methods of a class, its constants and parameters; the same in every process."""
    found = hashlib.sha256(repr((kind._fields, kind._field_defaults)).encode())
    for name, value in sorted(vars(kind).items()):
        code = getattr(getattr(value, "__func__", value), "__code__", None)
        if not name.startswith("_"):
            said = _code(code) if code else repr(value) if isinstance(value, PLAIN) else ""
            found.update(f"{name} {said}\n".encode())
    return found.hexdigest()[:12]


PLAIN = (int, float, str, bool)


def _code(code: CodeType) -> str:
    inner = [_code(one) if isinstance(one, CodeType) else repr(one) for one in code.co_consts]
    return repr((code.co_code, code.co_names, inner))
