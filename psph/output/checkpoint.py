"""Checkpoints: one HDF5 file each, written by all ranks, read on any number of them.

    psph checkpoint <bytes> <sha256>       a line, in the user block that HDF5 leaves alone
    {"format": 1, "psph": ..., ...}        the header, so many bytes of JSON
    /particles/position ...                a dataset a field, one row a particle
    /frames                                what brings the frames' file back (`structure.py`)

Nothing of the file is trusted before it is checked: the header by its SHA-256; all else that is no
particle (what HDF5 itself keeps there: a flipped bit in it may hang HDF5) by a SHA-256 in the
header; each dataset by a sum over its numbers,

    Σ mix(bits ⊕ mix(place))  modulo 2⁶⁴,

``place`` counted over all ranks, ``mix`` the bijection of Steele, Lea & Flood (2014), OOPSLA, 453.
Each rank sums its own rows and integers are added, so the sum is the same on any number of ranks.
A change within one number always shows; any other is missed once in 2⁶⁴.
"""

import hashlib
import json
import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from psph.engine.jit import SOURCES, compiled
from psph.errors import Refused
from psph.output import rows as hdf5
from psph.output.errors import cause, together
from psph.parallel.reductions import wrapped_sums
from psph.version import __version__

FORMAT = 6
"""Number of this form of a file; another one is refused."""

COPY = "case.toml"
"""The case with its defaults filled in, in the folder of a run."""

KEPT = 2
"""Number of checkpoints kept in a folder: the newest, and the one before it."""

GROUP, FRAMES = "particles", "frames"
_FIRST_LINE = re.compile(rb"psph checkpoint (\d{1,6}) ([0-9a-f]{64})\n")
_LONGEST_LINE = 100
_ROOM = 4096
"""Bytes that a header may grow by when the places of the datasets are known: some 50 a dataset."""

_NAME = re.compile(r"checkpoint-(\d+)\.h5")


class CheckpointError(Refused):
    """A checkpoint that cannot be resumed from; one line that says why and what to do."""


def checkpoint_path(folder: Path, step: int) -> Path:
    """The path of the checkpoint of a step."""
    return Path(folder) / f"checkpoint-{step}.h5"


def checkpoints(folder: Path) -> list[Path]:
    """The checkpoints in a folder, the newest first."""
    numbered = [
        (int(name[1]), path)
        for path in Path(folder).glob("checkpoint-*.h5")
        if (name := _NAME.fullmatch(path.name))
    ]
    return [path for _, path in sorted(numbered, reverse=True)]


def half_written(folder: Path) -> list[Path]:
    """What interrupted writes have left in a folder."""
    return sorted(Path(folder).glob("checkpoint-*.h5.new"))


def remove_checkpoints(folder: Path, after: int = -1) -> None:
    """Remove those of later steps than ``after``, and what an interrupted write has left."""
    for path in checkpoints(folder):
        if int(_NAME.fullmatch(path.name)[1]) > after:
            path.unlink()
    for path in half_written(folder):
        path.unlink()


def write(
    path: Path, comm, arrays: dict[str, np.ndarray], header: dict[str, Any], frames: bytes = b""
) -> None:
    """Write a checkpoint; older ones stay whole until it is on the disk, ``KEPT`` in all stay.

    ``arrays`` are the rows of this rank, ``(n,)`` or ``(n, k)``, of 8 bytes or 1 a number, those
    of all ranks one after another; ``header`` goes into JSON, ``frames`` as it is, both on rank 0.
    Collective; raises OutputError on every rank.
    """
    path, fresh = Path(path), Path(f"{path}.new")
    counts = comm.allgather(len(arrays["id"]))
    first, total = sum(counts[: comm.rank]), sum(counts)
    rows = {f"{GROUP}/{name}": part for name, part in arrays.items()}
    shapes = {name: (total, *part.shape[1:]) for name, part in rows.items()}
    sums = wrapped_sums(comm, [checksum(part, first) for part in arrays.values()])
    header = header | {
        "format": FORMAT,
        "psph": __version__,
        "sources": SOURCES,
        "particles": total,
        "checksums": dict(zip(arrays, sums)),
    }
    try:
        with together(comm, path):
            if comm.rank == 0:
                room = _lay_out(fresh, shapes, rows, header, frames)
        with together(comm, path):
            hdf5.fill(fresh, comm, rows, counts)
        with together(comm, path):
            hdf5.sync(fresh)  # on every rank: each may stand on a machine of its own
        with together(comm, path):
            if comm.rank == 0:
                _seal(fresh, room, header)
                os.replace(fresh, path)
                hdf5.sync(path.parent)
                for old in checkpoints(path.parent)[KEPT:]:
                    old.unlink()
    finally:
        if comm.rank == 0:
            fresh.unlink(missing_ok=True)


