"""The square lattice whose sites may hold a particle at the start."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from psph.scene.forms.form import Corner

TOLERANCE = 1e-6
"""In spacings: how far rounding may move a site or an edge."""

SITES_AT_ONCE = 1 << 20
"""Sites that are looked at together: bounds the memory."""


@dataclass(frozen=True)
class Lattice:
    """Sites at origin + (k + 1/2) spacing, ``first`` ≤ k < ``first + counts`` along each axis.

    The order of sites: planes across ``axis`` one after another, within a plane the other axes
    in order, the last one fastest.  Arrays over sites have their axes in this order.
    """

    origin: Corner
    spacing: float
    first: tuple[int, ...]
    counts: tuple[int, ...]
    axis: int

    @property
    def axes(self) -> tuple[int, ...]:
        """Axes from the slowest to the fastest."""
        return (self.axis, *(d for d in range(len(self.counts)) if d != self.axis))

    @property
    def planes(self) -> int:
        """Number of planes across ``axis``."""
        return self.counts[self.axis]

    @property
    def sites_in_plane(self) -> int:
        """Sites of one plane."""
        return math.prod(self.counts[d] for d in self.axes[1:])

    @property
    def lower(self) -> Corner:
        """Half a spacing below the lowest site, m."""
        return tuple(o + k * self.spacing for o, k in zip(self.origin, self.first))

    @property
    def upper(self) -> Corner:
        """Half a spacing above the highest site, m."""
        ends = zip(self.origin, self.first, self.counts)
        return tuple(o + (k + n) * self.spacing for o, k, n in ends)

    def shape(self, first: int, last: int) -> tuple[int, ...]:
        """Shape of an array over the sites of planes ``first`` to ``last - 1``."""
        return (last - first, *(self.counts[d] for d in self.axes[1:]))

    def coordinates(self, d: int) -> np.ndarray:
        """Coordinate of every site along axis ``d``, m."""
        k = self.first[d] + np.arange(self.counts[d])
        return self.origin[d] + (k + 0.5) * self.spacing

    def within_cell(self, finer: int) -> np.ndarray:
        """From a site to the middles of the ``finer`` parts of its cell along each axis (n, dim), m."""
        along = (np.arange(finer) - 0.5 * (finer - 1)) * (self.spacing / finer)
        return np.stack(np.meshgrid(*[along] * len(self.counts), indexing="ij"), axis=-1).reshape(
            -1, len(self.counts)
        )

    def odd(self, position: np.ndarray) -> np.ndarray:
        """Whether the numbers k of the site around each position (n, dim) add up to an odd one."""
        sites = np.floor((position - np.array(self.origin)) / self.spacing).astype(np.int64)
        return sites.sum(axis=1) % 2 == 1

    def grid(self, first: int, last: int) -> list[np.ndarray]:
        """Coordinates x, y, z of the sites of some planes, broadcasting to ``shape``."""
        grid = []
        for d in range(len(self.counts)):
            x = self.coordinates(d)
            x = x[first:last] if d == self.axis else x
            behind = len(self.counts) - 1 - self.axes.index(d)
            grid.append(x.reshape((-1,) + (1,) * behind))
        return grid

    def chunks(self, first: int = 0, last: int | None = None) -> Iterator[tuple[int, int]]:
        """Ranges of planes, in order, of about ``SITES_AT_ONCE`` sites each."""
        last = self.planes if last is None else last
        step = max(1, SITES_AT_ONCE // max(1, self.sites_in_plane))
        for begin in range(first, last, step):
            yield begin, min(begin + step, last)


def lattice_around(
    boxes: Iterable[tuple[Corner, Corner]], origin: Corner, spacing: float, axis: int | None
) -> Lattice:
    """The smallest lattice with every site in the ``boxes`` (corners in m; low edges inside).

    ``axis`` None: the longest one, of equals the first.  No site at all gives counts of 0.
    """
    ranges = [
        [sites_between(*ends, o, spacing) for *ends, o in zip(lower, upper, origin)] for lower, upper in boxes
    ]
    found = [box for box in ranges if all(low < end for low, end in box)]
    if not found:
        return Lattice(origin, spacing, (0,) * len(origin), (0,) * len(origin), axis or 0)
    spans = [(min(low for low, _ in ks), max(end for _, end in ks)) for ks in zip(*found)]
    first, counts = zip(*((low, end - low) for low, end in spans))
    axis = counts.index(max(counts)) if axis is None else axis
    return Lattice(origin, spacing, first, counts, axis)


def sites_between(lower: float, upper: float, origin: float, spacing: float) -> tuple[int, int]:
    """First k inside and first k beyond of the sites between two coordinates, along one axis."""
    low, end = ((x - origin) / spacing - 0.5 - TOLERANCE for x in (lower, upper))
    return math.ceil(low), math.ceil(end)
