"""The Slurm script: by itself with a stand-in for scontrol alone, and (long) under a real Slurm."""

import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
import slurm
from jobs import APART, clean_environment, mpirun
from long import LONG, tell
from runs.resuming import BOX, same_files

from psph.output.checkpoint import checkpoints

ROOT = Path(__file__).parents[1]
SCRIPT = ROOT / "run/batch/psph.slurm"
pytestmark = [pytest.mark.alone, pytest.mark.timeout(400)]  # whichever comes first compiles


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A folder to submit from: the environment, these sources, and a case."""
    folder = tmp_path_factory.mktemp("home")
    program(
        folder / ".venv/bin/python",
        f'export PYTHONPATH={shlex.quote(str(ROOT))}; exec {shlex.quote(sys.executable)} "$@"',
    )
    (folder / "box.toml").write_text(BOX, encoding="utf-8")
    return folder


def program(path, text):
    """Leave a program of bash there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


def rows(folder):
    """Lines of a run's log."""
    log = folder / "log.csv"
    return len(log.read_text().splitlines()) if log.exists() else 0


def until(there, seconds=150.0):
    """Wait for it, patiently."""
    deadline = time.monotonic() + seconds
    while not there():
        assert time.monotonic() < deadline
        time.sleep(0.1)


def children_of(job):
    """The names of a process's children; one that ends meanwhile is not among them."""
    names = []
    for pid in Path(f"/proc/{job.pid}/task/{job.pid}/children").read_text().split():
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            names.append(Path(f"/proc/{pid}/comm").read_text().strip())
    return names


# Without Slurm


@pytest.fixture
def queue(tmp_path):
    """A folder for PATH whose ``scontrol`` only writes to ``asked`` what it was asked for."""
    program(tmp_path / "scontrol", 'echo "$@" >>"$(dirname "$0")/asked"')
    return tmp_path


SPREAD = {"rmaps_base_oversubscribe": "1", "hwloc_base_binding_policy": "none"}


@contextmanager
def turn_of(home, queue, *arguments, turn=0, number=77):
    """The running script as Slurm starts it."""
    told = {"SLURM_JOB_ID": str(number), "SLURM_NTASKS": "2"}
    told["PATH"] = f"{queue}:{os.environ['PATH']}"
    spread = {f"OMPI_MCA_{key}": value for key, value in SPREAD.items()}
    again = {"SLURM_RESTART_COUNT": str(turn)} if turn else {}
    with subprocess.Popen(
        ["bash", SCRIPT, *map(str, arguments)],
        cwd=home,
        env=clean_environment() | told | spread | again,
        **APART,
    ) as job:
        try:
            yield job
        finally:
            if job.poll() is None:
                os.killpg(job.pid, signal.SIGTERM)
                time.sleep(3.0)  # Open MPI ends the ranks, and kills them a second later
                os.killpg(job.pid, signal.SIGKILL)


def turn(*arguments, **named):
    """The same, finished: code, output and messages."""
    with turn_of(*arguments, **named) as job:
        out, err = job.communicate(timeout=300)
    return job.returncode, out, err


def asked(queue):
    """What scontrol was asked for."""
    return (queue / "asked").read_text().split("\n")[:-1] if (queue / "asked").exists() else []


ENDLESS = ("--set", "time.end=50.0", "--set", 'title="two words"')


def test_warned_turns_go_back_into_the_queue_and_a_finished_one_rests(home, queue):
    folder = home / "results/box-77"
    for number in (0, 1):
        if number == 1:  # of a busy node
            program(queue / "bash", 'sleep 2; exec /bin/bash "$@"')
        with turn_of(home, queue, "box.toml", *ENDLESS, turn=number) as job:
            if number == 0:
                until(lambda: rows(folder) > 2 or job.poll() is not None, 300)
            else:  # before psph listens, and before a rank does
                until(lambda: "mpirun" in children_of(job) or job.poll() is not None)
            os.kill(job.pid, signal.SIGUSR1)
            out, err = job.communicate(timeout=60)
        assert job.returncode == 0, err
        assert "stopped by SIGUSR1" in err and asked(queue) == ["requeue 77"] * (number + 1)
        assert f"turn {number + 2} goes on from results/box-77/checkpoint-" in out
        assert ("resuming from checkpoint-" in out.split("Back")[0]) == (number == 1)
        assert "psph: two words:" in out
        assert not list(home.glob(".psph-*"))


