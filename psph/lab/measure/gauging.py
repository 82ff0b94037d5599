"""Gauges of a case, or new ones, on the frames of its run."""

import tomllib
from collections.abc import Iterable, Iterator, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from psph.case import CaseError
from psph.case.errors import advise
from psph.case.given import without_python
from psph.case.loader import checked, tables_of
from psph.errors import LONGEST_QUOTE, shortened
from psph.lab.errors import MeasureError
from psph.lab.measure.state import StoredState
from psph.output.checkpoint import COPY
from psph.output.gauges.make import gauge_of
from psph.output.progress import with_progress
from psph.output.reader import Run
from psph.scene import Scene
from psph.scene.gauging import inside_walls, off_parts, outside_domain
from psph.simulation.plan import make_plan

OPTION = "--gauge"

TOML = ".toml"
"""How the name of a file ends that has a table ``[gauges]``."""


class Readings(NamedTuple):
    """What gauges read on frames: the columns of each by its name, and why others could not be read, a line
    each; the ``case`` of the run with all that was asked for; and the names of gauges that are ``new``."""

    tables: dict[str, dict[str, np.ndarray]]
    refused: tuple[str, ...]
    case: Any
    new: tuple[str, ...] = ()


class _Wanted(NamedTuple):
    """Names of gauges, those that are new among them, and the case with them and the numbers."""

    names: tuple[str, ...]
    new: tuple[str, ...]
    case: Any


def readings(
    folder: Path,
    gauges: Iterable[str] = (),
    times: Sequence[float] | None = None,
    numbers: Sequence[str] = (),
) -> Readings:
    """What ``gauges`` read on the frames of the run in ``folder`` nearest to ``times`` s, or on all.

    Each is the name of a gauge of the case, ``NAME.KIND={...}`` as in TOML, or a TOML file with tables
    ``[gauges.NAME]``; none: all those of the case, or none where there are ``numbers``.  These are
    ``NAME={of=..., take=...}``.  What is read is what the run itself writes at these times, to the bit.
    Raises NotThere, CaseError, or MeasureError where frames do not hold what a gauge needs: of those of the
    case that were not named such ones are left out.
    """
    run, gauges = Run(folder), tuple(gauges)
    asked = _wanted(run, gauges, numbers)
    if numbers and not gauges:
        return Readings({}, (), asked.case)
    frames = range(len(run.times)) if times is None else run.nearest(times)
    if not len(frames):
        raise MeasureError(f"{run.path}: no frame yet; wait for the first one")
    scene = Scene(asked.case)
    plan = make_plan(scene)
    _refuse_misplaced(scene, asked.new)
    state, found = StoredState(run, scene, plan), _Found(scene, plan, asked, bool(gauges))
    moments = run.times
    for number in with_progress(list(frames), "measuring", "frames"):
        state.show(number, float(moments[number]))
        found.read(state)
        if not found.gauges:
            break
    if not found.gauges:
        raise MeasureError(found.refused[0])
    return Readings(found.tables(), tuple(found.refused), asked.case, asked.new)


class _Found:
    """The gauges that are read, their rows so far, and who was refused."""

    def __init__(self, scene, plan, asked: _Wanted, strict: bool):
        self.strict, self.refused = strict, list[str]()
        tables = scene.case.gauges
        self.gauges = {name: gauge_of(scene, name, tables[name]) for name in asked.names}
        self._columns = {name: gauge.columns(scene) for name, gauge in self.gauges.items()}
        self._rows: dict[str, list[list[float]]] = {name: [] for name in self.gauges}

    def read(self, state: StoredState) -> None:
        """A row of each."""
        for name, gauge in list(self.gauges.items()):
            try:
                row = [state.time, *map(float, gauge.row(state))]
            except MeasureError as error:
                line = f"gauges.{name}: {error}"
                if self.strict:
                    raise MeasureError(line) from None
                self.refused.append(line)
                del self.gauges[name]
            else:
                self._rows[name].append(row)

    def tables(self) -> dict[str, dict[str, np.ndarray]]:
        """Columns by their names, of each gauge."""
        return {
            name: dict(zip(["time", *self._columns[name]], np.array(self._rows[name]).T))
            for name in self.gauges
        }


def _wanted(run: Run, gauges: Sequence[str], numbers: Sequence[str]) -> _Wanted:
    """The gauges that are asked for, and the case of the run with those, and the numbers, that are new."""
    file = str(run.folder / COPY)
    data = tables_of(file)
    without_python(file, data)
    own = checked(file, deepcopy(data))
    names, new, changes = list[str](), list[str](), list[str]()
    for text in gauges:
        if "=" in text:
            new.append(text.partition("=")[0].strip().partition(".")[0])
            changes.append(f"gauges.{text.strip()}")
        elif text.endswith(TOML):
            further = _tables(Path(text))
            data["gauges"] = data.get("gauges", {}) | further
            new += further
        elif text not in own.gauges:
            says = advise(text, own.gauges) if own.gauges else "the case has none"
            raise MeasureError(
                f"{file}: {OPTION} {shortened(text, LONGEST_QUOTE)}: no gauge has this name: {says}; a new "
                f"one is written as {OPTION} 'NAME.level={{foot=[...], top=[...]}}'"
            )
        names.append(text)
    names = [n for n in names if n in own.gauges] + new if gauges else list(own.gauges)
    if not names and not numbers:
        raise MeasureError(
            f"{file}: the case has no gauges; give {OPTION} 'NAME.level={{foot=[...], top=[...]}}'"
        )
    changes += [f"numbers.{text.strip()}" for text in numbers]
    case = checked(file, data, changes, OPTION if gauges else "--number") if changes or new else own
    for name in new:
        _refuse_unsummed(own, case, name)
    return _Wanted(tuple(dict.fromkeys(names)), tuple(new), case)


def _tables(path: Path) -> dict[str, Any]:
    """The tables of new gauges in a file."""
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8")).get("gauges")
    except (OSError, ValueError) as error:
        raise MeasureError(f"{OPTION} {path}: {error}; give a TOML file with [gauges.NAME]") from None
    if not isinstance(found, dict) or not found:
        raise MeasureError(f"{OPTION} {path}: has no table [gauges.NAME]; add one")
    return found


def _refuse_unsummed(own, case, name: str) -> None:
    """A force where the run has not summed what pushes there: no frame can tell it."""
    before, now = (make_plan(Scene(one)).materials.loaded for one in (own, case))
    if now is not None and (before is None or (now & ~before).any()):
        raise MeasureError(
            f"{case.file}: {OPTION} {name}: sums over neighbours at each step, which the run has not made "
            "there; give the case this gauge and run it again"
        )


def _refuse_misplaced(scene: Scene, new: Sequence[str]) -> None:
    """CaseError with a line for each new gauge that looks where nothing can be."""
    begins = tuple(f"gauges.{name}." for name in new)
    every: Iterator[str] = (
        line for rule in (outside_domain, off_parts, inside_walls) for line in rule(scene)
    )
    if wrong := [f"{scene.case.file}: {line}" for line in every if line.startswith(begins)]:
        raise CaseError(wrong)
