"""Walls, bodies and frames that move: how far and how fast."""

import math
from collections.abc import Iterator
from itertools import product

import numpy as np

from psph.physics.motion import is_rigid, told_of
from psph.physics.rigid.pose import PLACE, maps
from psph.scene.census import Census
from psph.scene.layout import Layout
from psph.scene.sweeps import Sweep, sweep


def moving_parts(census: Census) -> Iterator[tuple[int, str, Sweep]]:
    """Each wall and body that moves rigidly as it is told: its number among the species, its key and what
    it does."""
    for number, one in enumerate(census.motions):
        told = told_of(one)
        if is_rigid(told) and census.layout.parts[number].drawn:
            low, high = (tuple(end.tolist()) for end in _box(census, number))
            yield number, census.layout.parts[number].key, sweep(told, low, high, census.layout.case.time.end)


def _box(census: Census, number: int) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the box around the cells of a part at the start, m."""
    half = 0.5 * census.layout.spacing
    return census.lowest[number] - half, census.highest[number] + half


def frame_sweep(layout: Layout) -> Sweep | None:
    """What a moving frame does to the box around the scene."""
    if layout.frame is None:
        return None
    return sweep(layout.frame, tuple(layout.lower), tuple(layout.upper), layout.case.time.end)


def largest_speed(census: Census) -> float:
    """Of walls and bodies that move as they are told, and of bodies that start with a spin, m/s."""
    told = (found.speed for _, _, found in moving_parts(census))
    starting = (
        one.starting_speed(*_box(census, number))
        for number, one in enumerate(census.motions)
        if hasattr(one, "starting_speed")
    )
    return max((*told, *starting), default=0.0)


def fastest_corner(census: Census, number: int, velocity: tuple[float, ...]) -> float:
    """Largest speed at a corner of the box around a part that starts with a ``velocity`` in m/s and a
    gradient of that."""
    table = census.layout.parts[number].table
    if not table.velocity_gradient:
        return 0.0
    ends = np.array([census.lowest[number], census.highest[number]])
    corners = np.array(list(product(*ends.T)))
    velocities = table.sheared(corners) + np.array(velocity)
    return float(np.sqrt((velocities**2).sum(axis=1)).max())


def falling_speed(census: Census) -> float:
    """√(2gH), free fall over the height H of all that moves freely, m/s: g without what pulls along a
    periodic axis, and with the largest acceleration of a moving frame.

    A body falls as far as its lowest particle is above the lowest of all, on a pivot as far as its highest.
    """
    layout, movers = census.layout, list(census.layout.parts.movers)
    framed = frame_sweep(layout)
    pull = math.hypot(*layout.height_gravity) + (framed.acceleration if framed else 0.0)
    tops, bottoms = census.top[movers].tolist(), census.bottom[movers].tolist()
    for one, lowest, highest in zip(census.motions, census.bottom.tolist(), census.top.tolist()):
        if not hasattr(one, "fall"):
            continue
        if ends := one.fall(lowest, highest, layout.spacing, layout.height_gravity):
            tops.append(ends[0])
            bottoms.append(ends[1])
    height = max(tops) - min(bottoms) + layout.spacing
    return math.sqrt(2.0 * pull * max(height, 0.0))


def moved_on(motion, points: np.ndarray, time: float, dimensions: int) -> np.ndarray:
    """Where ``points`` (n, dim), m, of something rigid have come at ``time``."""
    place = maps(motion.pose(time), dimensions)[PLACE]
    return place[:, 0] + points @ place[:, 1:].T


def taken_back(motion, points: np.ndarray, time: float, dimensions: int) -> np.ndarray:
    """Where ``points`` (n, dim), m, of something rigid at ``time`` were before it moved."""
    place = maps(motion.pose(time), dimensions)[PLACE]
    return (points - place[:, 0]) @ place[:, 1:]