@LONG
def test_a_finished_run_rests_until_it_shall_go_further(home, queue):
    case = ("box.toml", "--set", "time.end=0.01")
    assert turn(home, queue, *case, number=5)[0] == 0
    folder = home / "results/box-5"
    left = {path.name: path.stat().st_mtime_ns for path in folder.iterdir()}
    rests = (0, "", "results/box-5 is finished.\n")
    for again in (case, ("resume", "results/box-5")):
        assert turn(home, queue, *again, turn=1, number=5) == rests
    assert {path.name: path.stat().st_mtime_ns for path in folder.iterdir()} == left
    further = ("resume", "results/box-5", "--set", "time.end=0.02")
    code, out, _ = turn(home, queue, *further, number=6)
    assert code == 0 and "resuming from" in out
    assert turn(home, queue, *further, turn=1, number=6) == rests
    assert asked(queue) == []


@LONG
def test_a_turn_that_left_no_checkpoint_is_begun_anew(home, queue):
    case = ("box.toml", "--set", "time.end=0.01", "--set", "checkpoint.every=off")
    assert turn(home, queue, *case, number=8)[0] == 0
    (home / "results/box-8/finished").unlink()
    code, out, err = turn(home, queue, *case, turn=1, number=8)
    assert code == 0 and "resuming from" not in out, err


def test_a_mistake_is_not_repeated(home, queue):
    code, _, err = turn(home, queue, "box.toml", "--set", "space.spacing=-1")
    assert code == 2 and asked(queue) == [] and "space.spacing" in err


@pytest.mark.parametrize(
    "arguments", [(), ("resume",), ("box.toml", "--out", "x"), ("resume", "x", "--from=y")]
)
def test_wrong_arguments_are_one_line(home, queue, arguments):
    code, out, err = turn(home, queue, *arguments)
    assert code == 1 and out == "" and len(err.splitlines()) == 1


def test_a_turn_without_progress_or_without_a_queue_ends_the_job(home, queue, tmp_path):
    stopped = ("box.toml", "--set", "time.end=50.0", "--set", "checkpoint.wall_clock=0.01")
    program(queue / "scontrol", "exit 1")
    code, _, err = turn(home, queue, *stopped, number=9)
    assert code == 75 and "stopped by checkpoint.wall_clock" in err
    way = "go on with: sbatch run/batch/psph.slurm resume results/box-9\n"
    assert err.endswith(f"Slurm does not take the job back; {way}")

    elsewhere = tmp_path / "elsewhere"  # where psph ends with code 75 and has done nothing
    program(elsewhere / ".venv/bin/python", "exit 75")
    shutil.copytree(home / "results", elsewhere / "results")
    code, _, err = turn(elsewhere, queue, *stopped, turn=1, number=9)
    assert code == 75 and err.endswith(f"came no step further: not put back into the queue; {way}")


# Under a real Slurm