def _lay_out(path: Path, shapes: dict, rows: dict, header: dict, frames: bytes) -> int:
    """A file with empty datasets; returns the bytes before that of HDF5: a power of two."""
    wanted = _LONGEST_LINE + len(json.dumps(header)) + _ROOM
    room = 1 << max(9, (wanted - 1).bit_length())
    path.unlink(missing_ok=True)
    path.touch()
    hdf5.reserve(path, room + hdf5.MARGIN + len(frames) + hdf5.size_of(shapes, rows))
    with hdf5.open_file(path, "w", userblock_size=room, libver="v110") as file:
        hdf5.create_datasets(file.id, shapes, rows)
        file[FRAMES] = np.frombuffer(frames, np.uint8)
    return room


def _seal(path: Path, room: int, header: dict) -> None:
    """Write the header at the front of the filled file, and flush the file to the disk."""
    with hdf5.open_file(path, "r") as file:
        datasets = file[GROUP]
        places = {name: hdf5.place_of(dataset) for name, dataset in datasets.items()}
    with open(path, "r+b") as file:
        size = os.fstat(file.fileno()).st_size
        header = header | {"size": size, "room": room, "places": places}
        text = json.dumps(header | {"frame": _frame_digest(file, room, size, places)}).encode()
        line = b"psph checkpoint %d %s\n" % (len(text), hashlib.sha256(text).hexdigest().encode())
        if len(line) + len(text) > room:
            raise OSError(f"its header takes {len(text):,} bytes, more than was reserved")
        file.seek(0)
        file.write(line + text)
        file.flush()
        os.fsync(file.fileno())


def _frame_digest(file, room: int, size: int, places: dict[str, list[int]]) -> str:
    """SHA-256 of all between the header and the end that is no row of a dataset."""
    digest, reached = hashlib.sha256(), room
    for offset, length in [*sorted(places.values()), [size, 0]]:
        file.seek(reached)
        digest.update(file.read(max(offset - reached, 0)))
        reached = offset + length
    return digest.hexdigest()


def of_other_sources(folder: Path) -> bool:
    """Whether the newest checkpoint in a folder was written by other sources than these; False where there is
    none to be read."""
    for path in checkpoints(folder)[:1]:
        with suppress(OSError, ValueError), open(path, "rb") as file:
            return Saved._foreign(_read_header(file))
    return False


