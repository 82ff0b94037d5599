"""Rows of all ranks in one HDF5 file: laid out by rank 0, filled by all at once.

The space on the disk is taken beforehand, since no good comes of a full disk later: HDF5 crashes,
hangs where several ranks have the file open, and Open MPI 4.1 loses the error of a collective write
on three ranks and more.
"""

import ctypes
import errno
import math
import os
import resource
from collections.abc import Callable
from contextlib import contextmanager, nullcontext, suppress
from functools import cache
from pathlib import Path

import numpy as np

CHUNK = 1 << 16
"""Rows that are copied at once where a rank writes alone, or travel to rank 0 when it writes for all."""

AT_ONCE = 1 << 24
"""Bytes of all rows up to which rank 0 takes them from all ranks at once and writes them alone: where
all write so little together they wait for each other rather than for the disk."""

MARGIN = 1 << 16
"""Bytes for the structure of what is laid out: headers, names, attributes."""

KEEP_SIZE = 1
"""For Linux's fallocate: the file stays as long as it is (FALLOC_FL_KEEP_SIZE)."""


def parallel_hdf5() -> bool:
    """Whether h5py was built with MPI."""
    import h5py  # late: it starts MPI, which the verbs that simulate nothing do without

    return h5py.get_config().mpi


def open_file(path: Path, mode: str, **how):
    """The file, unlocked: a viewer that has it open must not stop the run."""
    import h5py

    return h5py.File(path, mode, **({} if "driver" in how else {"locking": False}), **how)


@contextmanager
def opened(path: Path):
    """The file, to be changed, as HDF5 itself knows it: h5py's own objects take longer than a small frame.

    Until it is closed only the numbers of datasets reach the disk for sure, the rest by :func:`complete`.
    """
    from h5py import h5f, h5p

    access = h5p.create(h5p.FILE_ACCESS)
    access.set_fclose_degree(h5f.CLOSE_STRONG)  # with all that is open in it
    access.set_file_locking(False, True)
    file = h5f.open(os.fsencode(path), h5f.ACC_RDWR, access)
    try:
        yield file
    except BaseException:
        with suppress(OSError, RuntimeError):  # the first error says more
            file.close()
        raise
    file.close()


def reserve(path: Path, size: int) -> None:
    """Take ``size`` more bytes of the disk, or raise OSError; the file keeps its contents and its length.

    What is not used stays behind its end until it is cut (:func:`give_back`): a file that HDF5 had to
    cut when it closes it would be waited for.  Where the file system cannot allocate, it is only asked
    whether so much is free.
    """
    with open(path, "r+b") as file:
        end = file.seek(0, os.SEEK_END)
        longest = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
        if 0 <= longest < end + size:
            raise OSError(errno.EFBIG, os.strerror(errno.EFBIG))
        failure = _allocate(file.fileno(), end, size)
        if failure in (errno.EOPNOTSUPP, errno.ENOSYS):
            disk = os.fstatvfs(file.fileno())
            failure = errno.ENOSPC if disk.f_bavail * disk.f_frsize < size else 0
        if failure:
            raise OSError(failure, os.strerror(failure))


def give_back(path: Path) -> None:
    """Free what was reserved behind the end of a file."""
    os.truncate(path, os.path.getsize(path))


def _allocate(number: int, offset: int, size: int) -> int:
    """Linux's fallocate on an open file; returns the number of its error, 0 for none.

    ``os.posix_fallocate`` will not do: where the file system cannot allocate, glibc writes to every
    block in its place, gigabytes for a large frame.
    """
    call = _fallocate()
    if call is None:
        return errno.ENOSYS
    while call(number, KEEP_SIZE, offset, size) != 0:
        if ctypes.get_errno() != errno.EINTR:  # a signal: psph remembers it, and tries again
            return ctypes.get_errno()
    return 0


@cache
def _fallocate():
    call = getattr(ctypes.CDLL(None, use_errno=True), "fallocate", None)
    if call is not None:
        call.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_int64, ctypes.c_int64]
    return call


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


