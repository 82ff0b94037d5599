"""A case from the first line to the last."""

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

from psph.case.running import Checkpoint
from psph.engine.jit import CACHE
from psph.errors import typed
from psph.kinds import count_of
from psph.output.checkpoint import Saved
from psph.output.frames import funnel_notice
from psph.output.ledger import Ledger
from psph.output.progress import Progress
from psph.output.reader import Run
from psph.output.xdmf import ENDING
from psph.parallel.slabs import check_ranks
from psph.particles.store import check_room
from psph.runs.busy import Busy
from psph.runs.cost import Spent, cost_lines, costs
from psph.runs.disk_check import check_disk
from psph.runs.experiments import refuse_unfit_experiments
from psph.runs.folder import alone_in, make_folder, prepare_folder, reopen_folder
from psph.runs.footprint import slab_planes
from psph.runs.guards import Guards
from psph.runs.hints import plan_warnings
from psph.runs.memory_check import check_memory, check_size
from psph.runs.record import Record
from psph.runs.resume import listed_particles, take_up, write_checkpoint
from psph.runs.setup import compile_ahead, create_particles
from psph.runs.summary import measured_lines, write_summary
from psph.runs.watch import Call, Stopped, Watch
from psph.scene import Scene, check
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

WORTH_SAYING = 1.0
"""Seconds of compilation from which on it is mentioned."""

Say = Callable[..., None]
"""A line, and the stream that it is meant for where that is not the standard output."""

AfterStep = Callable[[Simulation], bool]
"""Called on every rank after each step; where it says yes, on all ranks, the run ends there."""


class Finished(NamedTuple):
    """A run to its end, and what it cost in s: ``compiling``, ``set_up`` (the rest of the time
    before the first step), ``output`` and ``stepping`` without it, each of them as on rank 0."""

    simulation: Simulation
    particles: int
    compiling: float
    set_up: float
    stepping: float
    output: float


def run(
    case,
    folder: Path,
    comm,
    overwrite: bool = False,
    say: Say | None = None,
    after_step: AfterStep | None = None,
) -> Finished:
    """Simulate ``case`` on the ranks of ``comm`` and leave the files in ``folder``.

    ``say`` takes each line that is worth saying, on every rank; else rank 0 prints them, and shows
    how far the run is.  Raises CaseError, TooManyRanks, TooLittleMemory, BlowUp, OutputError or
    Stopped, each on every rank.
    """
    with ExitStack() as held, Watch(case.checkpoint) as watch:
        scene = Scene(case)
        check_size(scene, comm)
        warnings = check(scene)
        refuse_unfit_experiments(scene)
        for warning in warnings:
            (say or _speaker(comm))(f"warning: {warning}", sys.stderr)

        def prepare() -> None:
            make_folder(folder, comm)
            held.enter_context(alone_in(folder, comm))
            prepare_folder(scene, folder, comm, overwrite)

        return _simulate(scene, folder, comm, say, watch, prepare, after_step=after_step)


def resume(
    folder: Path,
    comm,
    extend: Sequence[str] = (),
    chosen: str | None = None,
    say: Say | None = None,
    after_step: AfterStep | None = None,
    given=None,
) -> Finished:
    """Go on with the run in ``folder`` from its newest checkpoint, or the ``chosen`` one.

    The ranks may be others than before: in the end the files hold the same as if it had never been
    stopped.  ``extend`` are keys ``time.end=...``, or of output or checkpoint; ``given`` is a
    catalogue of what a script brings (psph.case.given).  Raises what :func:`run` does, and CheckpointError.
    """
    with alone_in(folder, comm):
        case, saved = take_up(folder, comm, extend, chosen, given)
        with Watch(case.checkpoint) as watch:
            return _simulate(
                Scene(case),
                folder,
                comm,
                say,
                watch,
                lambda: reopen_folder(case, folder, saved),
                saved,
                after_step,
            )


