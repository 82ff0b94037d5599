"""Signals and clocks: what stops a run, with a checkpoint, and how it goes on."""

import os
import shutil
import signal
import time
from types import SimpleNamespace

import pytest
from jobs import mpirun, ranks_of, started
from long import long_but_for
from mpi4py import MPI
from runs.guarded import SLOWLY, boxed
from runs.resuming import BOX, same_files

from psph.output.checkpoint import checkpoints
from psph.runs import watch as module
from psph.runs.start import run
from psph.runs.watch import Call, Stopped, Watch
from psph.simulation import stages

pytestmark = pytest.mark.alone


def limits(minutes=1e9, wall_clock=None):
    return SimpleNamespace(minutes=minutes, wall_clock=wall_clock)


@pytest.fixture
def clock(monkeypatch):
    """A clock that a test sets: ``clock.now`` in s."""
    clock = SimpleNamespace(now=1000.0)
    monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=lambda: clock.now))
    return clock


def test_a_signal_is_remembered_and_the_handlers_come_back():
    before = [signal.getsignal(number) for number in module.SIGNALS]
    with Watch(limits()) as watch:
        assert watch.call() is Call.NOTHING
        os.kill(os.getpid(), signal.SIGUSR1)
        assert watch.call() is Call.SIGUSR1
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGUSR1)
        assert watch.call() is watch.call() is Call.SIGTERM
    assert [signal.getsignal(number) for number in module.SIGNALS] == before
    assert not Call.NOTHING.ends and not Call.CHECKPOINT.ends
    assert Call.WALL_CLOCK.ends and Call.SIGUSR1.ends and Call.SIGTERM.ends


def test_the_first_interrupt_is_remembered_and_the_second_interrupts():
    before = signal.getsignal(signal.SIGINT)
    with Watch(limits()) as watch:
        os.kill(os.getpid(), signal.SIGINT)
        assert watch.call() is Call.SIGINT and Call.SIGINT.ends
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)
    assert signal.getsignal(signal.SIGINT) is before


def test_minutes_count_from_the_last_checkpoint(clock):
    watch = Watch(limits(minutes=2.0))
    clock.now += 119.0
    assert watch.call() is Call.NOTHING
    clock.now += 1.0
    assert watch.call() is Call.CHECKPOINT
    watch.wrote(1.0)
    assert watch.call() is Call.NOTHING
    clock.now += 120.0
    assert watch.call() is Call.CHECKPOINT


def test_a_checkpoint_of_which_the_case_says_nothing_takes_a_hundredth_of_the_time(clock):
    watch = Watch(limits(minutes=None))
    for took, apart in ((0.01, 5.0), (0.2, 20.0), (0.1, 20.0), (30.0, 600.0)):
        watch.wrote(took)
        clock.now += apart - 0.1
        assert watch.call() is Call.NOTHING
        clock.now += 0.1
        assert watch.call() is Call.CHECKPOINT


def test_the_limit_leaves_room_for_a_slow_step_and_a_slow_checkpoint(clock):
    watch = Watch(limits(wall_clock=100.0))
    for _ in range(10):
        clock.now += 20.0  # steps of 20 s
        assert watch.call() is Call.NOTHING
    clock.now += 50.0
    watch.wrote(50.0)
    clock.now = 1000.0 + 6000.0 - 60.0 - 2.0 * (20.0 + 50.0)
    watch._looked = clock.now - 20.0
    assert watch.call() is Call.NOTHING
    clock.now += 0.1
    watch._looked = clock.now - 20.0
    assert watch.call() is Call.WALL_CLOCK


