"""Walls without a pressure of their own, and what should not be asked of them."""

from collections.abc import Iterator

from psph.fields import PRESSURE
from psph.physics.walls.conditions import BEARING, MIRROR
from psph.scene.gauging import within_reach
from psph.scene.scene import Scene

TAKE = " or ".join(f'"{condition}"' for condition in (*BEARING, MIRROR))


def unbearing_walls(scene: Scene) -> list[str]:
    """The names of the walls whose particles bear no pressure."""
    walls = (part for part in scene.layout.parts if part.is_wall)
    return [part.name for part in walls if part.table.condition not in BEARING]


def unbearing_warnings(scene: Scene) -> Iterator[str]:
    """A line for each such wall of a box that is full, and for each pressure that is read beside one."""
    names = unbearing_walls(scene)
    if names and not scene.has_free_surface:
        for name in names:
            condition = scene.case.walls[name].condition
            yield (
                f'walls.{name}.condition: "{condition}" bears no pressure, and the fluid '
                f"has no surface at which it could give way; take {TAKE}"
            )
    for key, point in _pressure_points(scene) if names else ():
        for name in within_reach(scene, names, point):
            condition = scene.case.walls[name].condition
            yield (
                f'{key}: walls.{name} beside it has condition = "{condition}" and bears no '
                f"pressure: what is read there is wrong by half; give that wall {TAKE}, or read farther away"
            )


def _pressure_points(scene: Scene) -> Iterator[tuple[str, tuple[float, ...]]]:
    """The keys of probes and gauges that read a pressure, and where, m."""
    for name, probe in scene.case.probes.items():
        if probe.position is not None and PRESSURE.name in probe.fields:
            yield f"probes.{name}", probe.position
    for name, gauge in scene.case.gauges.items():
        if gauge.sensor or gauge.point and PRESSURE.name in gauge.point.fields:
            yield f"gauges.{name}", (gauge.sensor or gauge.point).position
