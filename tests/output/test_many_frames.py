"""Thousands of frames: what viewers open grows with them, is whole at any moment, lacks none."""

import os
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np
import pytest
from long import LONG, tell
from mpi4py import MPI
from viewers import seen_by_meshio, seen_by_vtk

from psph.output import xdmf
from psph.output.frames import FrameFile
from psph.output.reader import Run


def cloud(frame, count=5):
    """A few particles that know the number of their frame."""
    return {
        "id": np.arange(count),
        "kind": np.zeros(count, np.uint8),
        "position": np.full((count, 2), float(frame)) + np.arange(count)[:, None],
        "velocity": np.zeros((count, 2)),
        "density": np.ones(count),
        "pressure": np.full(count, float(frame)),
    }


def write(frames, first, last):
    for k in range(first, last):
        frames.write(k, 0.5 * k, 3 * k, cloud(k))


@pytest.fixture(autouse=True)
def unhurried(monkeypatch):
    """The index may be written at any time."""
    monkeypatch.setattr(xdmf, "PAUSE", 0.0)


@pytest.fixture
def replaced(monkeypatch):
    """Sizes of the index, one for each time that it was written."""
    sizes, replace = [], os.replace

    def counted(fresh, path):
        if Path(path).suffix == ".xdmf":
            sizes.append(os.path.getsize(fresh))
        replace(fresh, path)

    monkeypatch.setattr(os, "replace", counted)
    return sizes


def listed(index):
    """How many frames it lists; fails where it is not whole."""
    return len(ElementTree.parse(index).findall(".//Time"))


@pytest.mark.parametrize("count", [120, pytest.param(3000, marks=[LONG, pytest.mark.timeout(600)])])
def test_the_work_grows_with_the_frames_and_not_faster(tmp_path, alone, replaced, count):
    frames, seconds = FrameFile(tmp_path / "tank.h5", alone, {}), []
    for part in range(3):
        begun = time.process_time()
        write(frames, part * count // 3, (part + 1) * count // 3)
        seconds.append(time.process_time() - begun)
    frames.complete_index()
    index = frames.path.with_suffix(".xdmf")
    assert sum(replaced) < frames.path.stat().st_size + replaced[-1]
    assert sum(replaced) < 12 * replaced[-1]  # at each frame it would be count/2 times
    assert seconds[2] < 2.0 * seconds[0]
    assert listed(index) == len(Run(tmp_path).times) == count
    for seen in (seen_by_vtk(index), seen_by_meshio(index)):
        assert [t for t, _, _ in seen] == [0.5 * k for k in range(count)]
        assert [fields["pressure"][0] for _, _, fields in seen] == list(range(count))
    tell("frames written and seen by ParaView's reader and meshio", count)


def test_large_frames_are_seen_at_once(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    for k in range(20):
        frames.write(k, 0.5 * k, k, cloud(k, count=500))
        assert listed(tmp_path / "tank.xdmf") == k + 1


def test_the_index_is_written_once_a_pause(tmp_path, alone, replaced, monkeypatch):
    """A run of many frames a second would wait for its file system at each."""
    clock = [0.0]
    monkeypatch.setattr(xdmf, "PAUSE", 1.0)
    monkeypatch.setattr(xdmf, "monotonic", lambda: clock[0])
    frames, seen = FrameFile(tmp_path / "tank.h5", alone, {}), []
    for k in range(11):
        clock[0] = 0.3 * k
        frames.write(k, 0.5 * k, k, cloud(k, count=500))
        seen.append(listed(tmp_path / "tank.xdmf"))
    assert seen == [1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9] and len(replaced) == 3
    frames.complete_index()
    assert listed(tmp_path / "tank.xdmf") == 11


def test_tiny_frames_are_seen_after_a_while_and_at_the_end(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    behind = []
    for k in range(100):
        write(frames, k, k + 1)
        behind.append(1.0 - listed(tmp_path / "tank.xdmf") / (k + 1))
    assert 0.0 < max(behind) < 0.25
    frames.close()
    assert listed(tmp_path / "tank.xdmf") == 100


READER = """
import sys, time
import xml.etree.ElementTree as ElementTree
counts = []
print("reads", flush=True)
while not counts or counts[-1] < int(sys.argv[2]):
    counts.append(len(ElementTree.parse(sys.argv[1]).findall(".//Time")))
assert counts == sorted(counts)
print(len(counts), len(set(counts)))
"""


def test_a_reader_sees_a_whole_file_at_any_moment(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    write(frames, 0, 1)
    reader = subprocess.Popen(
        [sys.executable, "-c", READER, tmp_path / "tank.xdmf", "80"],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert reader.stdout.readline() == "reads\n"
    for k in range(1, 80):
        write(frames, k, k + 1)
        frames.complete_index()
    looks, different = map(int, reader.communicate(timeout=60)[0].split())
    assert reader.returncode == 0 and looks >= different > 10


def test_a_kill_leaves_an_index_that_resume_mends(tmp_path):
    """Written in one go, or cut at a moment when the index is behind: the same bytes."""
    alone = MPI.COMM_SELF
    for name in ("unbroken", "killed"):
        (tmp_path / name).mkdir()
    whole = FrameFile(tmp_path / "unbroken/tank.h5", alone, {})
    write(whole, 0, 60)
    whole.complete_index()
    killed, index = FrameFile(tmp_path / "killed/tank.h5", alone, {}), tmp_path / "killed/tank.xdmf"
    write(killed, 0, 40)
    for kept in range(40, 60):
        checkpoint = killed.structure()
        write(killed, kept, kept + 1)
        if listed(index) < kept + 1:
            break
    assert listed(index) < kept + 1  # it is behind
    del killed  # as by SIGKILL: nothing ends the files
    again = FrameFile(tmp_path / "killed/tank.h5", alone, {}, checkpoint)
    assert listed(index) == kept
    write(again, kept, 60)
    again.complete_index()
    assert index.read_bytes() == (tmp_path / "unbroken/tank.xdmf").read_bytes()


def test_a_lost_index_is_written_again(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    write(frames, 0, 30)
    (tmp_path / "tank.xdmf").unlink()
    write(frames, 30, 31)
    frames.close()
    assert listed(tmp_path / "tank.xdmf") == 31


def test_numbers_past_32_bits(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    frames.write(99_999, 1.0, 2**31 - 1, cloud(1))
    frames.write(2**31 + 7, 2.0, 2**40, cloud(2))
    assert Run(tmp_path).frame(-1)["pressure"][0] == 2.0
    assert [t for t, _, _ in seen_by_vtk(tmp_path / "tank.xdmf")] == [1.0, 2.0]
    with h5py.File(tmp_path / "tank.h5") as file:
        assert file[f"frames/{2**31 + 7}"].attrs["step"] == 2**40
