"""Files beside a case that bring effects, motions or regions of their own: the key ``use``."""

import importlib.util
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from psph.case.errors import CaseError, advise
from psph.case.files import Unfit, beside
from psph.case.given import PYTHON
from psph.case.parameters import last_part
from psph.smoothing import KERNELS

if TYPE_CHECKING:
    from psph.physics.catalogue import Catalogue, Entry

PREFIX = "psph_used_"
"""Modules of such files are named so: they are loaded once, however many cases use them."""

OWN_TABLES = ("log", "probes", "errors")
"""What psph itself writes as NAME.csv (psph.output.tables)."""

OWN_KEYS = {"physics.sound_speed", "physics.equation_of_state"}
"""Keys of ``physics`` that call for no effect."""


def catalogue_of(file: str, names: Sequence[str], given: "Catalogue | None" = None) -> "Catalogue":
    """Everything that a case can ask for: psph's own, what the files ``names`` bring, what is ``given``.

    They stand in the folder of ``file``, the case, or below; each has a ``CATALOGUE`` of
    psph.physics.catalogue.  Raises CaseError with one line.
    """
    from psph.physics.catalogue import BUILT_IN, Catalogue

    catalogue, modules = BUILT_IN, {}
    for name in names:
        if not name.startswith(PYTHON):
            modules.setdefault(_module(file, name), name)  # a file named twice is one file
    brought = [(getattr(module, "CATALOGUE", None), name) for module, name in modules.items()]
    for more, name in [*brought, *([(given, "a Python script")] if given else [])]:
        if not isinstance(more, Catalogue):
            raise CaseError(
                [
                    f"{file}: use: {name} has no CATALOGUE; let it hold a Catalogue of "
                    "psph.physics.catalogue with what it brings"
                ]
            )
        for faults in map(_clash, Catalogue._fields, catalogue, more):
            for says in faults:
                raise CaseError([f"{file}: use: {name} brings {says}; rename it"])
        for says in _uncalled(more.effects):
            raise CaseError([f"{file}: use: {name}: {says}"])
        for entry in more.kernels:
            _register(file, name, last_part(entry), entry.effect)
        catalogue = catalogue.with_more(more)
    return catalogue


def origin(kind: type) -> Path | None:
    """The file that a case uses and that brought a class; None for what psph itself has."""
    module = sys.modules[kind.__module__]
    return Path(module.__file__) if module.__name__.startswith(PREFIX) else None


def _clash(group: str, there: "Sequence[Entry]", brought: "Sequence[Entry]") -> Iterator[str]:
    """What of a group of a catalogue has a name that something has already, in words.

    Several effects may answer to a key such as ``fluids.*.viscosity``, which is no table of their own.
    """
    taken = {_name(group, entry) for entry in there} - {""}
    if group == "effects":
        taken |= OWN_KEYS
    for entry in brought:
        name = _name(group, entry)
        bare = name.partition("=")[0]
        if group == "tables" and name.lower() in OWN_TABLES:
            yield f"{entry.key}, and psph writes {name.lower()}.csv itself"
        elif name in taken or bare in taken or any(one.startswith(f"{name}=") for one in taken):
            yield f"{entry.key}, and there is one"
        taken |= {name} - {""}


def _uncalled(effects: "Sequence[Entry]") -> Iterator[str]:
    """Methods of effects that nothing calls, and words that say nothing: a name that is not quite right would
    do nothing."""
    from psph.physics.catalogue import methods, methods_of_effects
    from psph.physics.walls.conditions import CORNERS

    known = methods_of_effects()
    for entry in effects:
        for method in methods(entry.effect):
            if method not in known:
                yield (
                    f"{entry.effect.__name__} has a method {method} that psph never calls: "
                    f"{advise(method, sorted(known))} Begin its name with _ if you call it yourself"
                )
        for attribute in ("acts", "refuses"):
            for word in getattr(entry.effect, attribute, ()):
                if word not in CORNERS:
                    yield (
                        f"{entry.effect.__name__}.{attribute}: '{word}' is no word of docs/acts.md; "
                        f"{advise(word, CORNERS)}"
                    )


def _name(group: str, entry: "Entry") -> str:
    """What must be one entry's alone; empty where several may share it."""
    if group != "effects":
        return last_part(entry)
    return "" if "*" in entry.key else entry.key


def _register(file: str, name: str, kernel: str, kind: type) -> None:
    """Let everything that takes kernels by name know this one."""
    if KERNELS.setdefault(kernel, kind).__qualname__ != kind.__qualname__:
        raise CaseError([f"{file}: use: {name} brings a kernel {kernel}, and there is one; rename it"])
    KERNELS[kernel] = kind


def versions(catalogue: "Catalogue") -> list[str]:
    """Names of the modules that files of a case brought, each with a digest of what stood in it."""
    brought = {entry.effect.__module__ for entries in catalogue for entry in entries}
    return sorted(name for name in brought if name.startswith(PREFIX))


def _module(file: str, name: str):
    try:
        path, digest = beside(Path(file).parent, name, "a Python file", (".py",))
    except Unfit as says:
        raise CaseError([f"{file}: use: {says}"]) from None
    named = f"{PREFIX}{path.stem}_{digest}"
    if named not in sys.modules:
        spec = importlib.util.spec_from_file_location(named, path)
        module = sys.modules[named] = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except (Exception, SystemExit) as error:  # whatever is wrong in the person's file
            del sys.modules[named]
            raise CaseError([f"{file}: use: {path}: {type(error).__name__}: {error}"]) from None
    return sys.modules[named]