def create_datasets(
    file, shapes: dict[str, tuple], rows: dict[str, np.ndarray], texts: Callable[[str], dict] | None = None
) -> list[tuple[int, int]]:
    """Datasets of these ``shapes``, contiguous, with the types of ``rows``; rank 0 alone.

    ``file`` as :func:`opened` gives it; ``texts`` of a name are the attributes of its dataset.  Returns
    where their numbers will lie.
    """
    from h5py import h5d, h5s

    places, groups = [], {}
    for name, shape in shapes.items():
        folder, _, last = name.rpartition("/")
        if folder not in groups:
            groups[folder] = _group(file, folder)
        kind = _kind(rows[name].dtype)
        dataset = h5d.create(groups[folder], last.encode(), kind, h5s.create_simple(shape), _contiguous())
        places.append((dataset.get_offset() or 0, dataset.get_storage_size()))
        if texts:
            _describe(dataset, texts(name))
    return places


@cache
def _contiguous():
    """How a dataset is made whose space is taken at once, so that filling changes nothing of the file's
    structure."""
    from h5py import h5d, h5p

    way = h5p.create(h5p.DATASET_CREATE)
    way.set_alloc_time(h5d.ALLOC_TIME_EARLY)
    way.set_fill_time(h5d.FILL_TIME_NEVER)
    way.set_obj_track_times(False)
    return way


@cache
def _kind(dtype: np.dtype):
    """HDF5's name of a type of numbers or texts."""
    from h5py import h5t

    return h5t.py_create(dtype, logical=True)


def _group(file, name: str):
    """The group ``name`` of an open file, made with all that it stands in where there is none."""
    from h5py import h5g, h5p

    if name.encode() in file:
        return h5g.open(file, name.encode())
    between = h5p.create(h5p.LINK_CREATE)
    between.set_create_intermediate_group(True)
    return h5g.create(file, name.encode(), lcpl=between)


def describe(file, name: str, attributes: dict[str, str | float | int | np.ndarray]) -> None:
    """Give a group of an open file, as :func:`opened` gives it, attributes that it lacks."""
    from h5py import h5o

    _describe(h5o.open(file, name.encode()), attributes)


def _describe(place, attributes: dict[str, str | float | int | np.ndarray]) -> None:
    from h5py import h5a, h5s

    scalar = h5s.create(h5s.SCALAR)
    for key, value in attributes.items():
        content = _text(value) if isinstance(value, str) else np.array(value)
        room = h5s.create_simple(content.shape) if content.ndim else scalar
        h5a.create(place, key.encode(), _kind(content.dtype), room).write(content)


@cache
def _text(value: str) -> np.ndarray:
    import h5py

    return np.array(value, h5py.string_dtype())


def complete(file, name: str, key: str, value: float) -> None:
    """Give an attribute of an open file its last value, behind all else that was changed."""
    from h5py import h5a, h5f, h5o

    h5f.flush(file)
    h5a.open(h5o.open(file, name.encode()), key.encode()).write(np.array(value))


def place_of(dataset) -> tuple[int, int]:
    """First byte and number of bytes of a contiguous dataset in its file."""
    return dataset.id.get_offset() or 0, dataset.id.get_storage_size()


def by_rank_0(comm, rows: dict[str, np.ndarray], counts: list[int]) -> bool:
    """Whether rank 0 writes the rows of all ranks; else each writes its own."""
    return comm.size == 1 or sum(counts) * _bytes_per_row(rows) <= AT_ONCE or not parallel_hdf5()


def fill(path: Path, comm, rows: dict[str, np.ndarray], counts: list[int], file=None) -> None:
    """Write the ``rows`` of this rank, by dataset, behind those of the ranks before it; collective.

    ``counts`` are the rows of each rank.  Arrays may be views of any layout: one at a time is
    copied, or a piece of it, to spare memory.  ``file`` is that at ``path`` where rank 0, which
    writes it alone (:func:`by_rank_0`), has it open.
    """
    if not by_rank_0(comm, rows, counts):
        with open_file(path, "r+", driver="mpio", comm=comm) as shared:
            fill_collectively(shared, rows, sum(counts[: comm.rank]))
        return
    pieces = _of_all(comm, rows, counts)
    try:
        if comm.rank == 0:
            with nullcontext(file) if file else opened(path) as own:
                _write(own, pieces)
    finally:
        # After a failure too: the other ranks must get rid of what they send.
        for _ in pieces:
            pass