TURNS = 3
"""Of the job that is warned by hand."""


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A Slurm of one node, with as many cores as this machine has."""
    if trouble := slurm.why_not():
        pytest.skip(trouble)
    with slurm.running(tmp_path_factory.mktemp("slurm")) as cluster:
        yield cluster


class Job:
    """A job that was handed in with ``sbatch``."""

    def __init__(self, cluster, home, *words):
        self.cluster, self.home = cluster, home
        self.number = cluster.command("sbatch", "--parsable", *words, cwd=home)
        self.folder = home / f"results/box-{self.number}"
        self.hastened = 1  # the last turn that need not wait two minutes
        tell("jobs given to a real Slurm")

    def state(self):
        """``PENDING``, ``RUNNING``, ``COMPLETED``, …"""
        return self.cluster.job(self.number)["JobState"]

    def turns(self):
        """Turns that have begun, or wait to begin again."""
        return 1 + int(self.cluster.job(self.number)["Restarts"])

    def log(self):
        """All that it said, in all turns."""
        path = self.home / f"psph-{self.number}.log"
        return path.read_text(errors="replace") if path.exists() else ""

    def ended(self):
        """Whether it has come to its end; one that waits for its next turn has it soon.

        Not at once: a node does not start what it has put away in the same second.
        """
        state = self.state()
        if state == "PENDING" and (turn := self.turns()) > self.hastened:
            self.cluster.command("scontrol", "update", f"JobId={self.number}", "StartTime=now+3")
            self.hastened = turn
        return state in ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL")

    def end(self, seconds=300.0):
        """Its last state."""
        until(self.ended, seconds)
        return self.state()


LENGTHY = ("box.toml", "--set", "time.cfl=0.01", "--set", "checkpoint.every=1000")
"""Arguments for a run of many steps: to 0.3 s seconds where nothing else runs."""


@pytest.fixture(scope="module")
def whole(home):
    """A function: ``time.end`` → folder of the run that was never stopped, and its seconds."""
    done = {}

    def run(end):
        if end not in done:
            folder = home / f"whole-{end}"
            words = ["-m", "psph", *LENGTHY, "--set", f"time.end={end}", "--out", folder]
            job = mpirun(2, words, cwd=home, timeout=400)
            assert job.returncode == 0, job.stderr
            done[end] = folder, float(re.search(r"steps in ([\d.]+) s", job.stdout)[1])
        return done[end]

    return run


@LONG
@pytest.mark.timeout(900)
def test_a_job_that_is_warned_puts_itself_back_until_it_is_done(cluster, home, whole):
    unbroken, _ = whole("0.3")
    job = Job(cluster, home, "--time=10", SCRIPT, *LENGTHY, "--set", "time.end=0.3")
    for number in range(1, TURNS):
        before = rows(job.folder)
        until(lambda: rows(job.folder) > before + 2, 200)
        cluster.command("scancel", "--signal=USR1", "--batch", job.number)
        until(lambda: job.ended() or job.turns() > number, 60)
        until(lambda: job.ended() or job.state() == "RUNNING", 60)
    assert job.end() == "COMPLETED", job.log()
    assert job.turns() == TURNS, job.log()
    assert job.log().count("stopped by SIGUSR1") == job.log().count("resuming from checkpoint-") == 2
    assert same_files(job.folder, unbroken)
    tell("turns of a job that Slurm warned, to the files of the unbroken run", job.turns())

    left = {path.name: path.read_bytes() for path in job.folder.iterdir()}
    cluster.command("scontrol", "requeue", job.number)
    assert job.end() == "COMPLETED" and job.turns() == TURNS + 1
    assert job.log().endswith(f"results/box-{job.number} is finished.\n")
    assert {path.name: path.read_bytes() for path in job.folder.iterdir()} == left


@LONG
@pytest.mark.timeout(900)
def test_slurm_itself_warns_before_the_time_is_over(cluster, home, whole):
    """The run needs more than a minute, and Slurm warns 10 to 40 s after a turn has begun."""
    seconds = whole("0.3")[1]
    end = f"{0.3 * 100.0 / seconds:.1f}"
    minute = ("--time=1", "--signal=B:USR1@20")
    job = Job(cluster, home, *minute, SCRIPT, *LENGTHY, "--set", f"time.end={end}")
    assert job.end(600) == "COMPLETED", job.log()
    assert job.turns() > 1 and job.log().count("stopped by SIGUSR1") == job.turns() - 1
    assert same_files(job.folder, whole(end)[0])
    tell("turns of a job that Slurm warned, to the files of the unbroken run", job.turns())


@LONG
@pytest.mark.timeout(900)
def test_a_job_that_slurm_puts_back_goes_on_or_begins_anew(cluster, home, whole):
    unbroken, _ = whole("0.3")
    for left in (True, False):
        job = Job(cluster, home, SCRIPT, *LENGTHY, "--set", "time.end=0.3")
        until(lambda: rows(job.folder) > 8, 200)
        cluster.command("scontrol", "requeue", job.number)  # as after a node that failed
        until(lambda: job.state() == "PENDING" and "holds a checkpoint" in job.log(), 60)
        if not left:  # as if it had failed at once
            for path in checkpoints(job.folder):
                path.unlink()
        assert job.end() == "COMPLETED" and job.turns() == 2, job.log()
        assert ("resuming from checkpoint-" in job.log()) == left
        assert same_files(job.folder, unbroken)


@LONG
@pytest.mark.timeout(900)
def test_a_cancelled_job_stays_away_and_another_goes_on(cluster, home, whole):
    unbroken, _ = whole("0.3")
    patient = "--export=ALL,OMPI_MCA_odls_base_sigkill_timeout=10"
    job = Job(cluster, home, patient, SCRIPT, *LENGTHY, "--set", "time.end=0.3")
    until(lambda: rows(job.folder) > 2, 200)
    cluster.command("scancel", job.number)
    assert job.end() == "CANCELLED" and job.turns() == 1
    until(lambda: "go on with:" in job.log(), 40)
    assert len(checkpoints(job.folder)) == 1
    [way] = re.findall("go on with: sbatch run/batch/psph.slurm (.*)", job.log())
    # With one rank of as many threads as there are cores.
    cores = min(os.cpu_count(), 2)
    other = Job(cluster, home, "--ntasks=1", f"--cpus-per-task={cores}", SCRIPT, *shlex.split(way))
    assert other.end() == "COMPLETED", other.log()
    assert "resuming from checkpoint-" in other.log() and same_files(job.folder, unbroken)


@LONG
def test_a_job_with_a_mistake_fails_once(cluster, home):
    job = Job(cluster, home, SCRIPT, "box.toml", "--set", "space.spacing=-1")
    assert job.end(60) == "FAILED" and job.turns() == 1
    assert cluster.job(job.number)["ExitCode"] == "2:0" and "space.spacing" in job.log()
