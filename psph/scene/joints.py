"""The joints of the bodies of a scene, as their steps know them."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from psph.case.joints import JointTable
from psph.physics.motion import is_rigid
from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.joints import Joint, Joints
from psph.physics.rigid.pose import in_space
from psph.scene.body_parts import bodies_of
from psph.scene.scene import Scene
from psph.scene.shapes import shown

AXES: Any = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
UP = AXES[2]


def joints_of(scene: Scene, order: Sequence[str]) -> tuple[Joint, ...]:
    """The joints of all bodies, whose rows have the names in ``order``."""
    rows, slides = {name: row for row, name in enumerate(order)}, AXES[: scene.dimensions]
    turns = AXES if scene.dimensions == 3 else (UP,)
    motions = {one.name: one.motion for one in scene.species}
    places = {one.name: one.reference for one in bodies_of(scene.census)}
    found = []
    for name, table in scene.case.joints.items():
        other, motion = rows.get(table.of[-1]), motions.get(table.of[-1])
        if len(table.of) == 1:
            other, motion = None, None
        leader = motion if other is None and motion is not None and is_rigid(motion) else None
        middles = [places[one] for one in table.of if one in rows]
        points = _points(table, places[table.of[0]], middles, scene.layout.periods)
        held = _held(table, slides, turns)
        found.append(Joint(name, rows[table.of[0]], other, leader=leader, **points, **held))
    return tuple(found)


def joint_words(scene: Scene) -> Iterator[str]:
    """What each joint is, with the numbers that are given."""
    for name, table in scene.case.joints.items():
        beside = f"{table.of[0]} and {table.of[1]}" if len(table.of) == 2 else f"{table.of[0]} and a place"
        yield ", ".join((f"{name}: {table.kind} of {beside}", *_given(getattr(table, table.kind))))


def _given(told: Any) -> Iterator[str]:
    """The keys of a kind of joint that differ from their defaults, with their values."""
    for name, field in type(told).model_fields.items():
        if (value := getattr(told, name)) != field.default:
            yield f"{name} {shown(value) if isinstance(value, tuple) else str(value).lower()}"


def apart(scene: Scene) -> frozenset[frozenset[str]]:
    """Names of bodies and walls that a joint keeps together, and that do not collide for it."""
    return frozenset(frozenset(table.of) for table in scene.case.joints.values())


def _points(table: JointTable, place, middles, periods) -> dict[str, Any]:
    """The points of both that are joined, at the start, of the images that are nearest to the ``middles`` of
    the bodies; and by how many periods, m, the two lie apart."""
    told = table.rod or table.hinge or table.ball
    at = in_space(told.at) if told is not None else place
    ends = at, in_space(table.rod.anchor) if table.rod is not None else at
    away = [beyond(end, middle, periods) for end, middle in zip(ends, [*middles, middles[0]])]
    here, there = (tuple(x - by for x, by in zip(end, far)) for end, far in zip(ends, away))
    return {"here": here, "there": there, "over": tuple(b - a for a, b in zip(*away))}


def beyond(point, middle, periods) -> tuple[float, ...]:
    """By how many whole periods a point lies beyond its image that is nearest to a middle, m."""
    pairs = zip(point, middle, (*periods, None))
    return tuple(period * round((x - m) / period) if period else 0.0 for x, m, period in pairs)


def _held(table: JointTable, slides, turns) -> dict[str, Any]:
    """What a joint forbids, and its coordinate."""
    if table.rod is not None:
        return {"length": math.dist(table.rod.at, table.rod.anchor)}
    if table.ball is not None:
        return {"slides": slides}
    if table.fixed is not None:
        return {"slides": slides, "turns": turns}
    if table.hinge is not None:
        axis = _unit(table.hinge.axis) if table.hinge.axis else UP
        tilts = _across(axis, AXES) if len(slides) == 3 else ()
        return {"slides": slides, "tilts": tilts, "axis": axis, "along": axis} | _gone(
            table.hinge, math.pi / 180.0
        )
    along = _unit(table.slider.along)
    return {
        "slides": _across(along, slides),
        "turns": turns,
        "along": along,
        "goes": True,
    } | _gone(table.slider, 1.0)


def _gone(told, unit: float) -> dict[str, Any]:
    """Limits, spring, damper and latch along a coordinate that is told in ``unit`` of m or rad."""
    lower, upper = told.limits or (-math.inf, math.inf)
    return {
        "limits": (lower * unit, upper * unit),
        "rest": told.rest * unit,
        "stiffness": told.stiffness,
        "damping": told.damping,
        "latch": told.latch,
        "restitution": told.restitution,
    }


def _unit(way) -> tuple[float, ...]:
    size = math.hypot(*way)
    return tuple(float(x) for x in np.array(in_space(tuple(way))) / size)


def _across(way, axes) -> tuple:
    """Unit vectors across a unit vector and each other, in the space of some axes."""
    found: list[np.ndarray] = [np.array(way)]
    for axis in sorted(axes, key=lambda one: abs(float(np.dot(one, way)))):
        rest = np.array(axis) - sum(np.dot(axis, one) * one for one in found)
        if np.linalg.norm(rest) > 0.1 and len(found) < len(axes):
            found.append(rest / np.linalg.norm(rest))
    return tuple(tuple(float(x) for x in one) for one in found[1:])


def joint_step(scene: Scene, bodies: Bodies) -> float:
    """The longest step that springs and dampers in joints stand, s."""
    joints = joints_of(scene, [one.name for one in bodies.bodies])
    return Joints(joints, bodies).longest_step() if joints else math.inf
