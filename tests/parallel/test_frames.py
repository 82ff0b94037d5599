"""Frames from two ranks: the same file as from one, whichever way the rows take."""

import os
import resource
import subprocess
import sys
from contextlib import contextmanager, nullcontext

import h5py
import numpy as np
import pytest
from viewers import cloud, padded, seen_by_meshio, seen_by_vtk

from psph.output import rows as hdf5
from psph.output.errors import OutputError, together
from psph.output.frames import FrameFile, funnel_notice
from psph.output.reader import Run
from psph.output.rows import CHUNK
from psph.output.tables import CsvTable

pytestmark = pytest.mark.mpi(min_size=2)


@pytest.fixture
def comm():
    from mpi4py import MPI

    return MPI.COMM_WORLD


@pytest.fixture(params=["at once", "parallel", "funnel"])
def way(request, monkeypatch):
    """All ways to the file; the parallel one needs an h5py that was built for it."""
    monkeypatch.setattr(hdf5, "AT_ONCE", 1 << 30 if request.param == "at once" else 0)
    if request.param == "funnel":
        monkeypatch.setattr(hdf5, "parallel_hdf5", lambda: False)
    elif not h5py.get_config().mpi:
        pytest.skip("h5py is built without MPI")
    return request.param


def share(arrays, comm, sizes):
    """The rows of this rank when rank r owns ``sizes[r]`` of them, ranks without a size none."""
    sizes = [*sizes, *[0] * comm.size][: comm.size]
    first = sum(sizes[: comm.rank])
    return {name: rows[first : first + sizes[comm.rank]] for name, rows in arrays.items()}


@pytest.mark.parametrize("dimensions", [1, 2, 3])
@pytest.mark.parametrize("sizes", [(7, 13), (20, 0), (0, 20)])
def test_file_is_that_of_one_rank(comm, mpi_tmp_path, way, dimensions, sizes):
    arrays = cloud(20, dimensions)
    frames = FrameFile(mpi_tmp_path / "tank.h5", comm, {"case": "title = 'tank'"})
    for k in range(2):
        frames.write(k, 0.5 * k, k, share(arrays, comm, sizes))
    run = Run(mpi_tmp_path)
    assert run.case_text == "title = 'tank'"
    assert run.times.tolist() == [0.0, 0.5]
    for k in range(2):
        frame = run.frame(k)
        assert frame.keys() == arrays.keys()
        for name, rows in arrays.items():
            assert frame[name].dtype == rows.dtype
            assert np.array_equal(frame[name], rows)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_viewers_see_every_frame(comm, mpi_tmp_path, way, dimensions):
    written = [cloud(20, dimensions, seed) for seed in range(2)]
    frames = FrameFile(mpi_tmp_path / "tank.h5", comm, {})
    for k, arrays in enumerate(written):
        frames.write(k, 0.5 * k, k, share(arrays, comm, (7, 13)))
    frames.complete_index()
    if comm.rank == 0:
        index = mpi_tmp_path / "tank.xdmf"
        for arrays, (time, points, fields), (_, _, again) in zip(
            written, seen_by_vtk(index), seen_by_meshio(index), strict=True
        ):
            assert time in (0.0, 0.5)
            assert np.array_equal(points, padded(arrays["position"]))
            for name in ("id", "pressure"):
                assert np.array_equal(fields[name], arrays[name])
                assert np.array_equal(again[name], arrays[name])
            assert np.array_equal(again["velocity"], arrays["velocity"])
            velocity = fields["velocity"].reshape(20, -1)
            assert np.array_equal(padded(velocity), padded(arrays["velocity"]))


def test_many_rows_travel_in_pieces(comm, mpi_tmp_path, way):
    count = 2 * CHUNK + 3
    arrays = {"position": np.arange(4.0 * count).reshape(-1, 2), "id": np.arange(2 * count)}
    sizes = (count, count)
    FrameFile(mpi_tmp_path / "tank.h5", comm, {}).write(0, 0.0, 0, share(arrays, comm, sizes))
    frame = Run(mpi_tmp_path).frame(0)
    for name, rows in arrays.items():
        assert np.array_equal(frame[name], rows)


def test_little_is_written_by_rank_0_alone(comm, mpi_tmp_path, monkeypatch):
    """All ranks at once would wait for each other: a run that is told to end has a second."""
    monkeypatch.setattr(hdf5, "AT_ONCE", 20 * (8 + 1 + 3 * 8 + 3 * 8 + 8 + 8 + 8))
    monkeypatch.setattr(hdf5, "parallel_hdf5", lambda: True)
    together = []
    monkeypatch.setattr(hdf5, "fill_collectively", lambda *_: together.append(True))
    whole = cloud(20, 3) | {"connectivity": np.arange(20)}
    rows, filled = share(whole, comm, (7, 13)), {}
    monkeypatch.setattr(hdf5, "opened", lambda _: nullcontext())
    monkeypatch.setattr(hdf5, "open_file", lambda *_, **how: nullcontext())
    monkeypatch.setattr(
        hdf5, "_write", lambda _, pieces: filled.update((name, rows) for name, _, rows in pieces)
    )
    counts = comm.allgather(len(rows["id"]))
    hdf5.fill(mpi_tmp_path / "tank.h5", comm, rows, counts)
    assert not together
    if comm.rank == 0:
        assert all(np.array_equal(filled[name], part) for name, part in whole.items())
    monkeypatch.setattr(hdf5, "AT_ONCE", hdf5.AT_ONCE - 1)
    hdf5.fill(mpi_tmp_path / "tank.h5", comm, rows, counts)
    assert together


