"""Rows of all ranks in one HDF5 file: laid out by rank 0, filled by all at once.

The space on the disk is taken beforehand, since no good comes of a full disk later: HDF5 crashes,
hangs where several ranks have the file open, and Open MPI 4.1 loses the error of a collective write
on three ranks and more.
"""

import ctypes
import errno
import math
import os
from pathlib import Path

import numpy as np

CHUNK = 1 << 16
"""Rows that are copied at once where a rank writes alone, or travel to rank 0 when it writes for all."""

AT_ONCE = 1 << 24
"""Bytes of all rows up to which rank 0 takes them from all ranks at once and writes them alone: where
all write so little together they wait for each other rather than for the disk."""

MARGIN = 1 << 16
"""Bytes for the structure of what is laid out: headers, names, attributes."""


def parallel_hdf5() -> bool:
    """Whether h5py was built with MPI."""
    import h5py  # late: it starts MPI, which the verbs that simulate nothing do without

    return h5py.get_config().mpi


def open_file(path: Path, mode: str, **how):
    """The file, unlocked: a viewer that has it open must not stop the run."""
    import h5py

    return h5py.File(path, mode, **({} if "driver" in how else {"locking": False}), **how)


def reserve(path: Path, size: int) -> None:
    """Take ``size`` more bytes of the disk, or raise OSError and leave the file as it was.

    HDF5 gives back what it does not use when it closes the file.  Where the file system cannot
    allocate, it is only asked whether so much is free.
    """
    with open(path, "r+b") as file:
        end = file.seek(0, os.SEEK_END)
        failure = _allocate(file.fileno(), end, size)
        if failure in (errno.EOPNOTSUPP, errno.ENOSYS):
            disk = os.fstatvfs(file.fileno())
            failure = errno.ENOSPC if disk.f_bavail * disk.f_frsize < size else 0
        if failure:
            file.truncate(end)
            raise OSError(failure, os.strerror(failure))


def _allocate(number: int, offset: int, size: int) -> int:
    """Linux's fallocate on an open file; returns the number of its error, 0 for none.

    ``os.posix_fallocate`` will not do: where the file system cannot allocate, glibc writes to every
    block in its place, gigabytes for a large frame.
    """
    call = getattr(ctypes.CDLL(None, use_errno=True), "fallocate", None)
    if call is None:
        return errno.ENOSYS
    call.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_int64, ctypes.c_int64]
    while call(number, 0, offset, size) != 0:
        if ctypes.get_errno() != errno.EINTR:  # a signal: psph remembers it, and tries again
            return ctypes.get_errno()
    return 0


def sync(path: Path) -> None:
    """Flush a file, or a folder, to the disk."""
    number = os.open(path, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def size_of(shapes: dict[str, tuple], rows: dict[str, np.ndarray]) -> int:
    """Bytes of the datasets: ``shapes`` over all ranks, types as in ``rows``."""
    return sum(math.prod(shape) * rows[name].itemsize for name, shape in shapes.items())


def create_datasets(file, shapes: dict[str, tuple], rows: dict[str, np.ndarray]) -> list[tuple[int, int]]:
    """Datasets of these ``shapes``, contiguous, with the types of ``rows``; rank 0 alone.

    Returns where their numbers will lie.
    """
    import h5py

    # Space is taken now, so that filling changes nothing of the structure of the file.
    taken = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    taken.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    taken.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    return [
        place_of(file.create_dataset(name, shape, rows[name].dtype, dcpl=taken))
        for name, shape in shapes.items()
    ]


def place_of(dataset) -> tuple[int, int]:
    """First byte and number of bytes of a contiguous dataset in its file."""
    return dataset.id.get_offset() or 0, dataset.id.get_storage_size()


def fill(path: Path, comm, rows: dict[str, np.ndarray], counts: list[int]) -> None:
    """Write the ``rows`` of this rank, by dataset, behind those of the ranks before it; collective.

    ``counts`` are the rows of each rank.  Arrays may be views of any layout: one at a time is
    copied, or a piece of it, to spare memory.
    """
    if comm.size == 1:
        with open_file(path, "r+") as file:
            for name, part in rows.items():
                for start in range(0, len(part), CHUNK):
                    file[name][start : start + CHUNK] = part[start : start + CHUNK]
    elif sum(counts) * _bytes_per_row(rows) <= AT_ONCE:
        _fill_at_once(path, comm, rows)
    elif parallel_hdf5():
        with open_file(path, "r+", driver="mpio", comm=comm) as file:
            fill_collectively(file, rows, sum(counts[: comm.rank]))
    elif comm.rank == 0:
        _fill_for_all(path, comm, rows, counts)
    else:
        for part in rows.values():
            for start in range(0, len(part), CHUNK):
                comm.Send(np.ascontiguousarray(part[start : start + CHUNK]), dest=0)


def _bytes_per_row(rows: dict[str, np.ndarray]) -> int:
    """The same on every rank, whether it has a row or none."""
    return sum(math.prod(part.shape[1:]) * part.itemsize for part in rows.values())


def _fill_at_once(path: Path, comm, rows: dict[str, np.ndarray]) -> None:
    """Rank 0 gathers the rows of all ranks in one message each, and writes them."""
    shares = comm.gather([np.ascontiguousarray(part) for part in rows.values()])
    if comm.rank == 0:
        with open_file(path, "r+") as file:
            for name, parts in zip(rows, zip(*shares, strict=True), strict=True):
                file[name][...] = np.concatenate(parts)


def fill_collectively(file, rows: dict[str, np.ndarray], first: int) -> None:
    """Each rank writes its rows; one that fails continues with the others to the end."""
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
        with open_file(path, "r+") as file:
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
