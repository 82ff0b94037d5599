"""Numbers over all ranks that do not depend on how particles are spread over them."""

import math

import numpy as np
from mpi4py import MPI

CHUNK = 1 << 16
"""Rows that are rounded at once: what that takes of memory does not grow with the particles."""

BITS = 62
"""Bits of a signed 64-bit integer that a sum may fill."""


def alone() -> MPI.Comm:
    """The communicator of this rank alone, for what it does without the others."""
    return MPI.COMM_SELF


def world() -> MPI.Comm:
    """The communicator of all ranks that mpirun started; of one where there was none."""
    return MPI.COMM_WORLD


def largest(comm: MPI.Comm, values) -> np.ndarray:
    """The largest of each value over all ranks; collective."""
    found = np.array(values, dtype=np.float64)
    comm.Allreduce(MPI.IN_PLACE, found, MPI.MAX)
    return found


def exact_sums(comm: MPI.Comm, terms: np.ndarray) -> np.ndarray:
    """Sums of the columns of ``terms`` (n, k) over all ranks, the same bits in any order.

    Each term is rounded once to a multiple of a common unit, 2^-62 of the largest term times the
    number of terms, and integers are added.  The error is at most n/2 units; NaN or infinity in a
    column makes its sum NaN.  Collective.
    """
    terms = np.atleast_2d(terms)
    extremes = np.zeros(terms.shape[1])
    if len(terms):
        with np.errstate(invalid="ignore"):
            extremes[:] = np.maximum(terms.max(axis=0), -terms.min(axis=0))
    extremes[np.isnan(extremes)] = np.inf
    count = np.array(len(terms), dtype=np.int64)
    peaks = largest(comm, extremes)
    comm.Allreduce(MPI.IN_PLACE, count, MPI.SUM)
    finite = np.isfinite(peaks)
    room = BITS - max(int(count), 1).bit_length()
    exponents = np.array([math.frexp(x)[1] if x > 0 and ok else 0 for x, ok in zip(peaks, finite)])
    total = np.zeros(terms.shape[1], np.int64)
    for first in range(0, len(terms), CHUNK):
        part = np.where(finite, terms[first : first + CHUNK], 0.0)
        total += np.rint(np.ldexp(part, room - exponents)).astype(np.int64).sum(axis=0)
    comm.Allreduce(MPI.IN_PLACE, total, MPI.SUM)
    sums = np.array([math.ldexp(int(t), int(e) - room) for t, e in zip(total, exponents)])
    return np.where(finite, sums, np.nan)


def whole_sums(comm: MPI.Comm, values: np.ndarray) -> np.ndarray:
    """Sums of arrays of whole numbers, int64, over all ranks; collective."""
    total = np.array(values, dtype=np.int64)
    comm.Allreduce(MPI.IN_PLACE, total, MPI.SUM)
    return total


def wrapped_sums(comm: MPI.Comm, values) -> list[int]:
    """Sums of whole numbers below 2⁶⁴ over all ranks, modulo 2⁶⁴; collective."""
    total = np.array(values, dtype=np.uint64)
    comm.Allreduce(MPI.IN_PLACE, total, MPI.SUM)
    return total.tolist()
