"""All frames of a run in one HDF5 file, written by all ranks at once.

Rank 0 alone lays a frame out (names, shapes, attributes: about a millisecond), all ranks fill it
together, rank 0 puts the time on it.  So a frame with a time is whole, and a run that is killed
leaves a file that opens.  The space on the disk is taken beforehand, since no good comes of a full
disk later: HDF5 crashes, hangs where several ranks have the file open, and Open MPI 4.1 loses the
error of a collective write on three ranks and more.
"""

import math
import os
from pathlib import Path

import numpy as np

from psph.output.errors import together
from psph.output.xdmf import XdmfIndex
from psph.particles.fields import FIELDS

CHUNK = 1 << 16
"""Rows that travel at once to rank 0 when it writes for all."""

MARGIN = 1 << 16
"""Bytes for the structure of a frame: headers, names, attributes."""

_HELPERS = {
    "points": ("m", "place in space: what XDMF needs of a 1D scene"),
    "connectivity": ("1", "row of each particle: what XDMF needs"),
}


def funnel_notice(comm) -> str | None:
    """The line to say at the start if the frames of all ranks have to pass through rank 0."""
    if comm.size == 1 or _parallel_hdf5():
        return None
    return (
        f"output: h5py is built without MPI: rank 0 writes the frames of all {comm.size} ranks, "
        "in pieces; a parallel h5py writes them faster"
    )


class FrameFile:
    """The frames of a run: ``/frames/00000/position`` and so on, one row a particle.

    Created anew here, open only while a frame is written: it can be read during the run.
    ``attributes`` (numbers and text, such as the case) go to the root of the file.
    All methods are collective over ``comm`` and raise OutputError on every rank.
    """

    def __init__(self, path: Path, comm, attributes: dict):
        self.path, self.comm = Path(path), comm
        self._index = XdmfIndex(self.path)
        self._connected: set[int] = set()
        with together(comm, self.path):
            if comm.rank == 0:
                self._create(attributes)

    def write(self, index: int, time: float, step: int, arrays: dict[str, np.ndarray]) -> None:
        """Append a frame: the rows of the ranks one after another, in the order of the ranks.

        ``arrays`` holds the rows of this rank: ``(n,)`` or ``(n, dim)``, ``position`` among them.
        They may be views of any layout: one at a time is copied, to spare memory.
        """
        frame = f"frames/{index:05d}"
        counts = self.comm.allgather(len(arrays["position"]))
        first, total = sum(counts[: self.comm.rank]), sum(counts)
        rows = self._rows(frame, arrays, first, total)
        shapes = {name: (total, *part.shape[1:]) for name, part in rows.items()}
        with together(self.comm, self.path):
            if self.comm.rank == 0:
                self._lay_out(frame, step, shapes, rows)
        with together(self.comm, self.path):
            self._fill(rows, first, counts)
        with together(self.comm, self.path):
            if self.comm.rank == 0:
                with _open(self.path, "r+") as file:
                    file[frame].attrs.modify("time", float(time))
                kinds = {name: (shapes[name], part.dtype) for name, part in rows.items()}
                self._index.add(frame, time, kinds)

    def _rows(self, frame: str, arrays: dict, first: int, total: int) -> dict[str, np.ndarray]:
        """What this rank writes, by the name in the file; the same names on every rank."""
        count, dimensions = arrays["position"].shape
        rows = {f"{frame}/{name}": part for name, part in arrays.items()}
        short = [name for name, part in arrays.items() if len(part) != count]
        if short:
            raise ValueError(f"{self.path}: {', '.join(short)}: not {count} rows as position")
        if dimensions == 1:
            rows[f"{frame}/points"] = np.pad(arrays["position"], ((0, 0), (0, 2)))
        if total not in self._connected:
            rows[f"connectivity/{total}"] = np.arange(first, first + count)
            self._connected.add(total)
        return rows

    def _create(self, attributes: dict) -> None:
        self._index.path.unlink(missing_ok=True)
        # A new file takes the place of an old one, which may be open in a viewer: leave it that.
        fresh = self.path.with_name(self.path.name + ".new")
        fresh.touch()
        _reserve(fresh, MARGIN + len(str(attributes)))
        with _open(fresh, "w") as file:
            file.attrs.update(attributes)
            file.create_group("frames")
        os.replace(fresh, self.path)

    def _lay_out(self, frame: str, step: int, shapes: dict, rows: dict) -> None:
        import h5py

        sizes = (math.prod(shape) * rows[name].itemsize for name, shape in shapes.items())
        _reserve(self.path, MARGIN + sum(sizes))
        # Space is taken now, so that filling changes nothing of the structure of the file.
        taken = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        taken.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        taken.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
        with _open(self.path, "r+") as file:
            for name, shape in shapes.items():
                dataset = file.create_dataset(name, shape, rows[name].dtype, dcpl=taken)
                unit, meaning = _describe(name)
                dataset.attrs.update(unit=unit, meaning=meaning)
            file[frame].attrs.update(time=math.nan, step=step)  # no time yet: not whole

    def _fill(self, rows: dict, first: int, counts: list[int]) -> None:
        if self.comm.size == 1:
            with _open(self.path, "r+") as file:
                for name, part in rows.items():
                    file[name][...] = part
        elif _parallel_hdf5():
            with _open(self.path, "r+", driver="mpio", comm=self.comm) as file:
                _fill_collectively(file, rows, first)
        elif self.comm.rank == 0:
            _fill_for_all(self.path, self.comm, rows, counts)
        else:
            for part in rows.values():
                for start in range(0, len(part), CHUNK):
                    self.comm.Send(np.ascontiguousarray(part[start : start + CHUNK]), dest=0)


