"""Errors of a finished run: its files against an exact solution, an experiment or another run."""

import math
import tomllib
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import optimize

from psph.case.study import EXACT
from psph.fields import FLUID, GAS
from psph.lab.errors import StudyError
from psph.lab.study.experiment import read_experiment
from psph.lab.study.numbers import value_in, value_of
from psph.output.accuracy import NORMS
from psph.output.interpolation import interpolated
from psph.output.pictures.once import once, reads_of
from psph.output.reader import Run
from psph.runs.record import columns_of
from psph.scene import Scene
from psph.theory.solutions.catalogue import known

THEORY, FINEST = "theory", "finest"

AT_THE_END = ("velocity", "pressure", "density")
"""Fields that are compared particle by particle at the end of a run."""


class Judgement(NamedTuple):
    """Relative errors in three norms."""

    l1: float
    l2: float
    linf: float


class Judge:
    """The quantity and the reference of a case's errors; reads the files of its runs.

    ``what`` is a field at the end, a column of probes.csv or of a gauge, or a number of the case, ``against``
    the reference.  Raises StudyError where the case has no such thing.  ``files`` is the folder that its
    files lie in or below, where it is not that of the case.
    """

    def __init__(self, case, files: Path | None = None):
        self.case, self.files, study = case, files, case.study
        self.columns = columns_of(Scene(case))
        own = self._references_of(study.error)[:1] if study.error in case.numbers else []
        self.against = study.against or (*own, self._first_reference())[0]
        self.what = study.error or self._first_known()
        self._agree()

    @property
    def in_words(self) -> str:
        """``velocity at the end against the exact solution``."""
        names = {EXACT: "the exact solution", THEORY: "theory", FINEST: "the finest run"}
        at = " at the end" if self.what in AT_THE_END else ""
        if number := self.case.numbers.get(self.what):
            at = f" ({number.take} of {number.of})"
        less = f", less a shift in time of {self._longest_shift:g} s at most" if self._longest_shift else ""
        return f"{self.what}{at} against {names.get(self.against, f'experiment {self.against}')}{less}"

    def errors(self, folder: Path, finest: Path) -> tuple[Judgement, float]:
        """Of the run in ``folder``, and the shift in time, s, that is not in them; ``finest`` holds the run
        with the smallest spacing."""
        run = Run(folder)
        if self.what in AT_THE_END:
            return self._fields(run, finest), 0.0
        if self.what in self.case.numbers:
            return self._number(run, finest), 0.0
        table = run.measured(self.what)
        theirs, of_theirs = self._curve(run, finest)
        at = table["time"] if of_theirs is None else of_theirs  # None: known at any time
        at = at[window(self.case.study, at)]
        return shifted(lambda shift: value_at(at + shift, table, self.what), theirs(at), self._longest_shift)

    @property
    def _longest_shift(self) -> float:
        """The longest that is taken out of a curve, s."""
        over_time = self.what not in (*AT_THE_END, *self.case.numbers)
        return (self.case.study.shift or 0.0) if over_time else 0.0

    def _number(self, run: Run, finest: Path) -> Judgement:
        """The relative error of a number, in all norms."""
        asked = self.case.numbers[self.what]
        ours, theirs = value_of(asked, run), math.nan
        if self.against == THEORY:
            theirs = asked.theory
        elif self.against == FINEST:
            theirs = math.nan if run.folder == finest else value_of(asked, Run(finest))
        else:
            time, value = self.measured
            theirs = value_in(asked, [{"time": time, asked.of: value}])
        error = abs(ours / theirs - 1.0) if theirs else math.nan
        return Judgement(error, error, error)

    def _fields(self, run: Run, finest: Path) -> Judgement:
        if self.against == EXACT:
            last = {name: values[-1] for name, values in run.errors().items()}
            return Judgement(*(float(last[f"{self.what}_{norm}"]) for norm in NORMS))
        if run.folder == finest:
            return Judgement(math.nan, math.nan, math.nan)
        (x, ours, width), (*theirs, of_theirs) = (_fluid(r, self.what) for r in (run, Run(finest)))
        there = interpolated(*theirs, x, of_theirs, Scene(self.case).layout.periods)
        return series_errors(ours, there, (width / width.max()) ** x.shape[1])

    def _curve(self, run: Run, finest: Path) -> tuple[Callable, np.ndarray | None]:
        """The reference as a function of times, and the times at which it was measured."""
        if self.against == THEORY:
            name, _, field = self.what.partition(".")
            value = self.case.probes[name].theory[field]
            return (lambda t: np.full(len(t), value)), None
        if self.against == EXACT:
            return self._exact_curve(run), None
        if self.against == FINEST:
            if run.folder == finest:
                return (lambda t: np.full(len(t), math.nan)), None
            of_finest = Run(finest).measured(self.what)
            return (lambda t: value_at(t, of_finest, self.what)), None
        time, value = self.measured
        return (lambda t: np.interp(t, time, value)), time

    def _exact_curve(self, run: Run) -> Callable:
        name, _, quantity = self.what.partition(".")
        field, _, axis = quantity.partition("_")
        scene = Scene(self.case)
        x = np.array([self.case.probes[name].position])

        def at(t: float) -> float:
            [value] = getattr(scene.layout.exact, field)(x, t, scene.starts.setting)
            return float(value["xyz".index(axis)] if axis else value)

        return np.vectorize(at)

    @cached_property
    def measured(self) -> tuple[np.ndarray, np.ndarray]:
        """Times in s and values of the experiment, in the probe's unit.  StudyError: no such file,
        or no such columns."""
        return read_experiment(self.case, self.against, self.files)

    def _first_reference(self) -> str:
        if any(table is not None for _, table in self.case.exact):
            return EXACT
        for name in self.case.experiments:
            return name
        return THEORY if any(p.theory for p in self.case.probes.values()) else FINEST

    def _first_known(self) -> str:
        if self.against == EXACT:
            return known(Scene(self.case).layout.exact)[0]
        if self.against in self.case.experiments:
            return self.case.experiments[self.against].probe
        if self.against == THEORY:
            named = [f"{name}.{field}" for name, p in self.case.probes.items() for field in p.theory]
            return (*named, AT_THE_END[0])[0]
        return self.columns[0] if self.columns else AT_THE_END[0]

    def _agree(self) -> None:
        """StudyError where the reference does not fit what is compared."""
        file, what = self.case.file, self.what
        if what not in (*AT_THE_END, *self.columns, *self.case.numbers):
            names = ", ".join((*AT_THE_END, *self.columns, *self.case.numbers))
            raise StudyError(f"{file}: study.error: {what} is not measured; give one of {names}")
        known_here = self._references_of(what)
        if self.against not in known_here:
            raise StudyError(
                f"{file}: study.against: {self.against} has no {what}; give one of {', '.join(known_here)}"
            )
        if what not in AT_THE_END:
            self._agree_in_time()

    def _agree_in_time(self) -> None:
        """StudyError where no time is left at which a probe could be compared."""
        file, study, name = self.case.file, self.case.study, self.against
        last = min(self.case.time.end, math.inf if study.until is None else study.until)
        if study.after >= last:
            raise StudyError(
                f"{file}: study.after: {study.after:g} s leaves nothing to compare, since the comparison "
                f"ends at {last:g} s; give an earlier time"
            )
        if name not in self.case.experiments:
            return
        time, _ = self.measured
        if not ((time >= study.after) & (time <= last)).any():
            raise StudyError(
                f"{file}: experiments.{name}: measured from {time[0]:g} to {time[-1]:g} s, compared "
                f"from {study.after:g} to {last:g} s; correct its time_unit, study.after or time.end"
            )

    def _references_of(self, what: str) -> list[str]:
        """The references of the case that have ``what``."""
        if number := self.case.numbers.get(what):
            # One that is taken of two curves has no measured one beside it.
            alike = [n for n, e in self.case.experiments.items() if number.columns == (e.probe,)]
            return [*alike, *([] if number.theory is None else [THEORY]), FINEST]
        found = [n for n, e in self.case.experiments.items() if e.probe == what]
        solution = Scene(self.case).layout.exact
        name, _, quantity = what.partition(".")
        field = quantity.partition("_")[0] if quantity else what
        probe = self.case.probes.get(name)
        if solution and field in known(solution) and (probe or not quantity):
            found.append(EXACT)
        if probe and quantity in probe.theory:
            found.append(THEORY)
        return [*found, FINEST]


