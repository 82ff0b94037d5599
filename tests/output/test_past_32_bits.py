"""Frames of more than 2^31 particles: a sparse file, so that they need no room."""

import os
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from mpi4py import MPI

from psph.output import rows as hdf5
from psph.output.frames import FrameFile
from psph.output.xdmf import XdmfIndex

FIRST = 2**32 + 5
"""Particles of the ranks before this one, as far as it is told."""


@pytest.fixture
def reserved(monkeypatch):
    """Sizes that were asked for; the file grows, and takes nothing of the disk."""
    sizes = []

    def grow(path, size):
        sizes.append(size)
        os.truncate(path, os.path.getsize(path) + size)

    monkeypatch.setattr(hdf5, "reserve", grow)
    return sizes


class SecondRank:
    """The second of two ranks; the first one has ``FIRST`` particles and no trouble."""

    rank, size = 1, 2

    def allgather(self, mine):
        """What both have."""
        return [FIRST if isinstance(mine, int) else None, mine]


def test_a_rank_knows_its_rows_past_2_31(tmp_path, monkeypatch):
    filled = []
    monkeypatch.setattr(hdf5, "fill", lambda *call: filled.append(call))
    frames = FrameFile(tmp_path / "tank.h5", SecondRank(), {})
    frames.write(0, 0.0, 0, {"position": np.ones((3, 2))})
    [(_, _, rows, counts)] = filled
    assert counts == [FIRST, 3]
    connectivity = rows[f"connectivity/{FIRST + 3}"]
    assert connectivity.dtype == np.int64
    assert connectivity.tolist() == [FIRST, FIRST + 1, FIRST + 2]


@pytest.mark.skipif(not h5py.get_config().mpi, reason="h5py is built without MPI")
def test_rows_past_2_31_land_in_their_place(tmp_path, alone, reserved):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    total = FIRST + 4
    rows = {
        "frames/00000/position": np.arange(12.0).reshape(4, 3) + 1,
        "frames/00000/id": np.arange(FIRST, total),
    }
    shapes = {name: (total, *part.shape[1:]) for name, part in rows.items()}
    with hdf5.opened(frames.path) as file:
        frames._lay_out(file, "frames/00000", 7, shapes, rows)
    assert reserved[-1] > total * (24 + 8) > 2**36
    with h5py.File(frames.path, "r+", driver="mpio", comm=MPI.COMM_SELF) as file:
        hdf5.fill_collectively(file, rows, FIRST)
    assert os.path.getsize(frames.path) > total * (24 + 8)
    with h5py.File(frames.path) as file:
        frame = file["frames/00000"]
        assert frame["position"].shape == (total, 3)
        for name, part in rows.items():
            assert np.array_equal(file[name][FIRST:], part)
            assert not file[name][FIRST - 5 : FIRST].any()
        assert not frame["position"][:4].any()  # nothing came round to the beginning


def test_space_past_2_31_bytes_is_taken(tmp_path, monkeypatch):
    taken = []
    monkeypatch.setattr(hdf5, "_allocate", lambda fd, end, size: taken.append((end, size)) or 0)
    path = tmp_path / "tank.h5"
    path.touch()
    os.truncate(path, 2**40)
    hdf5.reserve(path, 2**37)
    assert taken == [(2**40, 2**37)]


def test_xdmf_tells_numbers_past_2_31(tmp_path):
    (tmp_path / "tank.h5").touch()
    index = XdmfIndex(tmp_path / "tank.h5")
    kind = SimpleNamespace(vector=((2**33, 3), np.dtype(float)), whole=((2**33,), np.dtype("int64")))
    index.add(
        "frames/00000",
        0.0,
        {
            "frames/00000/position": kind.vector,
            "frames/00000/id": kind.whole,
        },
    )
    index.complete()
    text = index.path.read_text()
    assert 'NumberOfElements="8589934592"' in text
    assert 'Dimensions="8589934592 3"' in text
    assert 'Dimensions="8589934592" NumberType="Int" Precision="8"' in text
    assert "tank.h5:/connectivity/8589934592<" in text