def drop(comm, rows: dict[str, np.ndarray], counts: list[int]) -> None:
    """On rank 0, where it writes alone but cannot: what the other ranks send in :func:`fill` goes nowhere."""
    for _ in _of_all(comm, rows, counts):
        pass


def _of_all(comm, rows: dict[str, np.ndarray], counts: list[int]):
    """On rank 0 (name, first row, rows) of all ranks; the others send theirs."""
    whole = sum(counts) * _bytes_per_row(rows) <= AT_ONCE
    return (_at_once if whole else _pieces)(comm, rows, counts)


def _write(file, pieces) -> None:
    """Write what comes, (name, first row, rows) each."""
    from h5py import h5d, h5s

    for name, start, piece in pieces:
        dataset, within = h5d.open(file, name.encode()), h5s.ALL
        if dataset.shape != piece.shape:
            within = dataset.get_space()
            within.select_hyperslab((start, *(0 for _ in piece.shape[1:])), piece.shape)
        memory = h5s.create_simple(piece.shape)
        dataset.write(memory, within, np.ascontiguousarray(piece))


def _bytes_per_row(rows: dict[str, np.ndarray]) -> int:
    """The same on every rank, whether it has a row or none."""
    return sum(math.prod(part.shape[1:]) * part.itemsize for part in rows.values())


def _at_once(comm, rows: dict[str, np.ndarray], counts: list[int]):
    """On rank 0 the rows of all ranks, which come in one message from each: (name, 0, rows)."""
    if comm.size == 1:
        yield from ((name, 0, part) for name, part in rows.items() if len(part))
        return
    width, total = _bytes_per_row(rows), sum(counts)
    sizes = [0, *(count * width for count in counts[1:])]  # rank 0 sends itself nothing
    sent = np.empty(sum(sizes) if comm.rank == 0 else 0, np.uint8)
    comm.Gatherv(_packed(rows, sizes[comm.rank]), (sent, sizes))
    if comm.rank != 0:
        return
    shares = np.split(sent, np.cumsum(sizes)[:-1])
    for name, part in rows.items():
        whole = np.empty((total, *part.shape[1:]), part.dtype)
        whole[: counts[0]] = part
        first, row = counts[0], math.prod(part.shape[1:]) * part.itemsize
        for rank, count in enumerate(counts[1:], 1):
            theirs, shares[rank] = np.split(shares[rank], [count * row])
            whole[first : first + count] = theirs.view(part.dtype).reshape(count, *part.shape[1:])
            first += count
        if total:
            yield name, 0, whole


def _packed(rows: dict[str, np.ndarray], size: int) -> np.ndarray:
    """The rows of all datasets one after another, as ``size`` bytes; 0: none of them."""
    packed, last = np.empty(size, np.uint8), 0
    for part in rows.values() if size else ():
        first, last = last, last + part.nbytes
        packed[first:last].view(part.dtype).reshape(part.shape)[...] = part
    return packed


def _pieces(comm, rows: dict[str, np.ndarray], counts: list[int]):
    """On rank 0 the rows of all ranks in turn, never more than a piece in memory: (name, first row, rows)."""
    for name, part in rows.items():
        if comm.rank == 0:
            yield from ((name, at, part[at : at + CHUNK]) for at in range(0, len(part), CHUNK))
        else:
            for start in range(0, len(part), CHUNK):
                comm.Send(np.ascontiguousarray(part[start : start + CHUNK]), dest=0)
            continue
        start = counts[0]
        for source in range(1, comm.size):
            end = start + counts[source]
            while start < end:
                piece = np.empty((min(CHUNK, end - start), *part.shape[1:]), part.dtype)
                comm.Recv(piece, source)
                yield name, start, piece
                start += len(piece)


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
