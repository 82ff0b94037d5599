"""Whether probes and gauges look where something can be."""

from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.fields import CROSSED, REFERENCE, Field
from psph.scene.lattice import TOLERANCE
from psph.scene.moving import moving_parts
from psph.scene.outside import WallRegion
from psph.scene.scene import Scene
from psph.scene.shapes import bounds, inside, shown

BURIED = 0.5
"""Spacings behind a wall's face from which on a probe is said to be in the wall."""

TRIFLE = 1e-6
"""Spacings by which a point may lie outside: 54 times 0.0075 is less than 0.405 in binary numbers."""

BESIDE = 1.0
"""Spacings along each axis by which a point of a solid may lie beside it: edges follow the lattice."""


def outside_domain(scene: Scene) -> Iterator[str]:
    """A line for each point of a probe or a gauge, and each whole section, outside the domain."""
    for key, point, _ in _points(scene, "position", "foot", "top"):
        yield from _outside(scene, key, point)
    lower, upper = scene.layout.lower, scene.layout.upper
    for name, section in ((name, one.flow) for name, one in scene.case.gauges.items() if one.flow):
        below = any(up < low for up, low in zip(section.upper, lower))
        if below or any(low > up for low, up in zip(section.lower, upper)):
            yield (
                f"gauges.{name}.flow: a section from {shown(section.lower)} to {shown(section.upper)} lies "
                f"outside the domain {shown(lower)} to {shown(upper)}; move it inside"
            )


def _outside(scene: Scene, key: str, point: tuple[float, ...]) -> Iterator[str]:
    """A line for a point that lies outside the domain."""
    off, lower, upper = TRIFLE * scene.spacing, scene.layout.lower, scene.layout.upper
    if not all(low - off <= x <= up + off for low, x, up in zip(lower, point, upper)):
        where = f"the domain {shown(lower)} to {shown(upper)}"
        yield f"{key}: {shown(point)} lies outside {where}; move it inside"


def off_parts(scene: Scene) -> Iterator[str]:
    """A line for each point whose displacement or stress is asked for and that lies off its solid; of what
    keeps no neighbours of the start, for each outside the domain."""
    around = np.linspace(-BESIDE, BESIDE, 7) * scene.spacing
    for name, gauge in scene.case.gauges.items():
        if (asked := gauge.displacement or gauge.stress) is None:
            continue
        kept = next((p for p in scene.layout.parts if p.name == asked.of and p.keeps_neighbours), None)
        if kept is None:
            yield from _outside(scene, f"gauges.{name}.{gauge.kind}.at", asked.at)
            continue
        places = np.meshgrid(*(x + around for x in asked.at), indexing="ij")
        grid = [scene.layout.folded(d, place) for d, place in enumerate(places)]
        if not inside(kept.shape, grid, TOLERANCE * scene.spacing).any():
            yield (
                f"gauges.{name}.{gauge.kind}.at: {shown(asked.at)} lies off {kept.key}; give a point "
                "in it or on its face"
            )


def inside_walls(scene: Scene) -> Iterator[str]:
    """A line for each point within a wall that stands still, or within what carries it; a line of a gauge
    may begin there."""
    still, species = WallRegion(scene), {one.name: one for one in scene.species}
    for key, point, carrier in _points(scene, "position"):
        walls = WallRegion(scene, species[carrier].motion) if carrier else still
        if walls.deep(np.array([point]), BURIED)[0]:
            yield f"{key}: {shown(point)} lies in a wall, where there is no fluid to measure; move it out"


def within_reach(scene: Scene, names: list[str], point: tuple[float, ...]) -> Iterator[str]:
    """Those of the walls ``names`` that the kernel around a point reaches."""
    around = np.arange(1 - scene.layout.wall_reach, scene.layout.wall_reach) * scene.spacing
    places = np.meshgrid(*(x + around for x in point), indexing="ij")
    distance = np.sqrt(sum((place - x) ** 2 for place, x in zip(places, point)))
    grid = [scene.layout.folded(d, place) for d, place in enumerate(places)]
    held = scene.layout.held(grid, distance.shape)
    near = set(held[distance < scene.support].tolist())
    for number, name in enumerate(scene.layout.names):
        if number in near and name in names:
            yield name


