"""The gauges that a case asks for."""

import math
from typing import Any

import numpy as np

from psph.case.keys import AXES
from psph.moments import seam_shares
from psph.output.flowing import ALL, groups_named
from psph.output.gauges.carried import Carrier
from psph.output.gauges.corners import Corners
from psph.output.gauges.displacement import DisplacementGauge
from psph.output.gauges.fit import REACH
from psph.output.gauges.flow import FlowGauge
from psph.output.gauges.force import ForceGauge
from psph.output.gauges.joint import JointGauge
from psph.output.gauges.level import LevelGauge
from psph.output.gauges.motion import MotionGauge
from psph.output.gauges.points import CarriedPoints, PointGauge, disc
from psph.output.gauges.reaction import ReactionGauge
from psph.output.gauges.run_up import RunUpGauge
from psph.output.gauges.sensor import SensorGauge, face_of
from psph.output.gauges.stress import StressGauge
from psph.output.gauges.volume import OvertoppingGauge, VolumeGauge, Within
from psph.output.probes import FieldProbe, Front
from psph.output.tables import GAUGE
from psph.scene.outside import WallRegion

DRAWN = 0.01
"""Spacings behind a drawn face from which on a point of a line is within a wall."""

PER_SPACING = 4
"""Points of the line of a level in a spacing."""


def gauges_of(scene) -> dict[str, Any]:
    """Each gauge of a scene by the file of its table; beside ``mirrors`` (psph.composition.mirrors)."""
    return {GAUGE.format(name): gauge_of(scene, name, table) for name, table in scene.case.gauges.items()}


def gauge_of(scene, name: str, table):
    """The gauge of one table of ``[gauges]``: every, columns(scene) and row(simulation)."""
    asked, every = getattr(table, table.kind), table.every
    names = scene.layout.names
    match table.kind:
        case "force":
            groups = tuple(k for on in asked.on for k in groups_named(scene, on))
            return ForceGauge(name, every, groups, asked.about, _corners(scene), _carrier(asked, names))
        case "reaction":
            return ReactionGauge.of(scene, name, every, asked)
        case "level":
            parts = max(1, math.ceil(math.dist(asked.foot, asked.top) / scene.spacing * PER_SPACING - 1e-9))
            beside = _beside(scene, asked)
            buried = beside.deep(np.linspace(asked.foot, asked.top, parts + 1), DRAWN)
            line = asked.foot, asked.top, parts, _carrier(asked, names)
            return LevelGauge(name, every, *line, beside.groups, buried, _of(scene, asked))
        case "run_up":
            line = asked.foot, asked.top, scene.spacing, _up(scene), _carrier(asked, names)
            return RunUpGauge(name, every, *line, _of(scene, asked))
        case "flow":
            [axis] = (d for d, ends in enumerate(zip(asked.lower, asked.upper)) if ends[0] == ends[1])
            return FlowGauge(name, every, axis, asked.lower, asked.upper, _of(scene, asked))
        case "motion":
            return MotionGauge.of(scene, name, every, asked)
        case "joint":
            return JointGauge.of(scene, name, every, asked)
        case "displacement":
            groups = tuple(groups_named(scene, asked.of))
            return DisplacementGauge(name, every, groups, asked.at, REACH * scene.spacing)
        case "stress":
            groups = tuple(groups_named(scene, asked.of))
            keeps = any(scene.layout.parts[group].keeps_neighbours for group in groups)
            return StressGauge(name, every, groups, asked.at, REACH * scene.spacing, keeps)
        case "highest":
            within = None if asked.shape is None else Within.of(scene, asked.shape)
            return PointGauge(Front(name, AXES.index(asked.axis), _of(scene, asked), within), every)
        case "volume":
            within = Within.of(scene, asked.shape)
            return VolumeGauge(name, every, within, _carrier(asked, names), _of(scene, asked))
        case "overtopping":
            way, axis = (1 if asked.towards[0] == "+" else -1), AXES.index(asked.towards[1])
            plane, within = (axis, way, asked.at, asked.width), Within.of(scene, asked.shape)
            return OvertoppingGauge(name, every, *plane, within, _of(scene, asked))
        case "point":
            probe = FieldProbe(name, asked.position, asked.fields)
        case _:
            axis, beside = AXES.index(asked.axis), _beside(scene, asked)
            faces = (face_of(one, beside, asked, axis) for one in (scene, *scene.finer))
            if told := tuple(filter(None, faces)):
                return SensorGauge(name, every, told, _carrier(asked, names))
            points = disc(asked.position, axis, asked.diameter, scene.spacing)
            probe = FieldProbe(name, points, ("pressure",))
    carrier = _carrier(asked, names)
    return CarriedPoints(probe, every, carrier, probe.points) if carrier else PointGauge(probe, every)


def _corners(scene) -> Corners:
    """Where parts meet on which forces are measured; nowhere beside particles of several sizes, where each
    part has what its own particles bear."""
    names = {name for gauge in scene.case.gauges.values() if gauge.force for name in gauge.force.on}
    gauged = [group for group, one in enumerate(scene.species) if one.name in names]
    gauged = [] if scene.finer else gauged
    kernel, spacing = scene.kernel, scene.spacing
    crossing = seam_shares(kernel, spacing, scene.dimensions)
    return Corners(gauged, spacing, kernel.support / kernel.inverse_h, crossing)


def _up(scene) -> tuple[float, ...]:
    """The direction against gravity; without it none."""
    size = math.hypot(*scene.gravity)
    return tuple(-g / size if size else 0.0 for g in scene.gravity)


def _beside(scene, asked) -> WallRegion:
    """The walls that a gauge stands beside for good: those that carry it along, else those at rest."""
    if asked.moves_with is None:
        return WallRegion(scene)
    return WallRegion(scene, scene.species[scene.layout.names.index(asked.moves_with)].motion)


def _carrier(asked, names) -> Carrier | None:
    """What carries a gauge along, among the ``names`` of all groups."""
    return None if asked.moves_with is None else Carrier(names.index(asked.moves_with))


def _of(scene, asked) -> tuple[int, ...]:
    """The groups that a gauge of what flows counts."""
    return ALL if asked.of is None else tuple(groups_named(scene, asked.of))
