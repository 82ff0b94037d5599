"""The runs of a study: each done once, timed, and stored."""

import json
import statistics
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from psph.case import Case, CaseError, load
from psph.case.errors import dotted
from psph.engine.jit import SOURCES, processor
from psph.engine.threads import threads
from psph.errors import Unbearable
from psph.lab.study.ladder import SPACING, Settings, overrides
from psph.output.errors import OutputError
from psph.parallel.slabs import TooManyRanks
from psph.runs.busy import BUSY
from psph.runs.memory_check import TooLittleMemory
from psph.runs.start import Finished, run
from psph.runs.watch import Stopped
from psph.simulation.step import ParticleLost

ENOUGH = 10.0
"""Seconds: a run that has taken so long is not timed again."""

KEPT = "result.json"

DONE, LOST = "done", "lost"

TIMED = ("set_up", "stepping", "output")
"""The parts of a run whose seconds count."""


Make = Callable[[str, Sequence[str]], Case]
"""The case of a file, or of a script that gives it this name, with these keys changed.  Raises CaseError."""


def cases(file: str, given: list[str], every: list[Settings], make: Make = load) -> list:
    """The case of each run, or the CaseError that refuses it."""
    return [_case(file, [*given, *overrides(settings)], make) for settings in every]


def _case(file: str, sets: list[str], make: Make):
    try:
        end = make(file, sets).time.end
        return make(file, [f"output.frames={end!r}", *sets])  # of use here: the first and the last
    except CaseError as error:
        return error


ASIDE = (
    "title",
    "scheme",
    "profile",
    "output",
    "checkpoint",
    "guards",
    "parallel",
    "numbers",
    "study",
)
"""Tables and keys of a case that decide neither its answers nor, noticeably, its run time; what a
scheme and a profile set stands in the tables that they set it in."""


def conditions(case: Case | None) -> dict[str, object]:
    """Dotted keys of a case with the values that its errors and times hold for, as JSON has them.

    Without ``space.spacing``, along which both are known; empty without a case.
    """
    if case is None:
        return {}
    tables = case.model_dump(mode="json", by_alias=True, exclude_none=True)
    keys = dict(_dotted({name: table for name, table in tables.items() if name not in ASIDE}))
    del keys[SPACING]
    return keys


def _dotted(table: dict, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str, object]]:
    for name, value in table.items():
        here = (*path, name)
        if isinstance(value, list) and any(isinstance(one, dict) for one in value):
            value = dict(enumerate(value))
        if isinstance(value, dict):
            yield from _dotted(value, here)
        else:
            yield dotted(here), value


def perform(case, folder: Path, comm, repeats: int, say: Callable[[str], None]) -> dict:
    """Times and status of a run, from ``folder`` if it was done before; collective.

    A short run is repeated, and the one with the median of the seconds stands for all.
    """
    if isinstance(case, CaseError):
        return {"status": f"refused: {'; '.join(case.lines)}"}
    key = _key(case, comm)
    kept = comm.bcast(_kept(folder, key) if comm.rank == 0 else None)
    if kept:
        say("done before")
        return kept
    runs: list[Finished] = []
    try:
        while len(runs) < repeats and sum(map(_seconds, runs)) < ENOUGH:
            runs.append(run(case, folder, comm, overwrite=True, say=_warning(say)))
    except Unbearable as trouble:
        result = {"status": str(trouble), LOST: isinstance(trouble, ParticleLost)}
    except TooLittleMemory as trouble:
        return {"status": f"not possible here: {trouble}"}  # not kept: more may be free next time
    except Stopped as stopped:
        raise Stopped("stopped: the same command goes on after the runs that are done") from stopped
    except (CaseError, TooManyRanks) as trouble:
        result = {"status": f"refused: {trouble}"}
    else:
        result = _measured(runs, comm)
    if comm.rank == 0:
        _keep(folder, key, result)
    return result


def _measured(runs: list[Finished], comm) -> dict:
    """The figures of finished runs."""
    every = [_seconds(one) for one in runs]
    seconds = statistics.median_low(every)
    middle = runs[every.index(seconds)]
    steps = middle.simulation.steps
    return {
        "status": DONE,
        "particles": middle.particles,
        "steps": steps,
        "particle_steps": middle.particles * steps,
        "seconds": seconds,
        "seconds_spread": (max(every) - min(every)) / seconds if len(every) > 1 else None,
        "timed": len(every),
        "compiling_seconds": runs[0].compiling,
        **{f"{part}_seconds": getattr(middle, part) for part in TIMED},
        "bytes": comm.allreduce(middle.simulation.bytes_held()),
        "phases": comm.bcast(dict(middle.simulation.ledger.seconds)),
    }


def _seconds(one: Finished) -> float:
    """Seconds of the run without compiling."""
    return sum(getattr(one, part) for part in TIMED)


def _warning(say: Callable[[str], None]) -> Callable:
    """What a run of a study says: that its seconds are not those of a quiet machine, and nothing else."""

    def passed(line: str, where=None) -> None:
        if line.startswith(f"warning: {BUSY}"):
            say(line)

    return passed


def _key(case, comm) -> dict:
    """What a result depends on, psph's own sources included: it is used for no other."""
    text = case.model_copy(update={"study": type(case.study)(), "numbers": {}}).to_toml()
    return {
        "case": text,
        "sources": SOURCES,
        "used": case.versions,
        "processor": processor(),
        "ranks": comm.size,
        "threads": threads(),
    }


def _kept(folder: Path, key: dict) -> dict | None:
    try:
        kept = json.loads((folder / KEPT).read_text(encoding="utf-8"))
        return kept["result"] if kept["key"] == key else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _keep(folder: Path, key: dict, result: dict) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        beside = folder / f"{KEPT}.part"
        beside.write_text(json.dumps({"key": key, "result": result}, indent=1), encoding="utf-8")
        beside.replace(folder / KEPT)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}; choose another folder with --out") from None
