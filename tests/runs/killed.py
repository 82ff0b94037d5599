"""psph as a program that tells a board where it is, and dies there by a real SIGKILL if told so.

    python killed.py BOARD BLOW ARGUMENTS OF PSPH

BOARD is a file with a row of three 64-bit integers a rank: process id, number of the phase, steps.
BLOW is ``-`` or ``PLACE:NUMBER:RANK``: this rank dies when it comes to this place for that time.
"""

import functools
import os
import signal
import sys

import numpy as np

PHASES = ("start", "step", "halo", "rebuild", "frame", "table", "checkpoint", "between")

PLACES = {
    "a step begins": ("step.Simulation.step", "before", None),
    "a step ends": ("step.Simulation.step", "after", None),
    "lists are made": ("step.Simulation.rebuild", "after", None),
    "messages travel": ("halo.Halo.start", "after", None),
    "messages are waited for": ("halo.Halo.finish", "before", None),
    "a frame begins": ("frames.FrameFile.write", "before", None),
    "a frame is being laid out": ("rows.create_datasets", "after", "frame"),
    "a frame is laid out": ("rows.fill", "before", "frame"),
    "a frame is filled": ("rows.fill", "after", "frame"),
    "the index is replaced": ("xdmf.os.replace", "before", "frame"),
    "a frame ends": ("frames.FrameFile.write", "after", None),
    "a row is half written": ("tables.CsvTable.write", "half", None),
    "a checkpoint begins": ("checkpoint.write", "before", None),
    "a checkpoint is being laid out": ("rows.create_datasets", "after", "checkpoint"),
    "a checkpoint is laid out": ("rows.fill", "before", "checkpoint"),
    "a checkpoint is filled": ("rows.fill", "after", "checkpoint"),
    "a checkpoint is being sealed": ("checkpoint._frame_digest", "after", "checkpoint"),
    "a checkpoint is sealed": ("checkpoint._seal", "after", "checkpoint"),
    "a checkpoint is renamed": ("checkpoint.checkpoints", "before", "checkpoint"),
    "a checkpoint ends": ("checkpoint.write", "after", None),
}
"""What is called there, whether the rank dies before or after, and in which phase alone."""

OF_RANK_0 = {
    "a frame is being laid out",
    "the index is replaced",
    "a row is half written",
    "a checkpoint is being laid out",
    "a checkpoint is being sealed",
    "a checkpoint is sealed",
    "a checkpoint is renamed",
}
"""Places that no other rank comes to."""


def board(path, ranks):
    """The rows of a board, which outlive whoever writes them."""
    return np.memmap(path, np.int64, "r+" if path.exists() else "w+", shape=(ranks, 3))


def _watch(row, blow):
    from psph.output import checkpoint, frames, rows, tables, xdmf
    from psph.parallel import halo
    from psph.simulation import step

    modules = {
        "step": step,
        "halo": halo,
        "frames": frames,
        "rows": rows,
        "xdmf": xdmf,
        "tables": tables,
        "checkpoint": checkpoint,
    }

    xdmf.PAUSE = 0.0  # so that this place is come to

    def wrap(place, around):
        first, *between, name = place.split(".")
        owner = functools.reduce(getattr, between, modules[first])
        setattr(owner, name, around(getattr(owner, name)))

    if blow:
        place, number = blow
        wrap(PLACES[place][0], _deadly(row, number, *PLACES[place][1:]))
    for place, phase in (
        ("step.Simulation.step", "step"),
        ("step.Simulation.rebuild", "rebuild"),
        ("halo.Halo.start", "halo"),
        ("halo.Halo.finish", "halo"),
        ("frames.FrameFile.write", "frame"),
        ("tables.CsvTable.write", "table"),
        ("checkpoint.write", "checkpoint"),
    ):
        wrap(place, _told(row, PHASES.index(phase)))


def _told(row, phase):
    """A function that has its phase on the board while it runs."""

    def around(original):
        def call(*args, **kwargs):
            before = row[1] or PHASES.index("between")
            row[1] = phase
            try:
                return original(*args, **kwargs)
            finally:
                row[1] = before
                row[2] = getattr(args[0], "steps", row[2]) if args else row[2]

        return call

    return around


def _deadly(row, number, when, phase):
    """A function that is the end of this process when it is called for the time ``number``."""

    def around(original):
        left = number

        def call(*args, **kwargs):
            nonlocal left
            here = phase is None or PHASES[row[1]] == phase
            left -= here
            last = here and left == 0
            if last and when == "half":
                args[0]._file.write("0.12")
                args[0]._file.flush()
            if last and when != "after":
                os.kill(os.getpid(), signal.SIGKILL)
            result = original(*args, **kwargs)
            if last:
                os.kill(os.getpid(), signal.SIGKILL)
            return result

        return call

    return around


def main(path, told, *arguments):
    """Run psph under watch."""
    from pathlib import Path

    from mpi4py import MPI

    from psph.__main__ import guarded
    from psph.runs import start as run

    comm = MPI.COMM_WORLD
    row = board(Path(path), comm.size)[comm.rank]
    row[0] = os.getpid()
    place, number, rank = told.split(":") if told != "-" else ("", 0, -1)
    compile_ahead = run.compile_ahead  # it rehearses a step, which is none of the run

    def then_watched(*args):
        seconds = compile_ahead(*args)
        _watch(row, (place, int(number)) if int(rank) == comm.rank else None)
        return seconds

    run.compile_ahead = then_watched
    guarded(list(arguments))


if __name__ == "__main__":
    main(*sys.argv[1:])
