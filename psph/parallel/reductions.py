"""Numbers over all ranks that do not depend on how particles are spread over them."""

import math

import numpy as np
from mpi4py import MPI

CHUNK = 1 << 16
"""Terms that are rounded at once: what that takes of memory does not grow with the particles."""

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
    maxima = np.array(values, dtype=np.float64)
    comm.Allreduce(MPI.IN_PLACE, maxima, MPI.MAX)
    return maxima


def exact_sums(comm: MPI.Comm, terms: np.ndarray) -> np.ndarray:
    """Sums of the columns of ``terms`` (n, k) over all ranks, the same bits in any order.

    Each term is rounded once to a multiple of a common unit, 2^-62 of the largest term times the
    number of terms, and integers are added.  The error is at most n/2 units; NaN or infinity in a
    column makes its sum NaN.  Collective.
    """
    columns = np.ascontiguousarray(np.atleast_2d(terms).T)
    extremes = np.zeros(len(columns))
    if columns.size:
        with np.errstate(invalid="ignore"):
            np.maximum(columns.max(axis=1), -columns.min(axis=1), out=extremes)
    extremes[np.isnan(extremes)] = np.inf  # a maximum over ranks may lose a NaN, but no infinity
    count = np.array(columns.shape[1], dtype=np.int64)
    peaks = largest(comm, extremes).tolist()
    comm.Allreduce(MPI.IN_PLACE, count, MPI.SUM)
    # Whole numbers add up to the same bits in any order where the sum fits: a bit for each doubling of terms.
    room = BITS - max(int(count), 1).bit_length()
    scales = [room - math.frexp(peak)[1] if math.isfinite(peak) else 0 for peak in peaks]
    total = np.zeros(len(columns), np.int64)
    _add_whole(columns, peaks, scales, total)
    comm.Allreduce(MPI.IN_PLACE, total, MPI.SUM)
    return np.array(
        [
            math.ldexp(whole, -scale) if math.isfinite(peak) else math.nan
            for whole, scale, peak in zip(total.tolist(), scales, peaks)
        ]
    )


def _add_whole(columns: np.ndarray, peaks: list[float], scales: list[int], total: np.ndarray) -> None:
    """Add to ``total`` the terms of each column whose peak is finite, in units of 2^-scale."""
    finite = [math.isfinite(peak) for peak in peaks]
    if not all(finite):
        columns = np.where(np.array(finite)[:, None], columns, 0.0)
    wide = max(CHUNK // max(len(columns), 1), 1)
    # Powers of two: a product is exact but below 2^-1022, and what is left there is rounded to zero anyway.
    factors = [np.array([math.ldexp(1.0, part) for part in half])[:, None] for half in _halves(scales)]
    for first in range(0, columns.shape[1], wide):
        part = columns[:, first : first + wide] * factors[0]
        part *= factors[1]
        total += np.rint(part, out=part).astype(np.int64).sum(axis=1)


def _halves(scales: list[int]) -> tuple[list[int], list[int]]:
    """Two powers whose product is 2^scale: one alone may be larger than any number."""
    return [scale // 2 for scale in scales], [scale - scale // 2 for scale in scales]


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