class Saved:
    """A checkpoint that was found whole; ``header`` is the same on every rank.

    Opening it is collective, and raises CheckpointError on every rank: ``case`` is the digest of
    the case that wants to go on from it.
    """

    def __init__(self, path: Path, comm, case: str):
        self.path, self.comm = Path(path), comm
        header, trouble = comm.bcast(self._examine(case) if comm.rank == 0 else None)
        if trouble:
            raise CheckpointError(trouble)
        self.header: dict[str, Any] = header
        self._check_rows()

    @property
    def state(self) -> dict[str, Any]:
        """The state of the simulation besides its particles."""
        return self.header["state"]

    @property
    def foreign(self) -> bool:
        """Whether other sources of psph wrote it."""
        return self._foreign(self.header)

    @staticmethod
    def _foreign(header: dict[str, Any]) -> bool:
        return header.get("sources") != SOURCES

    def frames(self) -> bytes:
        """The structure that restores the frames' file, on rank 0; collective."""

        def read() -> bytes:
            with hdf5.open_file(self.path, "r") as file:
                return file[FRAMES][:].tobytes()

        return self._agreed(lambda: read() if self.comm.rank == 0 else b"")

    def share(self, *names: str) -> list[np.ndarray]:
        """Rows of these datasets: about as many for each rank, in the order of the file."""
        first, last = self._share()
        return self._agreed(lambda: [self._rows(name, first, last) for name in names])

    def fill(self, store) -> None:
        """Give the owned particles of ``store`` all their fields; collective.

        They stand in the order of the file, rank after rank: that of the lists when it was
        written.
        """
        first = sum(self.comm.allgather(store.owned)[: self.comm.rank])
        last = first + store.owned

        def read() -> None:
            if not np.array_equal(self._rows("id", first, last), store.id[store.inner]):
                raise OSError("its particles are in another order than here")
            for name, rows in store.rows.items():
                store.data[rows.start : rows.stop, store.inner] = self._rows(name, first, last).T

        self._agreed(read)

    def _examine(self, case: str) -> tuple[dict[str, Any], str]:
        """The header, and the error in it or in the structure of the file; on rank 0."""
        try:
            with open(self.path, "rb") as file:
                header = _read_header(file)
                return header, next(self._objections(file, header, case), "")
        except FileNotFoundError:
            return {}, f"{self.path}: there is no such file"
        except (OSError, ValueError, KeyError, TypeError) as error:
            return {}, self._damaged(error)

    def _objections(self, file, header: dict[str, Any], case: str) -> Iterator[str]:
        if (header["format"], header["psph"]) != (FORMAT, __version__):
            yield (
                f"{self.path}: written by psph {header['psph']} (format {header['format']}), this "
                f"is psph {__version__} (format {FORMAT}): resume with the psph that wrote it"
            )
        copy = self.path.with_name(COPY)
        if header["case"] != case and self._foreign(header):
            yield (
                f"{self.path}: other sources of psph wrote it, for which {copy} has other defaults than for "
                "these, or that file is not as the run wrote it: resume with those sources, or start it again"
            )
        elif header["case"] != case:
            yield (
                f"{self.path}: belongs to another case than {copy}: put that file back as the run wrote it"
            )
        size = os.fstat(file.fileno()).st_size
        if size != header["size"]:
            yield self._damaged(f"{size:,} bytes instead of {header['size']:,}")
        if _frame_digest(file, header["room"], size, header["places"]) != header["frame"]:
            yield self._damaged("what lies between the datasets does not match its checksum")

    def _check_rows(self) -> None:
        first, last = self._share()
        expected = self.header["checksums"]
        checksums = self._agreed(lambda: [checksum(self._rows(n, first, last), first) for n in expected])
        for name, computed in zip(expected, wrapped_sums(self.comm, checksums)):
            if computed != expected[name]:
                raise CheckpointError(self._damaged(f"the dataset {name} does not match its checksum"))

    def _share(self) -> tuple[int, int]:
        total, comm = self.header["particles"], self.comm
        return total * comm.rank // comm.size, total * (comm.rank + 1) // comm.size

    def _rows(self, name: str, first: int, last: int) -> np.ndarray:
        with hdf5.open_file(self.path, "r") as file:
            return file[GROUP][name][first:last]

    def _agreed(self, read):
        """The result of ``read``; CheckpointError on every rank if it failed on any."""
        result = trouble = None
        try:
            result = read()
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            trouble = self._damaged(error)
        for text in filter(None, self.comm.allgather(trouble)):
            raise CheckpointError(text)
        return result

    def _damaged(self, why: Exception | str) -> str:
        return f"{self.path}: damaged: {why if isinstance(why, str) else cause(why)}"


def _read_header(file) -> dict[str, Any]:
    """The header at the front of an open file; raises ValueError where it is not as written."""
    line = _FIRST_LINE.match(file.read(_LONGEST_LINE))
    if line is None:
        raise ValueError("it does not start with the header of a checkpoint")
    file.seek(line.end())
    text = file.read(int(line[1]))
    if hashlib.sha256(text).hexdigest().encode() != line[2]:
        raise ValueError("its header does not match its checksum")
    return json.loads(text)


def checksum(part: np.ndarray, first: int) -> int:
    """The sum over rows ``(n,)`` or ``(n, k)`` of which row ``first`` of all is the first."""
    total, width = 0, part[:1].size
    for start in range(0, len(part), hdf5.CHUNK):
        piece = np.ascontiguousarray(part[start : start + hdf5.CHUNK]).reshape(-1)
        words = piece.view(np.uint64) if piece.itemsize == 8 else piece.astype(np.uint64)
        words.flags.writeable = False  # one type for all, so that it is compiled once
        total += int(_sum_of_mixed(words, np.uint64((first + start) * width)))
    return total % 2**64


@compiled
def _sum_of_mixed(words, place):
    """The sum of mix(word ⊕ mix(place)), ``place`` that of the first word."""
    total = np.uint64(0)
    for k in range(np.uint64(len(words))):
        total += _mix(words[k] ^ _mix(place + k))
    return total


@compiled
def _mix(z):
    """A bijection of 64 bits that spreads each over all (Steele, Lea & Flood 2014)."""
    z = z + np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))
