"""A case from the first line to the last."""

import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from psph.output.errors import OutputError
from psph.output.frames import funnel_notice
from psph.output.ledger import Ledger
from psph.output.progress import Progress
from psph.output.tables import ERRORS, LOG, PROBES
from psph.parallel.slabs import check_ranks
from psph.particles.store import check_room
from psph.scene import Scene, check
from psph.solver.cost import cost_lines
from psph.solver.explain import slab_planes
from psph.solver.plan import make_plan
from psph.solver.record import Record
from psph.solver.setup import compile_ahead, create_particles
from psph.solver.step import Simulation

WORTH_SAYING = 1.0
"""Seconds of compilation from which on it is mentioned."""

Say = Callable[..., None]
"""A line, and the stream that it is meant for where that is not the standard output."""


class Finished(NamedTuple):
    """A run to its end, and what it cost in s: ``compiling``, ``set_up`` (the rest of the time
    before the first step), ``output`` and ``stepping`` without it, on rank 0."""

    simulation: Simulation
    particles: int
    compiling: float
    set_up: float
    stepping: float
    output: float


def run(case, folder: Path, comm, overwrite: bool = False, say: Say | None = None) -> Finished:
    """Simulate ``case`` on the ranks of ``comm`` and leave the files in ``folder``.

    ``say`` takes each line that is worth saying, on every rank; else rank 0 prints them, and shows
    how far the run is.  Raises CaseError, TooManyRanks, BlowUp or OutputError, each on every rank.
    """
    begun = time.perf_counter()
    lines, say = say is None, say or _speaker(comm)
    scene = Scene(case)
    for warning in check(scene):
        say(f"warning: {warning}", sys.stderr)
    check_ranks(comm.size, slab_planes(scene))
    particles = int(scene.counts().sum())
    check_room(particles, comm.size)
    _prepare_folder(case, folder, comm, overwrite)
    plan = make_plan(scene)
    say(f"psph: {case.title or case.name}: {particles:,} particles, {_ranks(comm.size)}")
    for line in filter(None, [funnel_notice(comm)]):
        say(line)
    compiling = compile_ahead(scene, plan, comm)
    if compiling > WORTH_SAYING:
        say(f"compiled in {compiling:.1f} s (kept for the next run)")
    simulation = Simulation(scene, plan, create_particles(scene, plan, comm), comm, Ledger())
    record = Record(scene, simulation, folder)
    record.write_due()
    starting = time.perf_counter() - begun
    say(f"first step after {starting:.1f} s")
    simulation.ledger.seconds.clear()  # the start is not a step
    stepping = time.perf_counter()
    progress = Progress(comm, case.time.end, case.title or case.name, particles, lines)
    try:
        while simulation.time < case.time.end:
            simulation.step()
            record.write_due()
            progress.update(simulation.time, simulation.steps, simulation.dt)
        record.write_last()
    finally:
        progress.close()
        record.close()
    whole = time.perf_counter() - stepping
    for line in _summary(scene, simulation, record, particles, whole):
        say(line)
    say(f"wrote {folder}/{case.name}.h5 and .xmf ({record.written} frames), {_tables(record)}")
    output = simulation.ledger.seconds["output"]
    return Finished(
        simulation, particles, compiling, starting - compiling, whole - output, output
    )


def _speaker(comm) -> Say:
    """Rank 0 speaks; the others are silent."""

    def say(line: str, where=None) -> None:
        if comm.rank == 0:
            print(line, file=where, flush=True)

    return say


def _ranks(size: int) -> str:
    return "1 rank" if size == 1 else f"{size} ranks"


def _prepare_folder(case, folder: Path, comm, overwrite: bool) -> None:
    """Make the folder and leave the case in it; a finished run is not overwritten unasked."""
    trouble = None
    if comm.rank == 0:
        try:
            if (folder / f"{case.name}.h5").exists() and not overwrite:
                trouble = f"{folder} holds a run of {case.name}: give --out or --overwrite"
            else:
                folder.mkdir(parents=True, exist_ok=True)
                for name in (LOG, PROBES, ERRORS, "*.png"):
                    for old in folder.glob(name):
                        old.unlink()
                (folder / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        except OSError as error:
            trouble = f"{folder}: {error.strerror}; choose another folder with --out"
    trouble = comm.bcast(trouble)
    if trouble:
        raise OutputError(trouble)


def _summary(
    scene, simulation: Simulation, record: Record, particles: int, seconds: float
) -> Iterator[str]:
    """What the run cost, where the time went on rank 0, and how right it is where that is known."""
    rate = particles * simulation.steps / seconds
    yield (
        f"{simulation.steps:,} steps in {seconds:.1f} s: {rate / 1e6:.2f} M particle-steps/s, "
        f"{simulation.domain.rebuilds} list rebuilds"
    )
    spent = dict(simulation.ledger.seconds)
    yield from cost_lines(simulation.plan, scene.periods, spent, seconds)
    if record.accuracy:
        yield f"error against the exact solution at {simulation.time:.6g} s: " + ", ".join(
            f"{name.replace('_', ' ')} {100.0 * error:.3g} %"
            for name, error in zip(record.accuracy.columns(), record.latest_errors)
        )


def _tables(record: Record) -> str:
    return ", ".join(table.path.name for table in record.tables)
