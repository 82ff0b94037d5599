"""The gauges that a case asks for."""

import math
from typing import Any

from psph.case.keys import AXES
from psph.output.gauges.displacement import REACH, DisplacementGauge
from psph.output.gauges.flow import FlowGauge
from psph.output.gauges.force import ForceGauge
from psph.output.gauges.level import LevelGauge
from psph.output.gauges.motion import MotionGauge
from psph.output.gauges.points import PointGauge, disc
from psph.output.probes import Front, Probe
from psph.output.tables import GAUGE

PER_SPACING = 4
"""Points of the line of a level in a spacing."""


def gauges_of(scene, mirrors=None) -> dict[str, Any]:
    """Each gauge of a scene by the file of its table; beside ``mirrors`` (psph.composition.mirrors)."""
    return {
        GAUGE.format(name): gauge_of(scene, name, table, mirrors) for name, table in scene.case.gauges.items()
    }


def gauge_of(scene, name: str, table, mirrors=None):
    """The gauge of one table of ``[gauges]``: every, columns(scene) and row(simulation)."""
    asked, every = getattr(table, table.kind), table.every
    match table.kind:
        case "force":
            names = (*scene.case.fluids, *scene.boundaries)
            groups = tuple(k for k, one in enumerate(names) if one in asked.on)
            return ForceGauge(name, every, groups, asked.about)
        case "level":
            parts = math.ceil(math.dist(asked.foot, asked.top) / scene.spacing * PER_SPACING - 1e-9)
            return LevelGauge(name, every, asked.foot, asked.top, max(1, parts))
        case "flow":
            [axis] = (d for d, ends in enumerate(zip(asked.lower, asked.upper)) if ends[0] == ends[1])
            return FlowGauge(name, every, axis, asked.lower, asked.upper)
        case "motion":
            return MotionGauge(name, every, asked.of)
        case "displacement":
            number = list(scene.case.solids).index(asked.of)
            groups = tuple(k for k, one in enumerate(scene.species) if one.elastic == number)
            return DisplacementGauge(name, every, groups, asked.at, REACH * scene.spacing)
        case "highest":
            return PointGauge(Front(name, AXES.index(asked.axis)), every)
        case "point":
            return PointGauge(Probe(name, asked.position, asked.fields, mirrors), every)
        case _:
            points = disc(asked.position, AXES.index(asked.axis), asked.diameter, scene.spacing)
            return PointGauge(Probe(name, points, ("pressure",), mirrors), every)
