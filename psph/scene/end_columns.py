"""The fluids that stand upon each other behind an open end at the start: layers of a column."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from psph.case.ends import OpenEnd
from psph.scene.end_rows import across_up, first_fluid, sites_behind

FINE = 1024.0
"""Heights that are one in so many parts of a spacing are one."""


class Column(NamedTuple):
    """Layers from the lowest up, which meet at ``edges`` (layers + 1,), m along gravity as levels are, with
    ``rest`` densities (layers,), kg/m³, and speeds of ``sound`` (layers,), m/s.  The first edge is below and
    the last above all."""

    edges: np.ndarray
    rest: np.ndarray
    sound: np.ndarray


def column_of(
    scene, end: OpenEnd, groups: tuple[int, ...], lower: np.ndarray, upper: np.ndarray
) -> tuple[Column, float | None]:
    """The column behind an end whose buffers are in a box from ``lower`` to ``upper`` (dim,), m, and the
    lowest height at which fluids of different density stand beside each other, m, None where none do.

    Where nothing stands, or gravity does not pull across, it is of the fluid that comes in first.
    """
    height, held = _standing(scene, end, groups, lower, upper)
    of = np.array([(one.density, one.sound_speed) for one in scene.species])
    if not len(height):
        one = of[groups[first_fluid(scene.layout, end)]]
        return Column(np.array([-np.inf, np.inf]), one[:1], one[1:]), None
    row_of = np.rint(height * FINE / scene.spacing)
    order = np.argsort(row_of, kind="stable")
    height, fluids, row_of = height[order], of[held[order]], row_of[order]
    begins = np.flatnonzero(np.diff(row_of, prepend=-np.inf))
    rows, layers = height[begins], fluids[begins]
    spread = [ufunc.reduceat(fluids[:, 0], begins) for ufunc in (np.minimum, np.maximum)]
    mixed = rows[spread[0] < spread[1]]
    new = np.flatnonzero((layers[1:] != layers[:-1]).any(axis=1))
    edges = np.concatenate([[-np.inf], 0.5 * (rows[new] + rows[new + 1]), [np.inf]])
    rest, sound = np.concatenate([layers[:1], layers[new + 1]]).T
    found = Column(edges, np.ascontiguousarray(rest), np.ascontiguousarray(sound))
    return found, float(mixed[0]) if len(mixed) else None


def _standing(scene, end: OpenEnd, groups, lower, upper) -> tuple[np.ndarray, np.ndarray]:
    """The heights (n,), m, of the sites right behind the plane that hold fluid, and whose they are (n,)."""
    layout = scene.layout
    up = across_up(layout, end)
    if not up.any():
        return np.zeros(0), np.zeros(0, np.int64)
    places = sites_behind(layout, end, lower, upper, int(np.abs(up).argmax()))
    held = layout.held([*np.moveaxis(places, -1, 0)], places.shape[:-1])
    own = np.isin(held, groups)
    places[..., end.axis] = end.at
    return (places @ np.array(layout.up))[own], held[own]


def side_by_side(columns: Sequence[Column]) -> Column:
    """The same of several columns (columns, ...), which get as many layers each: those that lack are above
    all."""
    most = max(len(one.rest) for one in columns)

    def filled(numbers: Sequence[np.ndarray], count: int) -> np.ndarray:
        return np.array([np.pad(one, (0, count - len(one)), "edge") for one in numbers])

    edges, rest, sound = zip(*columns)
    return Column(filled(edges, most + 1), filled(rest, most), filled(sound, most))