def _fill_collectively(file, rows: dict[str, np.ndarray], first: int) -> None:
    """Each rank writes its rows; one that fails goes on with the others to the end."""
    import h5py

    transfer = h5py.h5p.create(h5py.h5p.DATASET_XFER)
    transfer.set_dxpl_mpio(h5py.h5fd.MPIO_COLLECTIVE)
    failure = None
    datasets = [file[name].id for name in rows]
    for dataset, part in zip(datasets, rows.values(), strict=True):
        space = dataset.get_space()
        # h5py's own slicing skips the call when a rank has no row, and the others wait for ever.
        if len(part):
            space.select_hyperslab((first,) + (0,) * (part.ndim - 1), part.shape)
        else:
            space.select_none()
        memory = h5py.h5s.create_simple(part.shape)
        try:
            dataset.write(memory, space, np.ascontiguousarray(part), dxpl=transfer)
        except OSError as error:
            failure = error
    if failure:
        raise failure


def _fill_for_all(path: Path, comm, rows: dict[str, np.ndarray], counts: list[int]) -> None:
    """Rank 0 writes its own rows and those that arrive, never more than a piece in memory."""
    pieces = _pieces(comm, rows, counts)
    try:
        with _open(path, "r+") as file:
            for name, start, piece in pieces:
                file[name][start : start + len(piece)] = piece
    finally:
        # After a failure too: the other ranks must get rid of what they send.
        for _ in pieces:
            pass


def _pieces(comm, rows: dict[str, np.ndarray], counts: list[int]):
    """Yield (name, first row, rows) of rank 0 and of every other rank in turn."""
    for name, part in rows.items():
        yield name, 0, part
        start = counts[0]
        for source in range(1, comm.size):
            end = start + counts[source]
            while start < end:
                piece = np.empty((min(CHUNK, end - start), *part.shape[1:]), part.dtype)
                comm.Recv(piece, source)
                yield name, start, piece
                start += len(piece)


def _describe(name: str) -> tuple[str, str]:
    """Unit and meaning of what is stored under ``name``."""
    kind, field = name.split("/")[0], name.split("/")[-1]
    if field in FIELDS:
        return FIELDS[field].unit, FIELDS[field].meaning
    return _HELPERS[field if field in _HELPERS else kind]


def _reserve(path: Path, size: int) -> None:
    """Take ``size`` more bytes of the disk, or raise OSError and leave the file as it was.

    HDF5 gives back what it does not use when it closes the file.
    """
    if not hasattr(os, "posix_fallocate"):
        return
    with open(path, "r+b") as file:
        end = file.seek(0, os.SEEK_END)
        try:
            os.posix_fallocate(file.fileno(), end, size)
        except OSError:
            file.truncate(end)
            raise


def _parallel_hdf5() -> bool:
    import h5py

    return h5py.get_config().mpi


def _open(path: Path, mode: str, **how):
    """The file, unlocked: a viewer that has it open must not stop the run."""
    import h5py  # late: it starts MPI, which the verbs that simulate nothing do without

    return h5py.File(path, mode, **({} if how else {"locking": False}), **how)
