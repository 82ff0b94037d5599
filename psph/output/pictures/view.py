"""Where one looks from: which way is up, and the box in which a run takes place."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from matplotlib.axes import Axes

from psph.case.keys import AXES
from psph.output.pictures import style
from psph.output.pictures.scale import Scale

MOST = (1.0, 99.0)
"""Percentiles of the places along an axis between which most particles lie."""

FARTHEST = 3.0
"""Sizes of a scene, its longest, that most of it may go beyond its start and still be shown."""


class Panel(Protocol):
    """How a frame is drawn into a panel of a page."""

    aspect: float
    """Width over height."""
    variant: str
    """What distinguishes its pictures by name from those usually drawn, or nothing."""
    keyed: bool
    """Whether colours carry the values."""
    remark: str
    """What the subtitle says of it, or nothing."""

    def of(self, frame: dict) -> dict:
        """The visible particles of a frame."""

    def draw(self, axes: Axes, frame: dict, scale: Scale, first: bool, last: bool) -> None:
        """Draw a frame whose ``values`` (n,) have colours; the ``first`` panel of a row and the ``last``
        of a column have labels."""


class Room(NamedTuple):
    """The box from ``lower`` to ``upper`` (dim,), m, that all frames lie in, and the particles' ``spacing``.

    ``up`` is the axis of gravity, upwards if ``sense`` is 1; ``level`` are the others, the longest first.
    """

    spacing: float
    lower: np.ndarray
    upper: np.ndarray
    up: int
    sense: int
    level: tuple[int, ...]

    @property
    def dimensions(self) -> int:
        """Number of axes."""
        return len(self.lower)

    @property
    def length(self) -> tuple[float, str]:
        """Factor and unit of its places: ``(1000.0, "mm")`` for a small one."""
        return style.length(max(np.abs(self.lower).max(), np.abs(self.upper).max()))

    def on_page(self, axis: int) -> str:
        """The label of an axis."""
        return f"{AXES[axis]} ({self.length[1]})"

    def holds(self, places: np.ndarray) -> np.ndarray:
        """True (n,) for places (n, dim) in it; not for those that are not finite."""
        edge = 1e-6 * self.spacing
        return ((places >= self.lower - edge) & (places <= self.upper + edge)).all(axis=1)


def room_of(case: dict, boxes: Sequence[np.ndarray], most: Sequence[np.ndarray]) -> Room:
    """The room of frames with ``boxes`` (2, dim) around their particles, m, that at the start first.

    ``most``: boxes around most of them.  Gravity points down, but for a periodic axis.
    """
    dimensions, spacing = case["space"]["dimensions"], case["space"]["spacing"]
    extents = np.array(boxes)
    size = extents[0, 1] - extents[0, 0] + spacing
    # What a run that blows up throws far away must not make the rest small; a thin beam that bends and a
    # strip that is drawn out are seen.  So most particles may reach further by the size of the scene from one
    # frame to the next, and by a few sizes in all.
    low, high, step = extents[0, 0], extents[0, 1], size.max()
    for lowest, highest in np.array(most):
        low = np.maximum(np.minimum(lowest, low), low - step)
        high = np.minimum(np.maximum(highest, high), high + step)
    low = np.maximum(low, extents[0, 0] - FARTHEST * step)
    high = np.minimum(high, extents[0, 1] + FARTHEST * step)
    lower = np.maximum(extents[:, 0].min(axis=0), low - size) - spacing / 2
    upper = np.minimum(extents[:, 1].max(axis=0), high + size) + spacing / 2
    gravity = case.get("physics", {}).get("gravity", {}).get("acceleration", [0.0] * dimensions)
    # Along a periodic axis gravity drives a channel: there is no height.
    pull = [0.0 if "xyz"[d] in case["space"].get("periodic", ()) else g for d, g in enumerate(gravity)]
    up = int(np.argmax(np.abs(pull))) if any(pull) else dimensions - 1
    part = np.round(size / size.max(), 1)  # sides that are almost alike are in their order
    level = sorted(set(range(dimensions)) - {up}, key=lambda axis: (-part[axis], axis))
    return Room(spacing, lower, upper, up, -1 if pull[up] > 0 else 1, tuple(level))


def box_around(places: np.ndarray) -> np.ndarray:
    """The lower and the upper corner (2, dim) of the smallest box around all finite positions (n, dim)."""
    places = places[np.isfinite(places).all(axis=1)]
    return np.stack([places.min(axis=0, initial=np.inf), places.max(axis=0, initial=-np.inf)])


def around_most(places: np.ndarray) -> np.ndarray:
    """The corners (2, dim) of a box around ``MOST`` of all finite positions (n, dim) along each axis."""
    places = places[np.isfinite(places).all(axis=1)]
    return np.percentile(places, MOST, axis=0) if len(places) else box_around(places)


def spread(count: int, most: int) -> Sequence[int]:
    """Up to ``most`` of ``count`` frames, evenly, the first and the last among them."""
    return sorted({int(k) for k in np.linspace(0, count - 1, min(count, most)).round()})