def test_a_signal_in_the_midst_of_a_step_is_heard_at_its_end(tmp_path, monkeypatch):
    """Not a step later: mpirun that is told to end kills within about a second."""
    honest = stages.kick

    def interrupted(simulation):
        if simulation.steps == 4:
            os.kill(os.getpid(), signal.SIGUSR1)
        honest(simulation)

    every = {
        name: one._replace(run=interrupted) if one.run is honest else one
        for name, one in stages.OF_EVERY_STEP.items()
    }
    monkeypatch.setattr(stages, "OF_EVERY_STEP", every)
    with pytest.raises(Stopped, match="stopped by SIGUSR1"):
        run(boxed(tmp_path, MPI.COMM_SELF), tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    assert [path.name for path in checkpoints(tmp_path / "run")] == ["checkpoint-5.h5"]


@pytest.mark.parametrize("minutes, last", [(10.0, 20), (12.0, 24)])
def test_a_run_leaves_a_checkpoint_after_so_many_minutes(tmp_path, clock, minutes, last):
    """A minute passes from one look at the clock to the next, and each step has one."""

    def later():
        clock.now += 60.0
        return clock.now

    module.time.monotonic = later
    case = boxed(tmp_path, MPI.COMM_SELF, "time.step=2e-3", "time.end=0.05", f"checkpoint.minutes={minutes}")
    run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    found = [path.name for path in checkpoints(tmp_path / "run")]
    assert found == ["checkpoint-25.h5", f"checkpoint-{last}.h5"]


def test_a_short_run_leaves_none(tmp_path):
    case = boxed(tmp_path, MPI.COMM_SELF, "time.end=0.01")
    run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    assert checkpoints(tmp_path / "run") == []


# Real jobs


def begun(folder, rows):
    """Wait until the log of a run has so many rows."""
    for _ in range(600):
        log = folder / "log.csv"
        if log.exists() and len(log.read_text().splitlines()) > rows:
            return
        time.sleep(0.1)
    raise AssertionError("the run did not begin")


LATER = "time.end=0.3"


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """A case, and the folder of its run to ``LATER`` that was never stopped."""
    folder = tmp_path_factory.mktemp("box")
    (folder / "box.toml").write_text(BOX, encoding="utf-8")
    job = mpirun(1, ["-m", "psph", folder / "box.toml", "--out", folder / "run", "--set", LATER])
    assert job.returncode == 0, job.stderr
    return folder / "box.toml", folder / "run"


@pytest.mark.parametrize(
    "number, to, ranks",
    [("SIGUSR1", "mpirun", (2, 3)), ("SIGTERM", "one rank", (2, 1)), ("SIGINT", "one rank", (1, 1))],
)
def test_a_signal_to_a_real_job_loses_nothing(box, tmp_path, number, to, ranks):
    case, whole = box
    folder, (before, after) = tmp_path / "run", ranks
    # It sleeps after each step, to be met in the midst of the run.
    with started(before, [SLOWLY, "0.05", case, "--out", folder, "--set", LATER]) as job:
        begun(folder, 4)
        os.kill(job.pid if to == "mpirun" else ranks_of(job)[-1], getattr(signal, number))
        _, said = job.communicate(timeout=60)
    assert job.returncode == 75, said
    [line] = [line for line in said.splitlines() if line.startswith("stopped by")]
    assert line.startswith(f"stopped by {number} at t = 0.")
    assert line.endswith(f"resume with `python -m psph resume {folder}`")
    assert len(checkpoints(folder)) >= 1 and not same_files(folder, whole)
    job = mpirun(after, ["-m", "psph", "resume", folder])
    assert job.returncode == 0, job.stderr
    assert "resuming from checkpoint-" in job.stdout
    assert same_files(folder, whole)


@pytest.mark.parametrize("number", long_but_for(("SIGTERM",), ("SIGTERM", "SIGINT")))
def test_mpirun_that_is_told_to_end_lets_the_ranks_save(box, tmp_path, number):
    folder, patient = tmp_path / "run", {"OMPI_MCA_odls_base_sigkill_timeout": "3"}
    with started(2, [SLOWLY, "0.05", box[0], "--out", folder, "--set", LATER], env=patient) as job:
        begun(folder, 4)
        os.kill(job.pid, getattr(signal, number))
        _, said = job.communicate(timeout=60)
    assert job.returncode == 1  # its own, not that of the ranks
    assert said.count("stopped by SIGTERM at t = 0.") == 1 and len(checkpoints(folder)) >= 1


TOLD_AT_THE_END = """
import os, signal, time
from psph.runs.watch import listen
listen()
from mpi4py import MPI

comm = MPI.COMM_WORLD
process = comm.bcast(os.getpid(), root=1)
if comm.rank == 0:
    time.sleep(1.0)  # the other rank has ended its Python, and waits for this one in MPI_Finalize
    for number in (signal.SIGUSR1, signal.SIGTERM):
        os.kill(process, number)
    time.sleep(0.3)
"""


def test_a_signal_to_a_rank_that_has_ended_does_not_kill_it(tmp_path):
    (tmp_path / "told.py").write_text(TOLD_AT_THE_END, encoding="utf-8")
    job = mpirun(2, [tmp_path / "told.py"])
    assert job.returncode == 0, job.stderr


TOLD_AT_ONCE = """
import os, signal, sys

class Told:
    def find_spec(self, name, path=None, target=None):
        if name == "mpi4py":
            os.kill(os.getpid(), signal.{number})

sys.meta_path.insert(0, Told())
from psph.__main__ import guarded
guarded(sys.argv[1:])
"""
"""A signal before MPI is there, which takes a second or two of the start."""


@pytest.mark.parametrize("number", ["SIGUSR1", "SIGTERM"])
def test_a_signal_before_anything_has_begun_is_heard(box, tmp_path, number):
    told, folder = tmp_path / "told.py", tmp_path / "run"
    told.write_text(TOLD_AT_ONCE.replace("{number}", number), encoding="utf-8")
    for arguments in ([box[0], "--out", folder, "--set", LATER], ["resume", folder]):
        job = mpirun(1, [told, *arguments])
        assert job.returncode == 75, job.stderr
        assert f"stopped by {number} at t = 0." in job.stderr
    assert [path.name for path in checkpoints(folder)] == ["checkpoint-2.h5", "checkpoint-1.h5"]


def test_other_verbs_are_ended_by_a_signal(tmp_path):
    told = tmp_path / "told.py"
    told.write_text(TOLD_AT_ONCE.replace("{number}", "SIGTERM"), encoding="utf-8")
    assert mpirun(1, [told, "schema"]).returncode not in (0, 75)


def test_a_refusal_is_one_line_and_code_2(box, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(box[1], folder)
    newest, older = checkpoints(folder)
    newest.write_bytes(newest.read_bytes()[:-1])
    job = mpirun(2, ["-m", "psph", "resume", folder])
    assert job.returncode == 2 and "Traceback" not in job.stderr
    [line] = [line for line in job.stderr.splitlines() if "damaged" in line]
    assert line.endswith(f"`python -m psph resume {folder} --from {older.name}`")