def window(study, time: np.ndarray) -> np.ndarray:
    """True at the times at which probes are compared."""
    until = math.inf if study.until is None else study.until
    return (time >= study.after) & (time <= until)


def known_values(table: dict[str, np.ndarray], column: str) -> tuple[np.ndarray, np.ndarray]:
    """Times in s and values of a column of a table, but for rows without fluid in reach (nan)."""
    known = np.isfinite(table[column])
    return table["time"][known], table[column][known]


def value_at(time: np.ndarray, table: dict[str, np.ndarray], column: str) -> np.ndarray:
    """A column of a table at some times (n,), s, on straight lines from row to row.

    NaN before the first row and after the last, and on lines with a row without fluid in reach at an end.
    """
    rows, values = table["time"], table[column]
    known = np.isfinite(values)
    if not known.any():
        return np.full(len(time), math.nan)
    unknown = np.interp(time, rows, ~known, left=1.0, right=1.0) > 0.0
    return np.where(unknown, math.nan, np.interp(time, rows[known], values[known]))


def shifted(ours: Callable[[float], np.ndarray], theirs: np.ndarray, longest: float):
    """The :class:`Judgement` of a curve, ``ours`` after a shift in time, s, against ``theirs`` (n,), with the
    shift of the least L2 error, of ``longest`` s at most; and that shift, s: how late the curve is.

    Points beyond either curve do not count, but half of those that count without a shift have to be left.
    """

    def judged(shift: float) -> tuple[Judgement, int]:
        own = ours(shift)
        both = np.isfinite(own) & np.isfinite(theirs)
        return series_errors(own[both], theirs[both]), int(np.count_nonzero(both))

    plain, count = judged(0.0)
    if not longest or not count:
        return plain, 0.0

    def cost(shift: float) -> float:
        found, left = judged(shift)
        return found.l2 if 2 * left >= count and found.l2 == found.l2 else math.inf

    tried = np.linspace(-longest, longest, 2 * SHIFTS + 1)
    nearest = tried[int(np.argmin([cost(one) for one in tried.tolist()]))]
    step = longest / SHIFTS
    ends = max(nearest - step, -longest), min(nearest + step, longest)
    best = float(optimize.minimize_scalar(cost, bounds=ends, method="bounded").x)
    best = min((best, float(nearest), 0.0), key=cost)
    return judged(best)[0], best


