"""The file of a checkpoint: to the bit what was written, and refused where it is not."""

import json
import re
import resource

import h5py
import numpy as np
import pytest
from mpi4py import MPI

from psph.output import checkpoint
from psph.output.checkpoint import CheckpointError, Saved, checkpoint_path, checkpoints, checksum
from psph.output.errors import OutputError
from psph.output.rows import CHUNK

COMM = MPI.COMM_SELF


def rows(count=40, seed=1):
    """The fields of a few particles; numbers that a careless reader would change among them."""
    random = np.random.default_rng(seed)
    density = random.random(count)
    density[:4] = np.nan, -0.0, np.inf, 5e-324
    return {
        "id": np.arange(count)[::-1] + 2**40,
        "kind": (np.arange(count) % 2).astype(np.uint8),
        "position": random.random((count, 2)),
        "density": density,
    }


def written(folder, step=7, arrays=None, case="this case"):
    """The path of a fresh checkpoint."""
    path = checkpoint_path(folder, step)
    header = {"case": case, "state": {"time": 0.1 + 0.2, "since": None, "steps": step}}
    checkpoint.write(path, COMM, arrays or rows(), header)
    return path


def objection(path, case="this case"):
    """Why a checkpoint is refused; fails where it is not."""
    with pytest.raises(CheckpointError) as refused:
        Saved(path, COMM, case)
    assert "\n" not in str(refused.value) and str(refused.value).startswith(f"{path}: ")
    return str(refused.value).removeprefix(f"{path}: ")


def test_it_is_read_back_to_the_bit(tmp_path):
    arrays = rows()
    saved = Saved(written(tmp_path, arrays=arrays), COMM, "this case")
    assert saved.state == {"time": 0.1 + 0.2, "since": None, "steps": 7}
    for name, found in zip(arrays, saved.share(*arrays), strict=True):
        assert found.dtype == arrays[name].dtype and found.tobytes() == arrays[name].tobytes()


def test_any_reader_of_hdf5_opens_it(tmp_path):
    with h5py.File(written(tmp_path)) as file:
        assert sorted(file["particles"]) == ["density", "id", "kind", "position"]


def test_every_flipped_bit_is_seen(tmp_path):
    """One at a time, all over the file; only the unused end of the header's block is free."""
    path = written(tmp_path)
    whole = path.read_bytes()
    header, room = whole.index(b"\0"), whole.index(b"\x89HDF\r\n\x1a\n")
    places = json.loads(whole[whole.index(b"{") : header])["places"]
    random = np.random.default_rng(3)
    for place in [*range(0, header, 97), *range(room, len(whole), 13)]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(random.integers(8))
        path.write_bytes(damaged)
        said = objection(path)
        inside = [n for n, (first, size) in places.items() if first <= place < first + size]
        assert not inside or said == f"damaged: the dataset {inside[0]} does not match its checksum"
    path.write_bytes(whole)
    Saved(path, COMM, "this case")


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.999])
def test_a_file_that_is_cut_short_is_seen(tmp_path, share):
    path = written(tmp_path)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    assert objection(path).startswith("damaged: ")
    path.write_bytes(whole + b"\0")
    assert re.fullmatch(r"damaged: [\d,]+ bytes instead of [\d,]+", objection(path))


def test_another_case_version_or_format_is_refused(tmp_path, monkeypatch):
    path = written(tmp_path)
    assert "belongs to another case than" in objection(path, "that case")
    monkeypatch.setattr(checkpoint, "__version__", "99.1")
    assert "resume with the psph that wrote it" in objection(path)
    monkeypatch.undo()
    monkeypatch.setattr(checkpoint, "FORMAT", checkpoint.FORMAT + 1)
    assert f"(format {checkpoint.FORMAT - 1}), this is psph" in objection(path)


def test_two_stay_and_what_is_left_of_a_broken_write_goes(tmp_path):
    for step in (8, 9, 10):
        written(tmp_path, step)
    assert [path.name for path in checkpoints(tmp_path)] == ["checkpoint-10.h5", "checkpoint-9.h5"]
    (tmp_path / "checkpoint-11.h5.new").touch()
    checkpoint.remove_checkpoints(tmp_path, after=9)
    assert [path.name for path in tmp_path.iterdir()] == ["checkpoint-9.h5"]
    checkpoint.remove_checkpoints(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_older_one_whole(tmp_path):
    old = written(tmp_path)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(OutputError, match="checkpoint-8.h5: cannot be written: File too large"):
            written(tmp_path, 8, rows(10_000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(tmp_path.iterdir()) == [old]
    Saved(old, COMM, "this case")


@pytest.mark.parametrize("shape", [(CHUNK + 9,), (CHUNK + 9, 3)])
def test_the_checksum_is_that_of_its_parts_and_knows_places(shape):
    part = np.random.default_rng(0).random(shape)
    whole = checksum(part, 0)
    for cut in (0, 1, 1000, CHUNK, len(part)):
        assert (checksum(part[:cut], 0) + checksum(part[cut:], cut)) % 2**64 == whole
    assert checksum(part[::-1], 0) != whole != checksum(part, 1)
    assert checksum(np.asfortranarray(part), 0) == whole


def test_the_checksum_by_hand():
    """Of two numbers, in whole numbers of Python."""

    def mix(z):
        z = (z + 0x9E3779B97F4A7C15) % 2**64
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB % 2**64
        return z ^ (z >> 31)

    assert mix(0) == 0xE220A8397B1DCDAF  # SplitMix64 of seed 0
    words = 2**40 + 3, 17
    expected = sum(mix(word ^ mix(5 + k)) for k, word in enumerate(words)) % 2**64
    assert checksum(np.array(words), 5) == expected