def _simulate(
    scene,
    folder: Path,
    comm,
    say: Say | None,
    watch: Watch,
    prepare: Callable[[], None],
    saved: Saved | None = None,
    after_step: AfterStep | None = None,
) -> Finished:
    begun, case = time.perf_counter(), scene.case
    lines, say = say is None, say or _speaker(comm)
    check_ranks(comm.size, slab_planes(scene))
    plan = make_plan(scene)
    particles = count_of(scene)
    check_room(particles, comm.size)
    for warning in plan_warnings(scene, plan, comm.size):
        say(f"warning: {warning}", sys.stderr)
    check_memory(scene, plan, comm)
    check_disk(scene, plan, folder, comm, saved.state["time"] if saved else 0.0)
    prepare()
    say(f"psph: {case.title or case.name}: {particles:,} particles, {_ranks(comm.size)}")
    for line in filter(None, [funnel_notice(comm), CACHE.trouble]):
        say(line)
    compiling = compile_ahead(scene, plan, comm)
    if compiling > WORTH_SAYING:
        kept = "" if CACHE.trouble else " (kept for the next run)"
        say(f"compiled in {compiling:.1f} s{kept}")
    simulation, record = _begin(scene, plan, comm, folder, saved)
    if saved:
        say(f"resuming from {saved.path.name}: step {simulation.steps:,}, {simulation.time:.6g} s")
        if saved.foreign:
            say("warning: other sources of psph wrote it: the bits may be others from here on", sys.stderr)
    first = simulation.steps
    record.write_due()
    guards = Guards(scene, simulation, record, folder, lambda line: say(line, sys.stderr))
    starting = time.perf_counter() - begun
    say(f"first step after {starting:.1f} s")
    simulation.ledger.seconds.clear()  # the start is not a step
    stepping = time.perf_counter()
    with ExitStack() as at_last:
        at_last.callback(record.close)
        progress = Progress(comm, case.time.end, case.title or case.name, particles, lines)
        at_last.callback(progress.close)
        simulation.request = watch.call
        watch.begin_steps()
        busy = Busy(comm)
        while simulation.time < case.time.end:
            if warning := busy.step(guards.step):
                say(f"warning: {warning}", sys.stderr)
            record.write_due()
            progress.update(simulation.time, simulation.steps, simulation.dt, simulation.fluid_speed)
            _attend(simulation, record, watch, case, folder)
            if after_step and after_step(simulation):
                break
        ended_early = simulation.time < case.time.end
        if saved or watch.wrote_any or ended_early or case.checkpoint != Checkpoint():
            write_checkpoint(simulation, record, case, folder)
        record.write_last()
    whole = time.perf_counter() - stepping
    steps = simulation.steps - first
    if steps:
        spent = dict(simulation.ledger.seconds)
        cost = Spent(whole, steps, costs(plan, scene.layout.periods, spent, whole))
        summary = _summary(simulation, record, particles, cost)
    else:
        summary = ["no step was left to the end: for a later one, resume with --set time.end=..."]
    for line in summary:
        say(line)
    said = [*guards.summary(), *record.dry_probes(), *busy.summary()]
    measured = measured_lines(scene, Run(folder, case.name)) if comm.rank == 0 else []
    for line in [*measured, *said]:
        say(line)
    if comm.rank == 0 and steps:
        write_summary(folder, scene, simulation, cost, said)
    say(f"wrote {folder}/{case.name}.h5 and {ENDING} ({record.written} frames), {_tables(record)}")
    output = simulation.ledger.seconds["output"]
    took = comm.bcast((compiling, starting - compiling, whole - output, output))
    return Finished(simulation, particles, *took)


def _begin(scene, plan, comm, folder: Path, saved: Saved | None) -> tuple[Simulation, Record]:
    """A run at its start, or where ``saved`` was written."""
    if saved is None:
        simulation = Simulation(scene, plan, create_particles(scene, plan, comm), comm, Ledger())
        return simulation, Record(scene, simulation, folder)
    particles = listed_particles(scene, plan, saved)
    simulation = Simulation(scene, plan, particles, comm, Ledger(), saved)
    return simulation, Record(scene, simulation, folder, saved)


def _attend(simulation: Simulation, record: Record, watch: Watch, case, folder: Path) -> None:
    """Leave a checkpoint where one is due or asked for; raise Stopped where it is the last."""
    call, every = Call(int(simulation.requested)), case.checkpoint.every
    if call is Call.NOTHING and not (every and simulation.passed(every)):
        return
    begun = time.monotonic()
    write_checkpoint(simulation, record, case, folder)
    watch.wrote(time.monotonic() - begun)
    if call.ends:
        by = "checkpoint.wall_clock" if call is Call.WALL_CLOCK else call.name
        raise Stopped(
            f"stopped by {by} at t = {simulation.time:.6g} s: resume with {typed('resume', folder)}"
        )


def _speaker(comm) -> Say:
    """Rank 0 speaks; the others are silent."""

    def say(line: str, where=None) -> None:
        if comm.rank == 0:
            print(line, file=where, flush=True)

    return say


def _ranks(size: int) -> str:
    return "1 rank" if size == 1 else f"{size} ranks"


def _summary(simulation: Simulation, record: Record, particles: int, cost: Spent) -> Iterator[str]:
    """What the run cost, where the time went on rank 0, and how right it is where that is known."""
    rate = particles * cost.steps / cost.seconds
    yield (
        f"{cost.steps:,} steps in {cost.seconds:.1f} s: {rate / 1e6:.2f} M particle-steps/s, "
        f"{simulation.domain.rebuilds} list rebuilds"
    )
    yield from cost_lines(cost.parts, cost.seconds)
    if record.accuracy:
        yield f"error against the exact solution at {simulation.time:.6g} s: " + ", ".join(
            f"{name.replace('_', ' ')} {100.0 * error:.3g} %"
            for name, error in zip(record.accuracy.columns(), record.latest_errors)
        )


def _tables(record: Record) -> str:
    return ", ".join(table.path.name for table in record.tables)