class Counted:
    """A communicator that notes what is called of it."""

    def __init__(self, comm):
        self.comm, self.rank, self.size, self.calls = comm, comm.rank, comm.size, []

    def __getattr__(self, name):
        self.calls.append(name)
        return getattr(self.comm, name)


def test_a_small_frame_waits_for_the_other_ranks_twice(comm, mpi_tmp_path):
    """For how many rows each has, and for whether all went well; in between they send."""
    counted = Counted(comm)
    frames = FrameFile(mpi_tmp_path / "tank.h5", counted, {})
    counted.calls.clear()
    frames.write(0, 0.0, 0, share(cloud(20, 2), comm, (7, 13)))
    assert counted.calls == ["allgather", "Gatherv", "allgather"]


def test_viewer_with_the_file_open_stops_nothing(comm, mpi_tmp_path, way):
    frames = FrameFile(mpi_tmp_path / "tank.h5", comm, {})
    if comm.rank == 0:
        look = "import h5py, sys; file = h5py.File(sys.argv[1]); print('open', flush=True); input()"
        viewer = subprocess.Popen(
            [sys.executable, "-c", look, frames.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={"PATH": os.environ["PATH"]},  # the h5py there must not join this MPI job
        )
        assert viewer.stdout.readline() == "open\n"
    comm.barrier()
    frames.write(0, 0.0, 0, share(cloud(20, 2), comm, (7, 13)))
    assert len(Run(mpi_tmp_path).times) == 1
    if comm.rank == 0:
        viewer.communicate("\n")


@contextmanager
def full_disk():
    """Files end at 100 kB: the call gives what a full disk gives, an error from the system."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_full_disk_is_one_line_on_every_rank(comm, mpi_tmp_path, way):
    frames = FrameFile(mpi_tmp_path / "tank.h5", comm, {})
    frames.write(0, 0.0, 0, share(cloud(100, 2), comm, (50, 50)))
    with pytest.raises(OutputError, match="tank.h5: cannot be written: File too large; check"):
        with full_disk():
            frames.write(1, 0.1, 1, share(cloud(100_000, 2), comm, (50_000, 50_000)))
    assert Run(mpi_tmp_path).times.tolist() == [0.0]


def test_disk_that_fills_up_meanwhile_is_noticed(comm, mpi_tmp_path, way, monkeypatch):
    """Nobody waits for ever, nothing crashes, the frames before stay."""
    if way == "parallel" and comm.size > 2:
        pytest.skip("Open MPI 4.1 loses the error of a collective write on 3 ranks and more")
    frames = FrameFile(mpi_tmp_path / "tank.h5", comm, {})
    frames.write(0, 0.0, 0, share(cloud(100, 2), comm, (50, 50)))
    monkeypatch.setattr(hdf5, "reserve", lambda *_: None)
    monkeypatch.setattr(hdf5, "fill", full_disk()(hdf5.fill))
    with pytest.raises(OutputError, match="tank.h5: cannot be written: .*; check the folder"):
        frames.write(1, 0.1, 1, share(cloud(100_000, 2), comm, (50_000, 50_000)))
    assert Run(mpi_tmp_path).times.tolist() == [0.0]


def test_failure_of_one_rank_is_that_of_all(comm, mpi_tmp_path):
    with pytest.raises(OutputError, match="tank.h5: cannot be written: rank 1 failed; check"):
        with together(comm, mpi_tmp_path / "tank.h5"):
            if comm.rank == 1:
                raise OSError("rank 1 failed")


def test_missing_folder_is_one_line_on_every_rank(comm, mpi_tmp_path):
    with pytest.raises(OutputError, match="tank.h5: cannot be written: No such file"):
        FrameFile(mpi_tmp_path / "none" / "tank.h5", comm, {})
    with pytest.raises(OutputError, match="log.csv: cannot be written: No such file"):
        CsvTable(mpi_tmp_path / "none" / "log.csv", ["time"], comm)


def test_notice_when_rank_0_writes_for_all(comm, way):
    notice = funnel_notice(comm)
    assert (notice is None) == (way != "funnel")
    assert notice is None or f"all {comm.size} ranks" in notice


def test_table_is_written_once(comm, mpi_tmp_path):
    table = CsvTable(mpi_tmp_path / "log.csv", ["time", "rank"], comm)
    table.write([0.1, comm.rank])
    table.close()
    comm.barrier()
    assert (mpi_tmp_path / "log.csv").read_text() == "time,rank\n0.1,0\n"
