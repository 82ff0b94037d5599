"""Ranks that share a core are told so, with the number that would not; ranks with their own are not."""

import os

import pytest
from jobs import mpirun
from mpi4py import MPI
from runs.guarded import BOX

from psph.runs import busy
from psph.runs.busy import Busy


class Clocks:
    """Wall clock and processor time that a test sets on."""

    def __init__(self, monkeypatch):
        self.wall = self.cpu = 0.0
        monkeypatch.setattr(busy, "perf_counter", lambda: self.wall)
        monkeypatch.setattr(busy, "thread_time", lambda: self.cpu)

    def work(self, seconds, share):
        self.wall += seconds
        self.cpu += seconds * share


class Two:
    """A communicator of two ranks, the other of which had another part of its core."""

    size, rank = 2, 0

    def __init__(self, other):
        self.other = other

    def allgather(self, mine):
        return [mine, (self.other * mine[1], mine[1])]


def test_it_is_said_once_and_not_of_files_that_are_waited_for(monkeypatch):
    clocks = Clocks(monkeypatch)
    told = Busy(Two(1.0))
    clocks.work(50.0, 0.0)  # a frame on a slow disk
    assert told.step(lambda: clocks.work(1.0, 0.5)) == ""
    says = told.step(lambda: clocks.work(2.0, 0.5))
    assert says == (
        "the machine is busy: a rank gets 50% of a core, and all wait for the slowest; try fewer ranks "
        "(mpirun -n 1)"
    )
    assert told.step(lambda: clocks.work(9.0, 0.5)) == ""


@pytest.mark.parametrize("mine, other, said", [(1.0, 1.0, False), (0.9, 0.8, False), (1.0, 0.4, True)])
def test_at_the_end_the_rank_counts_that_got_least(monkeypatch, mine, other, said):
    clocks = Clocks(monkeypatch)
    told = Busy(Two(other))
    assert told.step(lambda: clocks.work(5.0, mine)) == ""
    assert [f"{other:.0%} of a core" in line for line in told.summary()] == [True] * said


def test_one_rank_waits_for_nobody(monkeypatch):
    clocks = Clocks(monkeypatch)
    told = Busy(MPI.COMM_SELF)
    assert told.step(lambda: clocks.work(5.0, 0.1)) == "" and [*told.summary()] == []


def on_one_core(folder, *words):
    """A real job of two ranks that may use but one core."""
    (folder / "case.toml").write_text(BOX, encoding="utf-8")
    core = min(os.sched_getaffinity(0))
    # Long enough where a third process shares the core too: the ranks then take turns more often.
    ends = ["--set", "time.end=2.0", "--set", "output.frames=2.0"]
    one_core = {
        "preexec_fn": lambda: os.sched_setaffinity(0, {core}),
        "env": {"OMPI_MCA_mpi_yield_when_idle": "0"},
    }
    job = mpirun(2, ["-m", "psph", *words, *ends], cwd=folder, **one_core)
    assert job.returncode == 0, job.stderr
    return job


@pytest.mark.slow
def test_so_is_who_measures_seconds(tmp_path):
    told = ["--vary", "space.spacing=0.05,0.04", "--set", "study.repeats=1"]
    assert "warning: the machine is busy: " in on_one_core(tmp_path, "study", "case.toml", *told).stdout


def test_two_ranks_on_one_core_are_told_to_be_one(tmp_path):
    job = on_one_core(tmp_path, "case.toml")
    assert job.stderr.count("warning: the machine is busy: ") == 1
    assert "try fewer ranks (mpirun -n 1)" in job.stderr
    assert "the machine is busy" in job.stdout  # and at the end
