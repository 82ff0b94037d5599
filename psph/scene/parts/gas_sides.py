"""Sides of the domain through which a gas comes and goes."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from psph.case.keys import AXES
from psph.scene.lattice import TOLERANCE
from psph.scene.shapes import bounds


class GasSide(NamedTuple):
    """A side of the domain through which the gas of a ``group`` comes or goes.

    It is across ``axis`` at ``at`` m; ``sign`` is that of its inward direction.  What is within ``deep`` m of
    it is held: it goes as it came.  What comes does so at ``speed`` m/s, inward, in layers that are ``step``
    m apart; the speed is 0 of a side through which gas goes.
    """

    group: int
    axis: int
    at: float
    sign: int
    deep: float
    step: float
    speed: float = 0.0

    def depth(self, along: np.ndarray) -> np.ndarray:
        """How far inward of the side coordinates ``along`` its axis are, m."""
        return self.sign * (along - self.at)


def held_depth(layout: Any, part: Any) -> float:
    """How far gas is held before a side, m: what stands there is seen through, and lists others farther, by
    2^(1/d) where it has but half of its neighbours."""
    support = layout.support / part.finer
    return (1.0 + 2.0 ** (1.0 / layout.dimensions)) * support + layout.spacing / part.finer


def sides_of(layout: Any, parts: Iterable[Any]) -> tuple[GasSide, ...]:
    """Those of the gases of a scene, in order."""
    return tuple(
        _side(layout, part, told, comes)
        for part in parts
        for told, comes in ((part.table.inflow, True), (part.table.outflow, False))
        if told is not None
    )


def _side(layout: Any, part: Any, told: str, comes: bool) -> GasSide:
    axis, lower = AXES.index(told[0]), told.endswith("lower")
    at, sign = (layout.lower[axis], 1) if lower else (layout.upper[axis], -1)
    speed = sign * float(part.table.velocity[axis]) if comes else 0.0
    step = layout.spacing / part.finer
    return GasSide(part.number, axis, float(at), sign, held_depth(layout, part), step, speed)


def side_faults(layout: Any, part: Any) -> Iterator[str]:
    """A line for each side through which gas cannot come or go as it is told."""
    for name in ("inflow", "outflow"):
        told = getattr(part.table, name)
        if told is None:
            continue
        here, axis = f"{part.key}.{name}: {told}", AXES.index(told[0])
        mirrored = any(plane.axis == axis and _same(plane, told) for plane in layout.mirror_planes)
        if mirrored or layout.periods[axis] is not None:
            yield f"{here}: that side repeats or is a mirror; let it be open"
            return
    if part.table.inflow is None:
        return
    side = _side(layout, part, part.table.inflow, True)
    form = part.shape.form
    near, far = (form.lower, form.upper) if side.sign > 0 else (form.upper, form.lower)
    begins, ends = (float(side.depth(np.array(corner[side.axis]))) for corner in (near, far))
    if abs(begins) > TOLERANCE * layout.spacing:
        yield f"{part.key}.inflow: {part.table.inflow}: its box does not begin there; let it"
    elif ends < side.deep + side.step:
        least = math.ceil((side.deep + side.step) / side.step) * side.step
        yield (
            f"{part.key}.inflow: {part.table.inflow}: its box is {ends:g} m deep there, what is held before "
            f"that side takes {least:g} m; make it deeper"
        )


def side_warnings(layout: Any, part: Any) -> Iterator[str]:
    """A line for each side through which gas comes, or stands to go, slower than sound as it starts."""
    if part.table.file or part.start.flows:
        return
    velocity, sound = part.table.velocity or np.zeros(layout.dimensions), part.wave_speed
    for name, way in (("inflow", 1.0), ("outflow", -1.0)):
        told = getattr(part.table, name)
        if told is None:
            continue
        side = _side(layout, part, told, comes=False)
        corners = np.array(bounds(part.shape))[:, side.axis]
        speed = way * side.sign * float(velocity[side.axis])
        if side.depth(corners).min() < side.deep and speed < sound:
            yield (
                f"{part.key}.{name}: {told}: its speed there is {speed:.4g} m/s, that of sound {sound:.4g}: "
                "what is held before that side throws waves back; let it go faster than sound, or put the "
                "side farther away"
            )


def unheld_warnings(parts: Sequence[Any]) -> Iterator[str]:
    """A line for each gas without a side to leave through, beside one that leaves: what of it comes to that
    side is not held there."""
    sides = {part.table.outflow: part.key for part in parts if part.table.outflow}
    for part in parts:
        for told, key in sides.items():
            if part.table.outflow is None and part.table.inflow != told:
                yield (
                    f"{part.key}.outflow: {key} leaves through {told}, this gas does not: what of it comes "
                    f'there bursts into the vacuum and sends waves back; give "{told}", unless none does'
                )


def _same(plane: Any, told: str) -> bool:
    """Whether a mirror is on that side."""
    return (plane.side < 0) == told.endswith("lower")
