"""How many layers of particles a wall has behind the face that a fluid touches."""

import math
from collections.abc import Iterator

import numpy as np

from psph.composition.reflections import ABOVE, BELOW
from psph.scene.lattice import TOLERANCE
from psph.scene.layout import NONE, Layout

Thin = dict[int, tuple[int, tuple[float, ...]]]
"""For a wall that is too thin somewhere: the fewest layers, and a site that has so many."""


def layers_needed(layout: Layout) -> int:
    """Layers that fill the support of a fluid particle at the face of a wall."""
    reach = layout.kernel.support * layout.case.space.smoothing
    return math.ceil(reach - TOLERANCE)


def touches_air(layout: Layout) -> bool:
    """Whether a fluid site has an empty site beside it at the start, walls and periodic images counted."""
    for first, last in layout.lattice.chunks():
        held = with_surroundings(layout, first, last, 1)
        inner = (slice(1, -1),) * held.ndim
        fluid = layout.flows(held[inner])
        for axis in range(held.ndim):
            for beside in (slice(None, -2), slice(2, None)):
                window = (*inner[:axis], beside, *inner[axis + 1 :])
                if (fluid & (held[window] == NONE)).any():
                    return True
    return False


def unheld(layout: Layout, axis: int, sign: int) -> float:
    """Part of the lines of sites along ``axis`` with fluid that have no wall beyond it."""
    lattice = layout.lattice
    place, nowhere = lattice.axes.index(axis), -lattice.counts[axis] - 1
    held = with_fluid = 0
    ends = None  # of the lines so far, where they go on from chunk to chunk
    for first, last in lattice.chunks():
        found = layout.materials(first, last)
        sites = sign * (np.arange(found.shape[place]) + (0 if place else first))
        along = sites.reshape((-1,) + (1,) * (found.ndim - place - 1))
        far = np.array(
            [
                np.where(mask, along, nowhere).max(axis=place)
                for mask in (layout.flows(found), layout.stands(found))
            ]
        )
        ends = far if place or ends is None else np.maximum(ends, far)
        if place or last == lattice.planes:
            fluid, wall = ends
            with_fluid += np.count_nonzero(fluid > nowhere)
            held += np.count_nonzero((fluid > nowhere) & (wall > fluid))
    return 1.0 - held / with_fluid if with_fluid else 0.0


def thinnest_walls(layout: Layout) -> Thin:
    """The walls with fewer layers than needed, by material.

    From each wall site that touches a fluid site the wall sites are counted along the axis, away
    from the fluid; a site that touches in several directions has the largest count, so that the
    tip of a round body is not thin.  Of walls that are thick enough there, the sites that touch an empty one
    count in the same way: fluid may come to them.
    """
    need, wet, dry = layers_needed(layout), Thin(), Thin()
    if not any(part.ends_kernel for part in layout.parts):
        return wet
    for first, last in layout.lattice.chunks():
        held = with_surroundings(layout, first, last, need)
        is_wall = layout.stands(held)
        inner = held[(slice(need, -need),) * held.ndim]
        for thin, faced in ((wet, layout.flows(held)), (dry, held == NONE)):
            layers = _layers(is_wall, faced, need)
            for material in np.unique(inner[layers < need]).tolist():
                its_layers = np.where(inner == material, layers, need)
                _keep_thinnest(thin, layout, first, last, material, its_layers)
    return dry | wet


def _layers(is_wall: np.ndarray, faced: np.ndarray, need: int) -> np.ndarray:
    """Wall sites behind each wall site that touches a ``faced`` one, at most ``need``; else ``need``."""
    best = np.zeros([n - 2 * need for n in is_wall.shape], np.uint8)
    touching = np.zeros(best.shape, bool)
    for axis in range(is_wall.ndim):
        for away in (-1, 1):
            unbroken = _moved(is_wall, axis, 0, need) & _moved(faced, axis, -away, need)
            touching |= unbroken
            count = unbroken.astype(np.uint8)
            for step in range(1, need):
                unbroken &= _moved(is_wall, axis, away * step, need)
                count += unbroken
            best = np.maximum(best, count)
    return np.where(touching, best, need)


def _moved(array: np.ndarray, axis: int, step: int, margin: int) -> np.ndarray:
    """The inner sites' neighbours, ``step`` sites away along an axis."""
    window = [slice(margin, n - margin) for n in array.shape]
    window[axis] = slice(margin + step, array.shape[axis] - margin + step)
    return array[tuple(window)]


def with_surroundings(layout: Layout, first: int, last: int, margin: int) -> np.ndarray:
    """Materials of some planes and of ``margin`` sites around them, across periodic edges and in mirrors."""
    lattice = layout.lattice
    mirrored = set(_mirrored_sides(layout))
    wraps = [
        period is not None and round(period / layout.spacing) == count
        for period, count in zip(layout.periods, lattice.counts)
    ]
    nothing = np.full(lattice.shape(0, 1), NONE, np.uint8)

    def plane(k: int) -> np.ndarray:
        if wraps[layout.axis]:
            k %= lattice.planes
        elif k < 0 and (layout.axis, BELOW) in mirrored:
            k = -1 - k
        elif k >= lattice.planes and (layout.axis, ABOVE) in mirrored:
            k = 2 * lattice.planes - 1 - k
        return layout.materials(k, k + 1) if 0 <= k < lattice.planes else nothing

    held = np.concatenate(
        [
            *(plane(k) for k in range(first - margin, first)),
            layout.materials(first, last),
            *(plane(k) for k in range(last, last + margin)),
        ]
    )
    for place, d in enumerate(lattice.axes[1:], start=1):
        if wraps[d]:
            held = np.pad(held, _at(place, (margin, margin), held.ndim), mode="wrap")
            continue
        for side, ends in ((BELOW, (margin, 0)), (ABOVE, (0, margin))):
            beyond = {"mode": "symmetric"} if (d, side) in mirrored else {"constant_values": NONE}
            held = np.pad(held, _at(place, ends, held.ndim), **beyond)
    return held


def _mirrored_sides(layout: Layout) -> Iterator[tuple[int, int]]:
    """Axis and side of the lattice's ends at which a mirror stands."""
    ends = {BELOW: layout.lattice.lower, ABOVE: layout.lattice.upper}
    for plane in layout.mirror_planes:
        if abs(ends[plane.side][plane.axis] - plane.at) < 0.5 * layout.spacing:
            yield plane.axis, plane.side


def _at(place: int, ends: tuple[int, int], axes: int) -> list[tuple[int, int]]:
    """Widths for ``np.pad``: ``ends`` along the axis at one place."""
    return [ends if k == place else (0, 0) for k in range(axes)]


def _keep_thinnest(thin: Thin, layout: Layout, first: int, last: int, material: int, layers) -> None:
    site = np.unravel_index(layers.argmin(), layers.shape)
    fewest = int(layers[site])
    if material not in thin or fewest < thin[material][0]:
        grid = layout.lattice.grid(first, last)
        where = tuple(float(np.broadcast_to(x, layers.shape)[site]) for x in grid)
        thin[material] = fewest, where