SHIFTS = 50
"""Shifts on either side that are tried first."""


def series_errors(ours: np.ndarray, theirs: np.ndarray, weight: np.ndarray | float = 1.0) -> Judgement:
    """Relative errors of a curve or a field, (n,) or (n, dim), over its points, each with its ``weight``.

    Σ|e|/Σ|f|, √(Σe²/Σf²) and max|e|/max|f|; NaN where there is none.
    """
    if not len(ours):
        return Judgement(math.nan, math.nan, math.nan)
    e, f = (np.linalg.norm(x.reshape(len(x), -1), axis=1) for x in (ours - theirs, theirs))
    with np.errstate(invalid="ignore", divide="ignore"):
        l2 = np.sqrt((weight * e * e).sum() / (weight * f * f).sum())
        l1 = (weight * e).sum() / (weight * f).sum()
        return Judgement(float(l1), float(l2), float(e.max() / f.max()))


def _fluid(run: Run, field: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions and values of the fluid, or gas, in the last frame, and the spacing of each, m; a gas has
    one."""
    case = tomllib.loads(run.case_text)
    frame = once(run.frame(-1, "position", field, *reads_of(case, saved=())), case)
    fluid = np.isin(frame["kind"], (FLUID, GAS))
    return frame["position"][fluid], frame[field][fluid], frame["width"][fluid]
