"""Numbers over all ranks that do not depend on how particles are spread over them."""

import math
from collections.abc import Sequence
from itertools import accumulate
from typing import NamedTuple

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
    return _over_ranks(comm, np.array(values, dtype=np.float64), MPI.MAX)


def _over_ranks(comm: MPI.Comm, values: np.ndarray, operation: MPI.Op) -> np.ndarray:
    """The ``values`` of all ranks put together, in their place; one rank has them already."""
    if comm.size > 1:
        comm.Allreduce(MPI.IN_PLACE, values, operation)
    return values


class Contribution(NamedTuple):
    """What a rank adds to numbers of all ranks: ``terms`` (n, k), whose columns are summed, and ``tops``
    (m,), of each of which the largest counts."""

    terms: np.ndarray = np.zeros((0, 0))
    tops: Sequence[float] = ()


class Total(NamedTuple):
    """The numbers of all ranks: ``sums`` (k,), and the largest ``tops`` (m,)."""

    sums: np.ndarray
    tops: np.ndarray


def totals(comm: MPI.Comm, shares: Sequence[Contribution]) -> list[Total]:
    """What the ``shares`` of all ranks come to, in three messages however many there are; collective.

    A sum has the same bits in any order: each term is rounded once to a multiple of a common unit, 2^-62 of
    the largest term times the number of terms of its share, and integers are added.  The error is at most n/2
    units; NaN or infinity in a column makes its sum NaN.
    """
    columns = [np.ascontiguousarray(np.atleast_2d(terms).T) for terms, _ in shares]
    ends = list(accumulate(map(len, columns), initial=0))
    places = list(map(slice, ends, ends[1:]))
    extremes = [most for part in columns for most in _extremes(part)]
    tops = [top for _, each in shares for top in each]
    maxima = largest(comm, [*extremes, *tops])
    counts = _over_ranks(comm, np.array([part.shape[1] for part in columns], np.int64), MPI.SUM)
    peaks, scales = maxima[: ends[-1]].tolist(), []
    for place, count in zip(places, counts.tolist()):
        # Whole numbers add up to the same bits in any order where the sum fits: a bit for each doubling.
        room = BITS - max(count, 1).bit_length()
        scales += [room - math.frexp(peak)[1] if math.isfinite(peak) else 0 for peak in peaks[place]]
    whole = np.zeros(ends[-1], np.int64)
    for part, place in zip(columns, places):
        if part.size:
            _add_whole(part, peaks[place], scales[place], whole[place])
    numbers = zip(_over_ranks(comm, whole, MPI.SUM).tolist(), scales, peaks)
    sums = np.array(
        [math.ldexp(n, -scale) if math.isfinite(peak) else math.nan for n, scale, peak in numbers]
    )
    last = accumulate((len(each) for _, each in shares), initial=ends[-1])
    return [
        Total(sums[place], maxima[first : first + len(each)])
        for place, first, (_, each) in zip(places, last, shares)
    ]


def exact_sums(comm: MPI.Comm, terms: np.ndarray) -> np.ndarray:
    """Sums of the columns of ``terms`` (n, k) over all ranks, the same bits in any order, as :func:`totals`
    takes them; collective."""
    return totals(comm, [Contribution(terms)])[0].sums


def _extremes(columns: np.ndarray) -> list[float]:
    """The largest size of a term of each column, infinite where one is no number."""
    if not columns.size:
        return [0.0] * len(columns)
    # A maximum over ranks may lose a NaN, but no infinity.
    return [most if most == most else math.inf for most in np.abs(columns).max(axis=1).tolist()]


def _add_whole(columns: np.ndarray, peaks: list[float], scales: list[int], total: np.ndarray) -> None:
    """Add to ``total`` the terms of each column whose peak is finite, in units of 2^-scale."""
    if not all(map(math.isfinite, peaks)):
        columns = np.where(np.isfinite(peaks)[:, None], columns, 0.0)
    wide = max(CHUNK // max(len(columns), 1), 1)
    # Powers of two: a product is exact but below 2^-1022, and what is left there is rounded to zero anyway.
    factors = [np.array([math.ldexp(1.0, power) for power in powers])[:, None] for powers in _powers(scales)]
    for first in range(0, columns.shape[1], wide):
        part = columns[:, first : first + wide] * factors[0]
        for factor in factors[1:]:
            part *= factor
        total += np.rint(part, out=part).astype(np.int64).sum(axis=1)


def _powers(scales: list[int]) -> list[list[int]]:
    """Powers of two that are numbers, whose product is 2^scale: one alone may be larger than any number."""
    if max(map(abs, scales)) < 1000:
        return [scales]
    return [[scale // 2 for scale in scales], [scale - scale // 2 for scale in scales]]


def whole_sums(comm: MPI.Comm, values: np.ndarray) -> np.ndarray:
    """Sums of arrays of whole numbers, int64, over all ranks; collective."""
    return _over_ranks(comm, np.array(values, dtype=np.int64), MPI.SUM)


def wrapped_sums(comm: MPI.Comm, values) -> list[int]:
    """Sums of whole numbers below 2⁶⁴ over all ranks, modulo 2⁶⁴; collective."""
    return _over_ranks(comm, np.array(values, dtype=np.uint64), MPI.SUM).tolist()


def all_rows(comm: MPI.Comm, rows: np.ndarray) -> np.ndarray:
    """The ``rows`` (n, k) of all ranks, one rank after the other; collective."""
    return np.concatenate(comm.allgather(rows)) if comm.size > 1 else rows
