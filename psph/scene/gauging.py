"""Whether probes and gauges look where something can be."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from psph.scene.scene import Scene


def misplaced(scene: "Scene") -> Iterator[str]:
    """A line for each point of a probe or a gauge outside the domain."""
    points = [(f"probes.{name}.position", probe.position) for name, probe in scene.case.probes.items()]
    for name, gauge in scene.case.gauges.items():
        asked, kind = getattr(gauge, gauge.kind), gauge.kind
        for key in ("position", "foot", "top"):
            points.append((f"gauges.{name}.{kind}.{key}", getattr(asked, key, None)))
    for key, point in points:
        if point is not None and not all(
            low <= x <= up for low, x, up in zip(scene.lower, point, scene.upper)
        ):
            yield (
                f"{key}: {shown(point)} lies outside the domain {shown(scene.lower)} to "
                f"{shown(scene.upper)}; move it inside"
            )


def shown(x: Sequence[float]) -> str:
    """A point in a message."""
    return f"[{', '.join(f'{value:.6g}' for value in x)}]"
