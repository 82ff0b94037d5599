"""Columns: what a line of sight through spread particles meets, as a picture has it."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.settled import settled

ENTRIES = 2048
"""Of the table of the kernel's columns, evenly over the square of the distance."""

NODES = 64
"""Of the quadrature along a line through the kernel."""

SMALL = 1e-12
"""Share of the kernel in its middle that counts as none."""


class Pixels(NamedTuple):
    """The pixels of a picture, ``count`` (across, up) of them from the corner ``lower`` on, a ``step`` wide,
    m."""

    lower: tuple[float, float]
    step: tuple[float, float]
    count: tuple[int, int]

    @classmethod
    def over(cls, lower: np.ndarray, upper: np.ndarray, most: int) -> "Pixels":
        """All but square ones between two corners (2,), m, ``most`` along the longer side."""
        size = np.asarray(upper) - lower
        count = np.maximum(1, np.rint(most * size / size.max())).astype(int)
        return cls(tuple(map(float, lower)), tuple(map(float, size / count)), tuple(map(int, count)))

    @property
    def middles(self) -> np.ndarray:
        """Their middles (up * across, 2), m, row by row from the lowest."""
        along = [low + step * (np.arange(n) + 0.5) for low, step, n in zip(self.lower, self.step, self.count)]
        return np.column_stack([x.ravel() for x in np.meshgrid(*along)])


def kernel_column(kernel, dimensions: int) -> np.ndarray:
    """∫W(√(b² + z²)) dz of a ``kernel`` with h = 1 m in 3D, W(b) in 2D, for b² evenly from 0 to the square of
    its support (ENTRIES,)."""
    b2 = np.linspace(0.0, kernel.support**2, ENTRIES)
    if dimensions == 2:
        return np.array([kernel.w(b) for b in np.sqrt(b2).tolist()])
    half = np.sqrt(kernel.support**2 - b2)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    r = np.sqrt(b2[:, None] + (half[:, None] * 0.5 * (nodes + 1.0)) ** 2)  # from the middle on
    return half * (np.vectorize(kernel.w)(r) @ weights)


def columns(
    places: np.ndarray, amounts: Iterable[np.ndarray], reach: np.ndarray, table: np.ndarray, pixels: Pixels
) -> np.ndarray:
    """Amounts a square metre on each line of sight (amounts, up, across), of particles at ``places`` (n, 2)
    on the picture, m, spread as far as they ``reach`` (n,), m, by the ``table`` of :func:`kernel_column`.

    Σ_j A_j K(b, H_j), with K so that the pixels of each particle have all of its amount: what is on the
    picture is there to rounding.  One smaller than a pixel is in that alone.
    """
    amounts = np.array([*amounts], float)
    found = np.zeros((len(amounts), pixels.count[1], pixels.count[0]))
    sound = np.isfinite(places).all(axis=1) & np.isfinite(reach) & np.isfinite(amounts).all(axis=0)
    rows = np.ascontiguousarray(places[sound])
    corner, step = np.array(pixels.lower), np.array(pixels.step)
    spread = rows, np.ascontiguousarray(amounts[:, sound]), np.ascontiguousarray(reach[sound])
    settled(spread_over)(0, len(rows), *spread, table, corner, step, found)
    return found / (step[0] * step[1])


def with_images(
    places: np.ndarray, reach: np.ndarray, lower, upper, periods
) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2), m, folded into the periods that begin at ``lower``, with those of images that reach into
    the picture to ``upper``; and the numbers of their particles."""
    number = np.arange(len(places))
    for axis, period in enumerate(periods):
        if not period:
            continue
        places, far = places.copy(), np.zeros(2)
        x = places[:, axis] - lower[axis]
        places[:, axis] = lower[axis] + x - period * np.floor(x / period)
        far[axis] = period
        more = [(places, number)]
        for way in (-1.0, 1.0):
            x, r = places[:, axis] + way * period, reach[number]
            near = (x + r > lower[axis]) & (x - r < upper[axis])
            more.append((places[near] + way * far, number[near]))
        places, number = (np.concatenate(parts) for parts in zip(*more))
    return places, number


def mirrored(
    places: np.ndarray, number: np.ndarray, reach: np.ndarray, planes: Iterable[tuple[int, float]]
) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2), m, with those behind ``planes``, an axis of the picture and where it stands, m, that
    reach before them; and the ``number`` of each one's particle, which ``reach`` so far, m.

    A picture that ends at the planes then has what each particle would spread beyond them.
    """
    for axis, at in planes:
        behind = places.copy()
        behind[:, axis] = 2.0 * at - places[:, axis]
        near = np.abs(places[:, axis] - at) < reach[number]
        places, number = np.concatenate([places, behind[near]]), np.concatenate([number, number[near]])
    return places, number


@elementwise
def spread_over(first, last, places, amounts, reach, table, corner, step, found):
    """Add the amounts of the particles ``first`` to ``last`` to the pixels within their reach."""
    most, least = len(table) - 1, SMALL * table[0]
    for j in range(np.uint64(first), np.uint64(last)):
        x, y = (places[j, 0] - corner[0]) / step[0], (places[j, 1] - corner[1]) / step[1]
        wide, high = reach[j] / step[0], reach[j] / step[1]
        left, right = int(np.ceil(x - wide - 0.5)), int(np.floor(x + wide - 0.5))
        low, top = int(np.ceil(y - high - 0.5)), int(np.floor(y + high - 0.5))
        total = 0.0
        for turn in range(2):
            for row in range(low, top + 1):
                for column in range(left, right + 1):
                    a, b = (column + 0.5 - x) / wide, (row + 0.5 - y) / high
                    b2 = (a * a + b * b) * most
                    if b2 >= most:
                        continue
                    n = int(b2)
                    share = table[n] + (b2 - n) * (table[n + 1] - table[n])
                    if turn == 0:
                        total += share
                    elif 0 <= row < found.shape[1] and 0 <= column < found.shape[2]:
                        for k in range(len(amounts)):
                            found[k, row, column] += amounts[k, j] * share / total
            if total <= least:
                break
        row, column = int(np.floor(y)), int(np.floor(x))
        if total <= least and 0 <= row < found.shape[1] and 0 <= column < found.shape[2]:
            for k in range(len(amounts)):
                found[k, row, column] += amounts[k, j]
