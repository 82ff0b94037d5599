"""Whether probes and gauges look where something can be."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from psph.scene.behind import Solid

if TYPE_CHECKING:
    from psph.scene.scene import Scene


BURIED = 0.5
"""Spacings behind a wall's face from which on a probe is said to be in the wall."""


def misplaced(scene: "Scene") -> Iterator[str]:
    """A line for each point of a probe or a gauge outside the domain."""
    for key, point in _points(scene, "position", "foot", "top"):
        if not all(low <= x <= up for low, x, up in zip(scene.lower, point, scene.upper)):
            yield (
                f"{key}: {shown(point)} lies outside the domain {shown(scene.lower)} to "
                f"{shown(scene.upper)}; move it inside"
            )


def buried(scene: "Scene") -> Iterator[str]:
    """A line for each point within a wall that stands still; a line of a gauge may begin there."""
    solid = Solid(scene)
    for key, point in _points(scene, "position"):
        if solid.deep(np.array([point]), BURIED)[0]:
            yield f"{key}: {shown(point)} lies in a wall, where there is no fluid to measure; move it out"


def _points(scene: "Scene", *keys: str) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Keys of the case that name a point of a probe or a gauge, and the point, m."""
    asked = [(f"probes.{name}", probe) for name, probe in scene.case.probes.items()]
    for name, gauge in scene.case.gauges.items():
        asked.append((f"gauges.{name}.{gauge.kind}", getattr(gauge, gauge.kind)))
    for table, one in asked:
        for key in keys:
            if (point := getattr(one, key, None)) is not None:
                yield f"{table}.{key}", point


def shown(x: Sequence[float]) -> str:
    """A point in a message."""
    return f"[{', '.join(f'{value:.6g}' for value in x)}]"
