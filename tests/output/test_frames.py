"""Frames on one rank: what stands in the file, and what other programs see of it."""

import errno
import os
import resource
import subprocess
import sys

import h5py
import numpy as np
import pytest
from viewers import cloud, padded, seen_by_meshio, seen_by_vtk

from psph.fields import SAVED, by_name
from psph.output import rows as hdf5
from psph.output.errors import OutputError
from psph.output.frames import FrameFile, funnel_notice
from psph.output.reader import Run


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_frame_is_read_back_to_the_bit(tmp_path, alone, dimensions):
    frames = FrameFile(tmp_path / "tank.h5", alone, {"case": "x" * 100_000, "dimensions": 2})
    written = [cloud(20, dimensions, seed) for seed in range(3)]
    for k, arrays in enumerate(written):
        frames.write(k, 0.1 * k, 7 * k, arrays)
    run = Run(tmp_path)
    assert run.case_text == "x" * 100_000
    assert run.attributes["dimensions"] == 2
    assert run.times.tolist() == [0.0, 0.1, 0.2]
    for k, arrays in enumerate(written):
        frame = run.frame(k)
        assert frame.keys() == arrays.keys()
        for name, rows in arrays.items():
            assert frame[name].dtype == rows.dtype
            assert np.array_equal(frame[name], rows)


def test_datasets_are_contiguous_and_described(tmp_path, alone):
    FrameFile(tmp_path / "tank.h5", alone, {}).write(3, 0.5, 11, cloud(5, 2))
    with h5py.File(tmp_path / "tank.h5") as file:
        frame = file["frames/00003"]
        assert dict(frame.attrs) == {"time": 0.5, "step": 11}
        for name, dataset in frame.items():
            assert dataset.chunks is None
            described = (dataset.attrs["unit"], dataset.attrs["meaning"])
            assert described == (by_name(SAVED)[name].unit, by_name(SAVED)[name].meaning)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
@pytest.mark.parametrize("name", ["tank.h5", "a tank & more.h5"])
def test_viewers_see_every_frame(tmp_path, alone, dimensions, name):
    frames = FrameFile(tmp_path / name, alone, {})
    written = [cloud(20 + k, dimensions, k) for k in range(2)]  # the number may change
    for k, arrays in enumerate(written):
        frames.write(k, 0.25 * k, k, arrays)
    frames.complete_index()
    seen = seen_by_vtk(frames.path.with_suffix(".xdmf"))
    assert len(seen) == 2
    for k, (time, points, fields) in enumerate(seen):
        arrays = written[k]
        assert time == 0.25 * k
        assert np.array_equal(points, padded(arrays["position"]))
        velocity = arrays["velocity"][:, 0] if dimensions == 1 else padded(arrays["velocity"])
        assert np.array_equal(fields["velocity"], velocity)
        for scalar in ("id", "kind", "density", "pressure"):
            assert np.array_equal(fields[scalar], arrays[scalar])


def test_pyvista_opens_the_file_by_its_name(tmp_path, alone):
    """Of one called ``.xmf`` it ends Python."""
    pyvista = pytest.importorskip("pyvista")
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    frames.write(0, 0.0, 0, cloud(20, 3, 0))
    [index] = {path for path in tmp_path.iterdir() if path.name != "tank.h5"}
    seen = pyvista.read(index)
    assert seen.n_points == 20 and "pressure" in seen.point_data


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_meshio_sees_every_frame(tmp_path, alone, dimensions):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    written = [cloud(20, dimensions, k) for k in range(2)]
    for k, arrays in enumerate(written):
        frames.write(k, 0.25 * k, k, arrays)
    frames.complete_index()
    seen = seen_by_meshio(tmp_path / "tank.xdmf")
    assert len(seen) == 2
    for k, (time, points, fields) in enumerate(seen):
        assert time == 0.25 * k
        assert np.array_equal(padded(points), padded(written[0]["position"]))
        for name in written[k].keys() - {"position"}:
            assert np.array_equal(fields[name], written[k][name])


def test_new_run_replaces_the_old_one(tmp_path, alone):
    FrameFile(tmp_path / "tank.h5", alone, {}).write(0, 0.0, 0, cloud(5, 2))
    FrameFile(tmp_path / "tank.h5", alone, {})
    assert os.listdir(tmp_path) == ["tank.h5"]
    assert len(Run(tmp_path).times) == 0


