"""Run a case from Python, go on with it, and look at it meanwhile."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from psph.api.case import Case, load
from psph.api.changes import Changes, texts
from psph.api.reading import Results
from psph.errors import Failed
from psph.parallel.reductions import largest, world

# The signatures of run and resume are written out, for help(), editors and mypy; tests/api keeps them alike.

Callback = Callable[["Moment"], Any]
"""Called on every rank; where any rank's returns True the run ends there, with a checkpoint."""


class Moment:
    """A run after a step, as a callback sees it: the particles of this rank, which may change until the next.

    ``moment["velocity"]`` is a copy of a field of this rank's particles, (n,) or (n, dim).
    """

    def __init__(self, simulation):
        self.simulation = simulation
        """The run itself, for those who work with psph's own modules (psph.simulation.step)."""

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.simulation.time

    @property
    def step(self) -> int:
        """Steps so far."""
        return self.simulation.steps

    @property
    def dt(self) -> float:
        """The last time step, s."""
        return self.simulation.dt

    @property
    def comm(self):
        """The communicator of the run, of mpi4py."""
        return self.simulation.comm

    @property
    def largest_speed(self) -> float:
        """Of any particle of a fluid or solid on any rank, m/s."""
        return self.simulation.fluid_speed

    def __getitem__(self, field: str) -> np.ndarray:
        return self.simulation.store.owned_rows(field)

    def largest(self, values) -> np.ndarray:
        """The largest of each value over all ranks; all of them must ask."""
        return largest(self.comm, values)


def run(
    case: Case | str | Path,
    out: str | Path | None = None,
    *,
    comm=None,
    overwrite: bool = False,
    quiet: bool = False,
    threads: int = 1,
    callback: Callback | None = None,
    every: float | None = None,
    effects: Iterable = (),
    kernel: type | None = None,
    motions: Mapping[str, Any] | None = None,
    gauges: Iterable = (),
) -> Results:
    """Simulate a case, and give its results; in a script that ``mpirun`` starts, on all ranks together.

    ``case`` is a :class:`psph.Case` or the path of a case file, ``out`` the folder of the results (default:
    the case's name), ``comm`` a communicator of mpi4py (default: all ranks that were started).  ``quiet``
    leaves out what the command line prints.  ``callback`` is called with a :class:`psph.Moment` after each
    step, or after the first step past each multiple of ``every`` s of simulated time.  ``effects`` and so on
    are as in :meth:`psph.Case.using`.  Raises Foreseen: CaseError before anything is run, and what stops
    a run.
    """
    from psph.runs import start

    comm = _ranks(comm, threads)
    loaded = case if isinstance(case, Case) else load(case)
    asked = loaded.using(effects, kernel, motions, gauges).model
    folder = Path(out or asked.name)
    start.run(asked, folder, comm, overwrite, _nothing if quiet else None, _after_step(callback, every))
    comm.Barrier()
    return Results(folder, asked.name)


def resume(
    folder: str | Path,
    extend: Changes = (),
    *,
    chosen: str | None = None,
    comm=None,
    quiet: bool = False,
    threads: int = 1,
    callback: Callback | None = None,
    every: float | None = None,
    effects: Iterable = (),
    kernel: type | None = None,
    motions: Mapping[str, Any] | None = None,
    gauges: Iterable = (),
) -> Results:
    """Go on with the run in ``folder`` from its newest checkpoint, or the ``chosen`` one, on any ranks.

    ``extend`` changes ``time.end``, or keys of output, checkpoint or guards.  What the run had from Python,
    ``effects`` and so on, is given again, as classes or as values (values are those of the run all the
    same).  The rest is as in :func:`psph.run`.
    """
    from psph.api.own import own
    from psph.runs import start

    comm = _ranks(comm, threads)
    given, _ = own(effects, kernel, motions or {}, gauges)
    say = _nothing if quiet else None
    after = _after_step(callback, every)
    start.resume(Path(folder), comm, texts(extend), chosen, say, after, given if any(given) else None)
    comm.Barrier()
    return Results(folder)


def _ranks(comm, threads: int):
    """The communicator of a run, each of its ranks on so many threads."""
    from psph.engine.threads import use_threads

    use_threads(threads)
    return world() if comm is None else comm


def _nothing(line: str, where=None) -> None:
    """Say nothing."""


def _after_step(callback: Callback | None, every: float | None):
    """The callback as a run takes it: when it is due, and what all ranks make of it."""
    if callback is None:
        return None
    due = 0.0

    def after(simulation) -> bool:
        nonlocal due
        if every is not None:
            if simulation.time < due:
                return False
            due = every * (np.floor(simulation.time / every * (1 + 1e-12)) + 1) * (1 - 1e-12)
        return _together(simulation, callback)

    return after


def _together(simulation, callback: Callback) -> bool:
    """Whether the callback of any rank wants the end.  An error of one rank ends all of them."""
    error, ends = None, False
    try:
        wanted = callback(Moment(simulation))
        ends = isinstance(wanted, (bool, np.bool_)) and bool(wanted)
    except Exception as raised:
        error = raised
    told = simulation.comm.allgather((ends, error and f"{type(error).__name__}: {error}"))
    if error:
        raise error
    for rank, (_, says) in enumerate(told):
        if says:
            raise Failed(f"the callback failed on rank {rank}: {says}")
    return any(ends for ends, _ in told)
