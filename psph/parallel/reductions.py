"""Numbers over all ranks that do not depend on how particles are spread over them."""

import math
from collections.abc import Sequence

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
    return exact_sums_of(comm, [terms])[0]


def exact_sums_of(comm: MPI.Comm, parts: Sequence[np.ndarray]) -> list[np.ndarray]:
    """:func:`exact_sums` of each of several ``parts`` (n, k), in the messages of one; collective."""
    columns = [np.ascontiguousarray(np.atleast_2d(terms).T) for terms in parts]
    ends = np.cumsum([len(part) for part in columns]).tolist()
    places = [slice(end - len(part), end) for part, end in zip(columns, ends)]
    extremes = np.zeros(ends[-1])
    with np.errstate(invalid="ignore"):
        for part, place in zip(columns, places):
            if part.size:
                np.maximum(part.max(axis=1), -part.min(axis=1), out=extremes[place])
    extremes[np.isnan(extremes)] = np.inf  # a maximum over ranks may lose a NaN, but no infinity
    counts = np.array([part.shape[1] for part in columns], dtype=np.int64)
    peaks = largest(comm, extremes).tolist()
    comm.Allreduce(MPI.IN_PLACE, counts, MPI.SUM)
    # Whole numbers add up to the same bits in any order where the sum fits: a bit for each doubling of terms.
    rooms = [BITS - max(count, 1).bit_length() for count in counts.tolist()]
    scales = [
        room - math.frexp(peak)[1] if math.isfinite(peak) else 0
        for room, place in zip(rooms, places)
        for peak in peaks[place]
    ]
    total = np.zeros(ends[-1], np.int64)
    for part, place in zip(columns, places):
        _add_whole(part, peaks[place], scales[place], total[place])
    comm.Allreduce(MPI.IN_PLACE, total, MPI.SUM)
    sums = np.array(
        [
            math.ldexp(whole, -scale) if math.isfinite(peak) else math.nan
            for whole, scale, peak in zip(total.tolist(), scales, peaks)
        ]
    )
    return [sums[place] for place in places]


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