def test_viewer_with_the_file_open_stops_nothing(tmp_path, alone):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    look = "import h5py, sys; file = h5py.File(sys.argv[1]); print('open', flush=True); input()"
    viewer = subprocess.Popen(
        [sys.executable, "-c", look, frames.path],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert viewer.stdout.readline() == "open\n"
    frames.write(0, 0.0, 0, cloud(5, 2))
    viewer.communicate("\n")
    assert len(Run(tmp_path).times) == 1


def test_interrupted_frame_does_not_count(tmp_path, alone, monkeypatch):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    frames.write(0, 0.0, 0, cloud(5, 2))

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(hdf5, "fill", interrupt)
    with pytest.raises(KeyboardInterrupt):
        frames.write(1, 0.1, 1, cloud(5, 2))
    assert Run(tmp_path).times.tolist() == [0.0]
    assert len(seen_by_vtk(tmp_path / "tank.xdmf")) == 1


def test_missing_folder_is_one_line(tmp_path, alone):
    with pytest.raises(OutputError) as error:
        FrameFile(tmp_path / "none" / "tank.h5", alone, {})
    assert str(error.value).startswith(f"{tmp_path}/none/tank.h5: cannot be written: No such file")
    assert "\n" not in str(error.value)


@pytest.fixture
def full_disk():
    """Files end at 100 kB: the call gives what the full disk gives, an error from the system."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_full_disk_is_one_line_and_leaves_the_frames_before(tmp_path, alone, full_disk):
    frames = FrameFile(tmp_path / "tank.h5", alone, {})
    frames.write(0, 0.0, 0, cloud(100, 2))
    with pytest.raises(OutputError, match="cannot be written: File too large; .* free space"):
        frames.write(1, 0.1, 1, cloud(10_000, 2))
    assert Run(tmp_path).times.tolist() == [0.0]


def test_rows_must_agree(tmp_path, alone):
    arrays = cloud(5, 2)
    arrays["density"] = arrays["density"][:4]
    with pytest.raises(ValueError, match="density: not 5 rows as position"):
        FrameFile(tmp_path / "tank.h5", alone, {}).write(0, 0.0, 0, arrays)


def test_one_rank_needs_no_notice(alone):
    assert funnel_notice(alone) is None


def test_room_on_a_disk_that_cannot_allocate_is_asked_for_not_written(tmp_path, monkeypatch):
    """glibc would write to every block of it: gigabytes for a large frame."""
    monkeypatch.setattr(hdf5, "_allocate", lambda *_: errno.EOPNOTSUPP)
    monkeypatch.delattr(os, "posix_fallocate")
    path = tmp_path / "tank.h5"
    path.write_bytes(b"head")
    hdf5.reserve(path, 1 << 26)
    assert path.read_bytes() == b"head"
    with pytest.raises(OSError, match="No space left on device"):
        hdf5.reserve(path, 1 << 60)
    assert path.read_bytes() == b"head"


def test_room_on_the_disk_is_taken_or_refused(tmp_path):
    path = tmp_path / "tank.h5"
    path.write_bytes(b"head")
    hdf5.reserve(path, 1 << 20)
    assert path.read_bytes() == b"head" and 512 * path.stat().st_blocks >= 1 << 20
    with pytest.raises(OSError):
        hdf5.reserve(path, 1 << 60)
    hdf5.give_back(path)
    assert path.read_bytes() == b"head" and 512 * path.stat().st_blocks < 1 << 20


def test_a_frame_opens_the_file_once_and_cuts_nothing(tmp_path, alone, monkeypatch):
    """Each time takes as long as the numbers of a small frame, and a cut is waited for."""
    frames, opened, calls = FrameFile(tmp_path / "tank.h5", alone, {}), hdf5.opened, []
    monkeypatch.setattr(hdf5, "opened", lambda path: calls.append(path) or opened(path))
    frames.write(0, 0.0, 0, cloud(5, 2))
    assert calls == [frames.path]
    with h5py.File(frames.path) as file:
        assert file.id.get_filesize() == frames.path.stat().st_size
    frames.close()
    assert 512 * frames.path.stat().st_blocks < frames.path.stat().st_size + hdf5.MARGIN
