"""Rulers along the edges of a scene in 3D."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from psph.output.pictures import style
from psph.output.pictures.camera import Camera
from psph.output.pictures.view import Room

TICK, NUMBER, NAME = 0.05, 0.1, 0.33
"""Length of a tick, and how far a number and the name of an axis are from their edge, inches."""
APART = 0.42
"""Inches along an edge that a number needs."""

CLOSE = 0.3
"""Inches between two numbers that would touch."""


def rulers(axes: Axes, camera: Camera, lower: np.ndarray, upper: np.ndarray, room: Room) -> None:
    """Draw one along each axis of the box from ``lower`` to ``upper`` (3,), m, where it hides nothing."""
    page = axes.figure.get_size_inches() * axes.get_position().size  # inches of the panel
    floor = (lower if room.sense > 0 else upper)[room.up]
    middle = (lower + upper) / 2
    middle[room.up] = floor
    [centre] = camera.seen(middle[None]) * page
    taken: list[np.ndarray] = []
    for axis in sorted(range(3), key=lambda axis: axis == room.up):  # numbers of the height give way
        ends = [_edge(axis, corner, lower, upper) for corner in np.ndindex(2, 2)]
        ends = [pair for pair in ends if axis == room.up or pair[0, room.up] == floor]
        seen = [camera.seen(pair) * page for pair in ends]
        # Upright the edge farthest to the left; on the floor the one that is nearest.
        which = 0 if axis == room.up else 1
        best = int(np.argmin([points[:, which].mean() for points in seen]))
        _ruler(axes, camera, ends[best], axis, page, centre, taken, room)


def _edge(axis: int, corner: tuple[int, int], lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """The two ends (2, 3) of an edge along ``axis``."""
    ends = np.array([lower, upper])
    others = [d for d in range(3) if d != axis]
    for d, side in zip(others, corner):
        ends[:, d] = (lower, upper)[side][d]
    return ends


def _ruler(
    axes: Axes, camera: Camera, ends: np.ndarray, axis: int, page: np.ndarray, centre, taken: list, room: Room
) -> None:
    first, last = camera.seen(ends) * page
    along = (last - first) / max(float(np.linalg.norm(last - first)), 1e-9)
    out = np.array([-along[1], along[0]])
    out *= np.sign(out @ ((first + last) / 2 - centre)) or 1.0
    count = max(1, int(np.linalg.norm(last - first) / APART))
    low, high = sorted(ends[:, axis])
    ticks = MaxNLocator(min(count, 6), steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    slack = 1e-6 * (high - low)
    ticks = ticks[(ticks >= low - slack) & (ticks <= high + slack)]
    points = np.repeat(ends[:1], len(ticks), axis=0)
    points[:, axis] = ticks
    how = {"ha": _aligned(out[0], "left", "right"), "va": _aligned(out[1], "bottom", "top"), "clip_on": False}
    _line(axes, [first / page, last / page])
    for tick, point in zip(ticks, camera.seen(points) * page):
        _line(axes, [point / page, (point + TICK * out) / page])
        place = point + NUMBER * out
        if all(np.linalg.norm(place - other) > CLOSE for other in taken):
            axes.text(*(place / page), style.number(room.length[0] * tick), **how, size=8)
            taken.append(place)
    axes.text(*(((first + last) / 2 + NAME * out) / page), room.on_page(axis), **how)


def _line(axes: Axes, ends) -> None:
    axes.plot(*np.transpose(ends), color=style.PALE, lw=0.6, clip_on=False)


def _aligned(component: float, positive: str, negative: str) -> str:
    if abs(component) < 0.35:
        return "center"
    return positive if component > 0 else negative
