"""What HDF5 keeps of a file beside the numbers, put back from whatever state."""

import h5py
import numpy as np
import pytest
from viewers import cloud

from psph.output.frames import FrameFile
from psph.output.reader import Run
from psph.output.structure import copied, put_back
from psph.output.xdmf import XdmfIndex


def places(path):
    """Where the numbers of a file of HDF5 lie, as HDF5 says."""
    found = []

    def note(_, thing):
        if isinstance(thing, h5py.Dataset) and thing.size:
            found.append((thing.id.get_offset(), thing.id.get_storage_size()))

    with h5py.File(path) as file:
        file.visititems(note)
    return found


@pytest.fixture
def tank(tmp_path, alone):
    """(file of three frames, its copy, its bytes)."""
    frames = FrameFile(tmp_path / "tank.h5", alone, {"case": "a = 1"})
    for k in range(3):
        frames.write(k, 0.1 * k, k, cloud(20 + k // 2, 2, k))
    return frames, frames.structure(), frames.path.read_bytes()


def test_a_file_that_has_grown_is_what_it_was(tank):
    frames, copy, whole = tank
    for k in range(3, 40):  # the tree of the group grows and splits
        frames.write(k, 0.1 * k, k, cloud(20, 2, k))
    grown = frames.path.read_bytes()
    assert len(grown) > len(whole) and grown[: len(whole)] != whole
    put_back(frames.path, copy)
    assert frames.path.read_bytes() == whole


def test_a_file_of_which_only_the_numbers_are_left_is_what_it_was(tank):
    """The worst that a killed layout could leave, and more than that."""
    frames, copy, whole = tank
    random = np.random.default_rng(0)
    for length in (len(whole), len(whole) + 10_000, max(map(sum, places(frames.path)))):
        damaged = bytearray(random.bytes(length))
        for first, size in places(frames.path):
            damaged[first : first + size] = whole[first : first + size]
        frames.path.write_bytes(damaged)
        with pytest.raises(OSError):
            h5py.File(frames.path)
        put_back(frames.path, copy)
        assert frames.path.read_bytes() == whole


def test_numbers_that_are_gone_are_said(tank):
    frames, copy, whole = tank
    frames.path.write_bytes(whole[: max(map(sum, places(frames.path))) - 1])
    with pytest.raises(OSError, match="frames are missing, it had [0-9,]+ bytes at the checkpoint"):
        put_back(frames.path, copy)


def test_the_file_goes_on_as_if_nothing_had_been(tank, alone):
    """A second copy, of frames of before and after, is one of them all."""
    frames, copy, _ = tank
    frames.path.write_bytes(frames.path.read_bytes() + b"x" * 5000)
    again = FrameFile(frames.path, alone, {"case": "another that is longer"}, copy)
    again.write(3, 0.3, 3, cloud(20, 2, 3))
    later, whole = again.structure(), frames.path.read_bytes()
    assert later == copied(frames.path, places(frames.path))
    again.write(4, 0.4, 4, cloud(20, 2, 4))
    put_back(frames.path, later)
    assert frames.path.read_bytes() == whole
    run = Run(frames.path.parent)
    assert run.case_text == "another that is longer"
    for k in range(4):
        found, expected = run.frame(k), cloud(20 + (k == 2), 2, k)
        assert all(np.array_equal(found[name], expected[name]) for name in expected)


def test_a_frame_more_costs_a_few_hundred_bytes(tmp_path, alone, monkeypatch):
    monkeypatch.setattr(XdmfIndex, "add", lambda *_: None)
    frames = FrameFile(tmp_path / "tank.h5", alone, {"case": "a = 1"})
    sizes = []
    for k in range(150):
        frames.write(k, 0.1 * k, k, cloud(10, 2, k))
        sizes.append(len(frames.structure()))
    assert (sizes[149] - sizes[49]) / 100 < 400
