"""What HDF5 keeps in a file beside the raw numbers, copied out and put back to the bit.

HDF5 changes it in place (the superblock, the tree of a group) whenever a dataset is added, so a
process that is killed meanwhile may leave a file that does not open, or not to the end.  Raw
numbers stay where they are once they are written.  So all that is no number, some 8 kB a frame and
250 bytes when it is deflated, and the length of the file bring it back from whatever state.

A copy is a deflated stream of 64-bit integers, length and number of pieces, then offset and bytes
of each piece, and of the pieces themselves.
"""

import os
import zlib
from collections.abc import Iterable
from itertools import accumulate
from pathlib import Path

import numpy as np

Place = tuple[int, int]
"""First byte and number of bytes."""


def copied(path: Path, numbers: Iterable[Place]) -> bytes:
    """All of a closed file but the places of its ``numbers``; raises OSError."""
    packer, parts = zlib.compressobj(), []
    with open(path, "rb") as file:
        length = os.fstat(file.fileno()).st_size
        pieces = _between(numbers, length)
        head = np.array([length, len(pieces), *np.ravel(pieces)], np.int64)
        parts.append(packer.compress(head.tobytes()))
        for first, size in pieces:
            file.seek(first)
            parts.append(packer.compress(file.read(size)))
    return b"".join([*parts, packer.flush()])


def put_back(path: Path, copy: bytes) -> None:
    """Make a file what it was when the ``copy`` was made, whatever has been added since.

    On the disk when this returns; raises OSError where numbers of then are missing.
    """
    plain = zlib.decompress(copy)
    length, count = np.frombuffer(plain, np.int64, 2).tolist()
    pieces = np.frombuffer(plain, np.int64, 2 * count, 16).reshape(-1, 2).tolist()
    needed = length
    if pieces and sum(pieces[-1]) == length:
        needed = pieces[-1][0]
    with open(path, "r+b") as file:
        if os.fstat(file.fileno()).st_size < needed:
            raise OSError(f"frames are missing, it had {length:,} bytes at the checkpoint")
        starts = accumulate((size for _, size in pieces), initial=16 + 16 * count)
        for (first, size), start in zip(pieces, starts):
            file.seek(first)
            file.write(plain[start : start + size])
        file.truncate(length)
        file.flush()
        os.fsync(file.fileno())


def _between(numbers: Iterable[Place], length: int) -> list[Place]:
    """What lies before, between and behind these places."""
    pieces, reached = [], 0
    for first, size in [*sorted(numbers), (length, 0)]:
        if first > reached:
            pieces.append((reached, first - reached))
        reached = max(reached, first + size)
    return pieces