def gauge_warnings(scene: Scene) -> Iterator[str]:
    """A line for each gauge that reads something else than it is likely meant to."""
    yield from _left_behind(scene)
    yield from _upside_down(scene)
    yield from _beyond(scene)


def _upside_down(scene: Scene) -> Iterator[str]:
    """A line for each line of a level or a run-up that goes down: its level is the distance to its lowest wet
    point."""
    for name, gauge in scene.case.gauges.items():
        if (line := gauge.level or gauge.run_up) is None:
            continue
        if sum(g * (top - foot) for g, foot, top in zip(scene.gravity, line.foot, line.top)) > 0.0:
            yield (
                f"gauges.{name}.{gauge.kind}: its foot {shown(line.foot)} is above its top "
                f"{shown(line.top)}, and the {gauge.kind.replace('_', '-')} counts from the foot to the "
                "farthest point in the fluid; exchange the two"
            )


def _beyond(scene: Scene) -> Iterator[str]:
    """A line for each crest and each whole shape outside the domain."""
    lower, upper, periods = scene.layout.lower, scene.layout.upper, scene.layout.periods
    where = f"outside the domain {shown(lower)} to {shown(upper)}, where nothing is at the start"
    for name, gauge in scene.case.gauges.items():
        key, asked = f"gauges.{name}.{gauge.kind}", getattr(gauge, gauge.kind)
        if gauge.overtopping:
            axis = AXES.index(asked.towards[1])
            if not lower[axis] <= asked.at <= upper[axis]:
                yield f"{key}.at: {asked.at:g} m lies {where}"
        if (within := getattr(asked, "shape", None)) is not None:
            ends = zip(*bounds(within), lower, upper, periods)
            if any(period is None and (up < least or low > most) for low, up, least, most, period in ends):
                yield f"{key}.shape: lies {where}"


def _left_behind(scene: Scene) -> Iterator[str]:
    """A line for each sensor on a wall that moves away from it."""
    moving = [scene.layout.names[number] for number, _, _ in moving_parts(scene.census)]
    sensors = [(name, gauge.sensor) for name, gauge in scene.case.gauges.items() if gauge.sensor]
    for name, sensor in sensors if moving else ():
        if sensor.moves_with:
            continue
        for wall in within_reach(scene, moving, sensor.position):
            yield (
                f"gauges.{name}.sensor: walls.{wall} moves, and a sensor stays where it is in space; give "
                f'moves_with = "{wall}", or let the frame of reference move in its place (frame.motion)'
            )


def _points(scene: Scene, *keys: str) -> Iterator[tuple[str, tuple[float, ...], str | None]]:
    """Keys of the case that name a point of a probe or a gauge, the point, m, and what carries it along."""
    asked = [(f"probes.{name}", probe) for name, probe in scene.case.probes.items()]
    for name, gauge in scene.case.gauges.items():
        asked.append((f"gauges.{name}.{gauge.kind}", getattr(gauge, gauge.kind)))
    for table, one in asked:
        for key in keys:
            if (point := getattr(one, key, None)) is not None:
                yield f"{table}.{key}", point, getattr(one, "moves_with", None)


def followed_fields(scene: Scene) -> tuple[Field, ...]:
    """What particles carry because gauges follow them: where they were, and how often they have crossed."""
    gauges = scene.case.gauges.values()
    followed = any(gauge.displacement for gauge in gauges)
    bonded = any(part.keeps_neighbours for part in scene.layout.parts)
    counted = followed or bonded and any(gauge.reaction or gauge.force for gauge in gauges)
    across = (CROSSED,) if counted and any(scene.layout.periods) else ()
    return (*([REFERENCE] if followed else []), *across)
