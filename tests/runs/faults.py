"""Jobs whose ranks are killed, again and again, and what became of them."""

import os
import re
import signal
import time
from pathlib import Path
from typing import NamedTuple

import h5py
from jobs import mpirun, started
from long import tell, tell_most
from runs.killed import OF_RANK_0, PHASES, PLACES, board
from runs.resuming import BOX, same_files

from psph.output.checkpoint import checkpoints

PROGRAM = Path(__file__).with_name("killed.py")

EVERY = 5
"""Steps from one checkpoint to the next."""

OFTEN = (
    BOX.replace("every = 30", f"every = {EVERY}")
    .replace("end = 0.2", "end = 0.1")
    .replace(
        "output = { frames = 0.02, probes = 0.005, log = 0.01 }",
        "output = { frames = 0.004, probes = 0.005, log = 0.004 }",
    )
)
"""40 steps of the boxes, with so many files that most of the time is spent on them."""

SOON = 10.0
"""Seconds in which a job must end when one of its ranks has died."""

LONGEST_WAIT = 0.7
"""Seconds from the first step to a random blow, at the most."""


class Fell(NamedTuple):
    """What became of a killed job: where its rank died, s until all had ended, how many steps are
    lost, and whether the frames could still be opened."""

    place: str
    phase: str
    seconds: float
    lost: int
    opens: bool


def blows(random, aimed, at_random):
    """So many (place, number) to die at in random order, and so many None: a random moment."""
    names = list(PLACES)
    wanted = [(names[k % len(names)], int(random.integers(1, 5))) for k in range(aimed)]
    wanted += [None] * at_random
    return [wanted[k] for k in random.permutation(len(wanted))]


class Trials:
    """Jobs in ``folder`` that are killed, each going on where the one before was, to the end.

    The files of each run that comes to its end must be those of ``whole``, which was never
    stopped.  ``fell`` says what befell each job.
    """

    def __init__(self, case, whole, folder, random):
        self.case, self.whole, self.folder, self.random = case, whole, folder, random
        self.fell: list[Fell] = []
        self.finished = 0

    def go(self, wanted):
        """A job for each blow; then one that comes to the end."""
        run = self.folder / "run"
        for blow in wanted:
            if not self._killed(run, blow):
                self._compare(run)
        job = mpirun(int(self.random.integers(1, 3)), ["-m", "psph", *self._arguments(run)])
        assert job.returncode == 0, job.stderr
        self._compare(run)

    def _arguments(self, run):
        """A run that left a checkpoint goes on, any other begins anew."""
        if checkpoints(run):
            return ["resume", run]
        return ["run", self.case, "--out", run, "--overwrite"]

    def _compare(self, run):
        assert same_files(run, self.whole)
        assert not list(run.glob("checkpoint-*.new"))
        self.finished += 1
        tell("runs that went on from such deaths, to the files of the unbroken run")
        run.rename(self.folder / f"finished-{self.finished}")

    def _killed(self, run, blow):
        """Whether the job was killed; else it came to its end before."""
        ranks = 2 if blow is None else 1 + int(self.random.integers(4) > 0)
        rank = int(self.random.integers(ranks))
        if blow and blow[0] in OF_RANK_0:
            rank = 0
        path = self.folder / "board"
        path.unlink(missing_ok=True)
        rows = board(path, ranks)
        told = f"{blow[0]}:{blow[1]}:{rank}" if blow else "-"
        since = self._newest(run)
        with started(ranks, [PROGRAM, path, told, *self._arguments(run)]) as job:
            if blow is None:
                _strike(job, rows[rank], self.random)
            struck = _death(job, rows[rank])
            _, said = job.communicate(timeout=60)
        seconds = time.monotonic() - struck
        if job.returncode == 0:
            return False
        assert seconds < SOON, (told, seconds)
        assert re.search(rf"\brank {rank}\b.*signal 9", said), said
        assert "Traceback" not in said
        reached = int(rows[rank][2])  # 0 before the first step
        lost = reached - max(self._newest(run), 0) if reached else 0
        assert 0 <= lost <= EVERY and self._newest(run) >= since
        phase = PHASES[int(rows[rank][1])]
        self.fell.append(Fell(blow[0] if blow else "at random", phase, seconds, lost, _opens(run)))
        tell("ranks killed")
        tell_most("longest time from such a death to the end of the job, s", seconds)
        tell_most("steps lost by it, a checkpoint every 5, at the most", lost)
        return True

    @staticmethod
    def _newest(run):
        """The step of the newest checkpoint; -1 where there is none."""
        found = checkpoints(run)
        return int(found[0].stem.partition("-")[2]) if found else -1


def _strike(job, row, random):
    """Kill a rank at a random moment after its first output."""
    while job.poll() is None and row[1] == 0:
        time.sleep(0.01)
    time.sleep(random.uniform(0.0, LONGEST_WAIT))
    if job.poll() is None:
        try:
            os.kill(int(row[0]), signal.SIGKILL)
        except ProcessLookupError:  # it has come to its end just now
            pass


def _death(job, row):
    """When the process of a rank was gone, by the clock."""
    while job.poll() is None and (row[0] == 0 or _lives(int(row[0]))):
        time.sleep(0.01)
    return time.monotonic()


def _opens(run):
    """Whether HDF5 finds all frames in the file of a run."""
    try:
        with h5py.File(run / "box.h5") as file:
            return all("time" in frame.attrs for frame in file["frames"].values())
    except (OSError, RuntimeError, KeyError):
        return False


def _lives(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def table(fell):
    """Lines of how many died in which phase and how soon the jobs ended."""
    yield (
        "| a rank was killed in | trials | longest until the job had ended | most steps lost | "
        "frames that no longer opened |"
    )
    yield "|---|---|---|---|---|"
    for phase in (*PHASES[1:], "all"):
        here = [f for f in fell if phase in (f.phase, "all")]
        if here:
            yield (
                f"| {phase} | {len(here)} | {max(f.seconds for f in here):.1f} s | "
                f"{max(f.lost for f in here)} | {sum(not f.opens for f in here)} |"
            )
