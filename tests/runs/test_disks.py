"""Disks that fill up, folders that may not be written, files that others read meanwhile."""

import subprocess
import sys
from contextlib import contextmanager

import pytest
from jobs import clean_environment, mpirun, started
from long import LONG, tell
from mpi4py import MPI
from runs.resuming import BOX, same_files, stop_after

from psph.case import load
from psph.output.checkpoint import checkpoints
from psph.output.errors import OutputError
from psph.output.reader import Run
from psph.runs.disk_check import TooLittleDisk
from psph.runs.start import resume, run
from psph.runs.watch import Stopped

COMM = MPI.COMM_SELF

SIZE = 4 << 20
"""Bytes of the small disk."""

RARELY = ["output.frames=1.0", "output.log=1.0", "output.probes=1.0", "checkpoint.every=1000"]
"""Nothing is due before the end of the run; each test has one of these often."""


@contextmanager
def disk(folder, options):
    """A small disk in memory, mounted at ``folder``; whoever may not mount is skipped."""
    folder.mkdir()
    how = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder]
    mounted = subprocess.run(how, capture_output=True, text=True)
    if mounted.returncode != 0:
        pytest.skip(f"may not mount a disk: {mounted.stderr.strip()}")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


@pytest.fixture
def small_disk(tmp_path):
    with disk(tmp_path / "disk", f"size={SIZE}") as folder:
        yield folder


FILLED = """
import sys
from psph.runs import start as run

original = run.Progress
def full(comm, *args):
    if comm.rank == 0:
        with open(ballast, "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass
    comm.Barrier()
    return original(comm, *args)
run.Progress = full

from psph.__main__ import guarded
ballast = sys.argv[1]
guarded(sys.argv[2:])
"""
"""psph, but somebody takes all room on the disk just before the first step."""


def simulate(folder, *keys):
    """A run of the boxes in ``folder`` on one rank; returns the folder."""
    case = folder.with_name("box.toml")
    case.write_text(BOX, encoding="utf-8")
    run(load(case, keys), folder, COMM, say=quiet)
    return folder


def quiet(*_):
    pass


@pytest.mark.parametrize(
    "often, file",
    [
        ("output.frames=0.02", "box.h5"),
        pytest.param("checkpoint.every=12", "checkpoint-12.h5", marks=LONG),
        pytest.param("output.log=1e-3", "log.csv", marks=LONG),
    ],
)
def test_a_full_disk_is_one_line_and_the_run_goes_on_when_there_is_room(
    small_disk, tmp_path, monkeypatch, often, file
):
    with monkeypatch.context() as told, pytest.raises(Stopped):
        stop_after(told, 10)
        simulate(small_disk / "run", *RARELY, often, "time.end=0.1")
    folder = small_disk / "run"
    whole = simulate(tmp_path / "whole", *RARELY, often, "time.end=0.1")
    before = {path: path.read_bytes() for path in checkpoints(folder)}
    ballast, program = small_disk / "ballast", tmp_path / "filled.py"
    program.write_text(FILLED, encoding="utf-8")
    job = mpirun(2, [program, ballast, "resume", folder])
    assert job.returncode == 3 and "Traceback" not in job.stderr, job.stderr
    [line] = [line for line in job.stderr.splitlines() if "cannot be written" in line]
    assert line.startswith(f"{folder / file}: cannot be written: No space left on device; check")
    assert {path: path.read_bytes() for path in checkpoints(folder)} == before
    assert Run(folder).times[0] == 0.0  # what was written can still be read
    with pytest.raises(TooLittleDisk, match="are free in .*: make space"):
        resume(folder, COMM, say=quiet)
    assert {path: path.read_bytes() for path in checkpoints(folder)} == before
    ballast.unlink()
    resume(folder, COMM, say=quiet)
    assert same_files(folder, whole)


def test_a_folder_that_may_only_be_read_is_one_line(tmp_path):
    case = tmp_path / "box.toml"
    case.write_text(BOX, encoding="utf-8")
    with disk(tmp_path / "disk", "ro,size=1M") as folder:
        job = mpirun(2, ["-m", "psph", case, "--out", folder / "run"])
    assert job.returncode == 3 and "Traceback" not in job.stderr
    [line] = [line for line in job.stderr.splitlines() if line.startswith(str(folder))]
    assert line == f"{folder}/run: Read-only file system; choose another folder with --out"


def test_a_disk_that_turned_read_only_is_one_line(small_disk):
    folder = simulate(small_disk / "run", "time.end=0.1")
    subprocess.run(["mount", "-o", "remount,ro", small_disk], check=True)
    with pytest.raises(OutputError) as failed:
        resume(folder, COMM, ["time.end=0.2"], say=quiet)
    assert str(failed.value).startswith(f"{folder}: cannot be written: Read-only file system; check")
    assert "\n" not in str(failed.value)


READER = """
import sys, time, h5py
opened = 0
print("reading", flush=True)
while True:
    try:
        with h5py.File(sys.argv[1], "r", locking=False) as file:
            for frame in file["frames"].values():
                frame.attrs["time"], [field[...] for field in frame.values()]
            opened += 1
            time.sleep(0.02)
    except (OSError, KeyError, RuntimeError, AttributeError):
        time.sleep(0.001)
    print(opened, flush=True)
"""
"""Opens the frames again and again, holds them open and reads all; a structure that is just being
changed may refuse, or have no frame where one is named."""


def test_a_run_goes_on_while_its_frames_are_read(tmp_path):
    often = ["output.frames=0.02", "checkpoint.every=20", "time.end=0.8"]
    whole, folder = simulate(tmp_path / "whole", *often), tmp_path / "run"
    reader = subprocess.Popen(
        [sys.executable, "-c", READER, folder / "box.h5"],
        stdout=subprocess.PIPE,
        text=True,
        env=clean_environment(),
    )
    sets = [word for key in often for word in ("--set", key)]
    arguments = [tmp_path / "box.toml", "--out", folder, *sets]
    try:
        assert reader.stdout.readline() == "reading\n"
        with started(2, ["-m", "psph", *arguments]) as job:
            _, said = job.communicate(timeout=120)
    finally:
        reader.kill()
        seen, _ = reader.communicate()
    assert job.returncode == 0, said
    assert int(seen.split()[-1]) > 3
    tell("times that another process opened the frames of a run", int(seen.split()[-1]))
    assert same_files(folder, whole)
