"""Files beside a case that bring effects, motions or regions of their own: the key ``use``."""

import hashlib
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from psph.case.errors import CaseError
from psph.case.parameters import last_part
from psph.smoothing import KERNELS

if TYPE_CHECKING:
    from psph.physics.catalogue import Catalogue

PREFIX = "psph_used_"
"""Modules of such files are named so: they are loaded once, however many cases use them."""


def catalogue_of(file: str, names: Sequence[str]) -> "Catalogue":
    """Everything that a case can ask for: what psph has, and what the files ``names`` bring.

    They stand in the folder of ``file``, the case, or below; each has a ``CATALOGUE`` of
    psph.physics.catalogue.  Raises CaseError with one line.
    """
    from psph.physics.catalogue import BUILT_IN, Catalogue

    found = BUILT_IN
    for name in names:
        more = getattr(_module(file, name), "CATALOGUE", None)
        if not isinstance(more, Catalogue):
            raise CaseError(
                [
                    f"{file}: use: {name} has no CATALOGUE; let it hold a Catalogue of "
                    "psph.physics.catalogue with what it brings"
                ]
            )
        for entry in more.kernels:
            _register(file, name, last_part(entry), entry.effect)
        found = found.with_more(more)
    return found


def _register(file: str, name: str, kernel: str, kind: type) -> None:
    """Let everything that takes kernels by name know this one."""
    if KERNELS.setdefault(kernel, kind).__qualname__ != kind.__qualname__:
        raise CaseError([f"{file}: use: {name} brings a kernel {kernel}, and there is one; rename it"])
    KERNELS[kernel] = kind


def files_of(file: str, names: Sequence[str]) -> list[Path]:
    """Where these files are."""
    return [Path(file).parent / name for name in names]


def versions(catalogue: "Catalogue") -> list[str]:
    """Names of the modules that files of a case brought, each with a digest of what stood in it."""
    brought = {entry.effect.__module__ for entries in catalogue for entry in entries}
    return sorted(name for name in brought if name.startswith(PREFIX))


def _module(file: str, name: str):
    path = Path(file).parent / name
    if Path(name).is_absolute() or ".." in Path(name).parts or path.suffix != ".py":
        raise CaseError(
            [f"{file}: use: {name} is not a Python file in the case's folder or below; put it there"]
        )
    try:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
    except OSError as error:
        raise CaseError([f"{file}: use: {path}: {error.strerror}; give a file that is there"]) from None
    named = f"{PREFIX}{path.stem}_{digest}"
    if named not in sys.modules:
        spec = importlib.util.spec_from_file_location(named, path)
        module = sys.modules[named] = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except Exception as error:  # whatever is wrong in the person's file
            del sys.modules[named]
            raise CaseError([f"{file}: use: {path}: {type(error).__name__}: {error}"]) from None
    return sys.modules[named]
