"""A case in Python: load or build it, change it, check it, ask what it will simulate."""

import re
from collections.abc import Iterable, Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, NamedTuple

from psph.api.changes import Changes, dotted, nested, texts
from psph.case.errors import CaseError
from psph.case.loader import checked, parts_of, tables_of

MESSAGE = re.compile(r"(?P<file>.*?\.toml)(?: with .*?)?: (?:(?P<key>[\w.*\[\]-]+): )?(?P<says>.*)")
"""Of a finding, as the command line prints it."""

OPTION = "the change"
"""What messages call a change that :meth:`Case.with_` made."""


class Finding(NamedTuple):
    """What a check found.  ``kind`` is "error" (the case cannot run) or "warning"; ``key`` the key of the
    case that it is about, empty where it is about several; ``says`` what is wrong and what to do; ``line``
    all of it, as the command line prints it."""

    kind: str
    key: str
    says: str
    line: str


class Case:
    """A case that is checked and complete: ``psph.load("drop.toml")``, or made from tables.

    ``tables`` hold what a case file holds; a key may be dotted: ``{"time.end": 0.5, "fluids": {...}}``.
    ``name`` is what its results are called, ``folder`` where the files that it names are.  A case never
    changes; :meth:`with_` makes another.  Raises CaseError with a line for every mistake.
    """

    def __init__(self, tables: Mapping[str, Any], name: str = "case", folder: str | Path = "."):
        self._set(str(Path(folder) / f"{name}.toml"), nested(tables))

    def _set(self, file: str, tables: dict, changes: tuple[str, ...] = (), option=OPTION, given=None):
        self._file, self._tables, self._changes = file, tables, changes
        self._option, self._given = option, given
        self.model = self.made(changes)
        """The case as psph's own modules take it: every key as an attribute, defaults filled in."""
        return self

    def made(self, changes: Sequence[str]):
        """The model with these changes in place of those that :meth:`with_` made; for psph's own modules."""
        return checked(self._file, deepcopy(self._tables), changes, self._option, self._given)

    @property
    def name(self) -> str:
        """What the files of its results are called."""
        return self.model.name

    @property
    def title(self) -> str:
        """What pictures and reports call it."""
        return self.model.title or self.model.name

    @property
    def file(self) -> str:
        """The file that it came from, or that it would have."""
        return self._file

    @property
    def changes(self) -> tuple[str, ...]:
        """What :meth:`with_` has changed since it was loaded, as ``key=value``."""
        return self._changes

    @property
    def brings(self) -> bool:
        """Whether it takes effects or the like from Python (:meth:`using`)."""
        return self._given is not None

    def __getitem__(self, key: str) -> Any:
        """The value of a key such as ``time.end`` or ``space.refine[0].factor``, defaults included; KeyError
        where there is none."""
        value: Any = self.model
        for name in parts_of(key):
            value = _inside(value, name)
            if value is KeyError:
                raise KeyError(f"{self.file}: {key}: no such key in this case")
        return value

    def with_(self, changes: Changes = (), /, **keys: Any) -> "Case":
        """This case with other values: ``case.with_({"time.end": 2.0})``, or ``case.with_(time__end=2.0)``.

        Two underscores stand for the dot.  None takes a key out.  Raises CaseError.
        """
        more = (*texts(changes), *texts(dict(dotted(keys))))
        made = Case.__new__(Case)
        return made._set(self._file, self._tables, (*self._changes, *more), self._option, self._given)

    def using(
        self,
        effects: Iterable = (),
        kernel: type | None = None,
        motions: Mapping[str, Any] | None = None,
        gauges: Iterable = (),
    ) -> "Case":
        """This case with physics of your own (docs/python.md), each a NamedTuple: ``effects`` that act,
        the smoothing ``kernel``, ``motions`` by the name of the wall that moves so, ``gauges`` that measure.
        """
        from psph.api.own import own

        given, changes = own(effects, kernel, motions or {}, gauges)
        if not any(given):
            return self
        if self._given:
            given = self._given.with_more(given)
        made = Case.__new__(Case)
        return made._set(self._file, self._tables, (*self._changes, *texts(changes)), self._option, given)

    def check(self, ranks: int = 1) -> list[Finding]:
        """What is wrong with the scene that the case describes; empty where all is well."""
        try:
            return [_finding("warning", line) for line in self.warnings(ranks)]
        except CaseError as error:
            return [_finding("error", line) for line in error.lines]

    def warnings(self, ranks: int = 1) -> list[str]:
        """What is doubtful, a line each.  Raises CaseError where the case cannot run."""
        from psph.runs.experiments import refuse_unfit_experiments
        from psph.runs.hints import plan_warnings
        from psph.scene import check
        from psph.simulation.plan import make_plan

        scene = self.scene()
        found = check(scene)
        refuse_unfit_experiments(scene)
        return [*found, *plan_warnings(scene, make_plan(scene), ranks)]

    def explain(self, ranks: int = 1):
        """What will be simulated, why, and at what cost, as data (:class:`psph.Explanation`); ``print`` shows
        it as the command line does."""
        from psph.api.explanation import explained

        return explained(self.scene(), ranks)

    def scene(self):
        """The particles to be, for those who work with psph's own modules (psph.scene.Scene)."""
        from psph.scene import Scene

        return Scene(self.model)

    def to_toml(self) -> str:
        """The case with all defaults, as a case file."""
        return self.model.to_toml()

    def save(self, path: str | Path) -> Path:
        """Write the case to a file that ``python -m psph`` runs; what it has from Python is not in it."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")
        return Path(path)

    def __repr__(self) -> str:
        changed = f" with {', '.join(self._changes)}" if self._changes else ""
        return f"<psph.Case {self._file}{changed}>"


def load(path: str | Path, changes: Changes = (), option: str = OPTION) -> Case:
    """The case in a TOML file, with ``changes`` as of :meth:`Case.with_`.

    Raises CaseError with a line for every mistake: file, key, what to do.
    """
    made = Case.__new__(Case)
    return made._set(str(path), tables_of(path), texts(changes), option)


def _finding(kind: str, line: str) -> Finding:
    found = MESSAGE.fullmatch(line)
    return Finding(kind, found["key"] or "", found["says"], line) if found else Finding(kind, "", line, line)


def _inside(value: Any, name: str) -> Any:
    """What a table or a list has by this name or at this place; KeyError itself where it has none."""
    if isinstance(value, Mapping):
        return value.get(name, KeyError)
    if isinstance(value, tuple) and name.isdigit():
        return dict(enumerate(value)).get(int(name), KeyError)
    return getattr(value, name, KeyError)
