"""The folder of a run: what is not a run's own stays, and one psph at a time is at work in it."""

import os
import re
import shlex
import signal
import subprocess
import sys
import time

import pytest
from jobs import mpirun, ranks_of, started
from mpi4py import MPI
from runs.guarded import BOX, SLOWLY, boxed

from psph.case import load
from psph.output.checkpoint import checkpoints
from psph.output.errors import OutputError
from psph.runs.folder import IN_USE, alone_in
from psph.runs.start import resume, run

COMM = MPI.COMM_SELF
QUIET = {"say": lambda *_: None}
SHORT = "time.end=1e-3"

SLOPE = """
from psph.physics.catalogue import Catalogue

CATALOGUE = Catalogue()
"""
"""A file that a case uses, and that brings nothing."""


COUNT = """
from typing import Annotated, NamedTuple

from pydantic import Field

from psph.physics.catalogue import Catalogue, Entry


class Count(NamedTuple):
    every: Annotated[float, Field(gt=0, description="time between rows", json_schema_extra={"unit": "s"})]

    def columns(self, scene):
        return ["particles"]

    def row(self, simulation):
        return [1]


CATALOGUE = Catalogue(tables=(Entry("tables.count", Count),))
"""
"""A table of a case's own."""


def contents(folder):
    """Every file in a folder, with its bytes."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    "name",
    [
        "log.csv",
        "probes.csv",
        "errors.csv",
        "box.xdmf",
        "box.h5.new",
        "checkpoint-10.h5",
        "checkpoint-10.h5.new",
        "post_mortem.md",
        "post_mortem.png",
        "slope.py",
    ],
)
def test_a_file_of_the_same_name_is_not_lost_unasked(tmp_path, name):
    (tmp_path / "slope.py").write_text(SLOPE, encoding="utf-8")
    (tmp_path / "box.toml").write_text('use = ["slope.py"]\n' + BOX, encoding="utf-8")
    case, folder = load(tmp_path / "box.toml", [SHORT]), tmp_path / "mine"
    folder.mkdir()
    (folder / name).write_text("not psph's\n", encoding="utf-8")
    (folder / "notes.txt").write_text("a note\n", encoding="utf-8")
    before = contents(folder)
    with pytest.raises(OutputError, match="would be lost: give another --out, or --overwrite") as refused:
        run(case, folder, COMM, **QUIET)
    assert str(folder / name) in str(refused.value) and "\n" not in str(refused.value)
    assert contents(folder) == before
    run(case, folder, COMM, overwrite=True, **QUIET)
    assert (folder / "box.h5").exists() and (folder / "notes.txt").exists()


def test_a_table_of_the_case_s_own_is_not_lost_unasked(tmp_path):
    (tmp_path / "count.py").write_text(COUNT, encoding="utf-8")
    text = 'use = ["count.py"]\n' + BOX + "[tables]\ncount = 0.1\n"
    (tmp_path / "box.toml").write_text(text, encoding="utf-8")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "count.csv").write_text("1\n", encoding="utf-8")
    with pytest.raises(OutputError, match="count.csv would be lost"):
        run(load(tmp_path / "box.toml", [SHORT]), tmp_path / "run", COMM, **QUIET)


def test_overwriting_leaves_nothing_of_an_older_run_and_all_that_is_not_a_run_s(tmp_path):
    """Also where the older one was of another case, with tables that the new one has not."""
    (tmp_path / "count.py").write_text(COUNT, encoding="utf-8")
    gauged = BOX + '[gauges.old]\nhighest = { axis = "x" }\n[tables]\ncount = 0.1\n'
    (tmp_path / "first.toml").write_text('use = ["count.py"]\n' + gauged, encoding="utf-8")
    folder = tmp_path / "a run"
    run(load(tmp_path / "first.toml", [SHORT]), folder, COMM, **QUIET)
    written = {path.name for path in folder.iterdir()}
    assert written > {"first.h5", "first.xdmf", "gauge-old.csv", "count.csv", "log.csv"}
    for name in ("first.xmf", "report.html", "gauge-old.png"):
        (folder / name).write_text("of the older run", encoding="utf-8")
    mine = {"notes.txt", "gauge-mine.csv", "mine.h5", "mine.xmf", "count.txt"}
    for name in mine:
        (folder / name).write_text("mine", encoding="utf-8")
    run(boxed(tmp_path, COMM, SHORT), folder, COMM, overwrite=True, **QUIET)
    own = {"box.h5", "box.xdmf", "log.csv", "summary.json", "case.toml"}
    assert {path.name for path in folder.iterdir()} == own | mine | {"count.py"}  # files that it used stay


def test_commands_in_hints_are_quoted(tmp_path):
    folder = tmp_path / "it's a run"
    run(boxed(tmp_path, COMM, SHORT, "checkpoint.every=1"), folder, COMM, **QUIET)
    with pytest.raises(OutputError) as refused:
        run(boxed(tmp_path, COMM, SHORT), folder, COMM, **QUIET)
    command = re.search("`(.*)`", str(refused.value))[1]
    assert shlex.split(command) == ["python", "-m", "psph", "resume", str(folder)]


def test_what_is_nobody_s_trouble_stays_and_the_same_files_are_taken(tmp_path):
    """A copy of a used file with the same bytes is what the run would write."""
    (tmp_path / "slope.py").write_text(SLOPE, encoding="utf-8")
    (tmp_path / "box.toml").write_text('use = ["slope.py"]\n' + BOX, encoding="utf-8")
    for name in ("notes.txt", "other.h5", "other.xdmf", "other.csv", "checkpoint-old.h5", "picture.png"):
        (tmp_path / name).write_text(name, encoding="utf-8")
    before = contents(tmp_path)
    run(load(tmp_path / "box.toml", [SHORT]), tmp_path, COMM, **QUIET)
    assert contents(tmp_path).items() > before.items()


@pytest.mark.parametrize("name", ["checkpoint-1", "checkpoint-0020"])
def test_a_case_whose_frames_would_be_called_a_checkpoint_is_refused(tmp_path, name):
    path = tmp_path / f"{name}.toml"
    path.write_text(BOX, encoding="utf-8")
    job = mpirun(1, ["-m", "psph", path, "--out", tmp_path / "run"])
    assert job.returncode == 2
    assert f"{path}: its frames would be called {name}.h5, as a checkpoint is; rename the file" in job.stderr
    assert not (tmp_path / "run").exists()
    path.rename(tmp_path / "checkpoint-one.toml")
    load(tmp_path / "checkpoint-one.toml")


# One at a time


def test_a_folder_where_another_is_at_work_is_refused(tmp_path):
    folder = tmp_path / "run"
    case = boxed(tmp_path, COMM, SHORT, "checkpoint.every=1")
    run(case, folder, COMM, **QUIET)
    before = contents(folder)
    with alone_in(folder, COMM):
        with pytest.raises(OutputError, match=f"another psph is at work in .*process {os.getpid()} on "):
            resume(folder, COMM, ["time.end=2e-3"], **QUIET)
        with pytest.raises(OutputError, match="another psph is at work in .*wait for it or end it"):
            run(case, folder, COMM, overwrite=True, **QUIET)
        assert (folder / IN_USE).exists()
    assert contents(folder) == before
    resume(folder, COMM, ["time.end=2e-3"], **QUIET)
    assert not (folder / IN_USE).exists()


def test_one_that_is_about_to_be_gone_is_waited_for(tmp_path):
    """A job that was killed may be gone a moment after its mpirun."""
    dying = "import fcntl, sys, time; f = open(sys.argv[1], 'w'); fcntl.flock(f, fcntl.LOCK_EX)"
    dying += "; print('held', flush=True); time.sleep(1.0)"
    job = subprocess.Popen(
        [sys.executable, "-c", dying, tmp_path / IN_USE], stdout=subprocess.PIPE, text=True
    )
    assert job.stdout.readline() == "held\n"
    begun = time.monotonic()
    with alone_in(tmp_path, COMM):
        assert time.monotonic() - begun > 0.5
    job.communicate()


def test_what_a_killed_run_left_holds_nobody_up(tmp_path):
    (tmp_path / IN_USE).write_text("process 1 on a machine that is gone", encoding="utf-8")
    run(boxed(tmp_path, COMM, SHORT), tmp_path, COMM, **QUIET)
    assert not (tmp_path / IN_USE).exists()


@pytest.mark.parametrize("failing", ["open", "flock"])
def test_a_file_system_without_locks_runs(tmp_path, monkeypatch, failing):
    honest = os.open

    def refused(path, *arguments, **named):
        if failing == "flock" or str(path).endswith(IN_USE):
            raise OSError(95, "Operation not supported")
        return honest(path, *arguments, **named)

    case = boxed(tmp_path, COMM, SHORT)
    monkeypatch.setattr("fcntl.flock" if failing == "flock" else "os.open", refused)
    run(case, tmp_path / "run", COMM, **QUIET)
    assert (tmp_path / "run" / "box.h5").exists() and not (tmp_path / "run" / IN_USE).exists()


@pytest.mark.alone
def test_a_real_job_holds_its_folder_until_it_is_killed(tmp_path):
    (tmp_path / "box.toml").write_text(BOX, encoding="utf-8")
    folder = tmp_path / "run"
    case = [tmp_path / "box.toml", "--out", folder, "--set", "checkpoint.every=2"]
    with started(2, [SLOWLY, "0.3", *case]) as job:
        deadline = time.monotonic() + 60.0
        while not checkpoints(folder) and time.monotonic() < deadline:
            time.sleep(0.1)
        for arguments in (["resume", folder], [*case, "--overwrite"]):
            other = mpirun(2, ["-m", "psph", *arguments])
            said = [line for line in other.stderr.splitlines() if "another psph is at work in" in line]
            assert other.returncode == 3 and len(said) == 1 and "Traceback" not in other.stderr
        for rank in ranks_of(job):
            os.kill(rank, signal.SIGKILL)
        job.communicate(timeout=60)
    assert b"\0" not in (folder / "log.csv").read_bytes()
    again = mpirun(1, ["-m", "psph", "resume", folder])
    assert again.returncode == 0, again.stderr
