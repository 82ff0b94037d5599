"""Water level along a line."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from psph.composition.mirrors import images
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.output.flowing import ALL, counted
from psph.output.gauges.carried import Carrier
from psph.parallel.reductions import whole_sums
from psph.smoothing import weight
from psph.vectors import add, at, dot, inside, nearest_image, scale, subtract

SURFACE = 0.5
"""Share of the kernel that lies in the fluid at a flat surface."""

LEAST_LEFT = 1.0 / 16.0
"""Share of the kernel that walls leave, half of that in a corner: with less a point is within them."""

WITHIN_WALLS = -1e12
"""In place of a share: so the line is dry up to the last point outside."""

NEITHER = -1
"""The row of what is neither fluid nor a wall that counts."""

UNIT = 2.0**40
"""Whole numbers in a share of one: the sums do not depend on the order."""


class LevelGauge(NamedTuple):
    """Water level along a line from its ``foot`` to its ``top`` (dim,) m, in so many equal ``parts``.

    The fluid's share of the kernel, S(x) = Σ_j V_j W(x − x_j) over the fluid, is ½ at a flat surface; on the
    face of a wall, on an edge and in a corner it is ½ of what the walls leave, 1 − Σ_w V_w W(x − x_w).
    ``walls`` are the groups that leave less, ``buried`` (parts + 1,) says which points lie within them and
    are dry; None: none.  ``level`` is the distance from the foot to the highest point of the line where S
    is ½ of that, ``wetted`` the length of the line with more, which is what a wire in the water measures;
    both m, 0 where all is dry.  They differ where drops or a breaking wave are above the water.  Fluids
    are those of the groups ``of``.  With a ``carrier`` the ends are those of the start.
    """

    name: str
    every: float
    foot: tuple[float, ...]
    top: tuple[float, ...]
    parts: int
    carrier: Carrier | None = None
    walls: tuple[int, ...] = ()
    buried: np.ndarray | None = None
    of: tuple[int, ...] = ALL

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return [f"{self.name}.level", f"{self.name}.wetted"]

    def row(self, simulation) -> tuple[float, float]:
        """The values, the same on every rank."""
        return surfaces(self._shares(simulation), math.dist(self.foot, self.top) / self.parts)

    def _shares(self, simulation) -> np.ndarray:
        """S over what the walls leave, at the ends of the parts of the line (parts + 1,)."""
        store, plan, domain = simulation.store, simulation.plan, simulation.domain
        ends = self._ends(simulation)
        weights = np.zeros((2, self.parts + 1), np.int64)
        part = np.where(counted(store.kinds, self.of), 0, NEITHER).astype(np.int8)
        part[list(self.walls)] = 1
        for m in range(images(plan.mirrors)):
            # An image is as far from a point as the particle from the image of the point.
            seen = (plan.mirrors.reflections[m].seen(x) if m else x for x in ends)
            foot, top = (tuple(map(float, end)) for end in seen)
            step = scale(subtract(top, foot), 1.0 / self.parts)
            radius = plan.kernel.support / plan.kernel.inverse_h
            around = (plan.kernel, domain.lower, domain.periods, store.view())
            first, last = self._near(simulation, foot, top, radius)
            seen = first, last, part[store.group[first:last]]
            for begin, end in stretches(step, self.parts, radius, domain.periods):
                start = add(foot, scale(step, float(begin))) if begin else foot
                weigh_line(start, step, radius, *around, *seen, weights[:, begin:end])
        fluid, wall = whole_sums(simulation.comm, weights).astype(np.float64) / UNIT
        left = 1.0 - wall
        share = np.where(left > LEAST_LEFT, fluid / np.maximum(left, LEAST_LEFT), 0.0)
        return share if self.buried is None else np.where(self.buried, WITHIN_WALLS, share)

    def _near(self, simulation, foot, top, radius: float) -> tuple[int, int]:
        """The first owned column, and that after the last, of all within ``radius`` m of the line."""
        axis = simulation.domain.axis
        reach = 0.5 * abs(top[axis] - foot[axis]) + radius
        return simulation.neighbourhood.columns_across(0.5 * (foot[axis] + top[axis]), reach)

    def _ends(self, simulation) -> tuple[tuple[float, ...], ...]:
        """Foot and top as they are now, m."""
        ends = (self.foot, self.top)
        if self.carrier is None:
            return ends
        return tuple(map(tuple, self.carrier.places(simulation, np.array(ends)).tolist()))


def stretches(step, parts: int, radius: float, periods) -> Iterator[tuple[int, int]]:
    """First point, and the one after the last, of stretches of a line with ``parts`` of ``step`` (dim,) m.

    Along an axis that repeats no point of a stretch is farther from its first than half a period without
    the ``radius`` of the kernel, m: what weighs there is then the same image for all of them.
    """
    rooms = ((0.5 * period - radius) / abs(s) for s, period in zip(step, periods) if period is not None and s)
    longest = 1 + math.floor(min(rooms, default=parts))
    for begin in range(0, parts + 1, longest):
        yield begin, min(begin + longest, parts + 1)


def surfaces(share: np.ndarray, step: float) -> tuple[float, float]:
    """The highest place where ``share`` (n,), at places 0, ``step`` ... m, falls below ½, and the length with
    more than that, m; between the places it is a straight line."""
    wet = share >= SURFACE
    if not wet.any():
        return 0.0, 0.0
    inside = 0.5 * step * (wet[1:].astype(float) + wet[:-1])
    for n in np.flatnonzero(wet[1:] != wet[:-1]).tolist():
        crossing = (share[n] - SURFACE) / (share[n] - share[n + 1])
        inside[n] = step * (crossing if wet[n] else 1.0 - crossing)
    highest = int(np.flatnonzero(wet)[-1])
    if highest == len(share) - 1:
        return step * highest, float(inside.sum())
    beyond = (share[highest] - SURFACE) / (share[highest] - share[highest + 1])
    return step * (highest + beyond), float(inside.sum())


@elementwise
def weigh_line(foot, step, radius, kernel, lower, periods, view, first, last, part, found):
    """Add V_j W of columns ``first`` to ``last`` to ``found`` (parts, n), at foot + n step, in UNITs.

    ``radius`` m is the support of the kernel, ``lower`` m the corner from which ``periods`` count, ``part``
    the row of each of these columns, or NEITHER.
    """
    long2 = dot(step, step)
    for k in range(np.uint64(first), np.uint64(last)):
        row = part[k - np.uint64(first)]
        if row != NEITHER:
            j = take(view, k)
            place = inside(at(view.position, k), lower, periods)
            from_foot = nearest_image(subtract(place, foot), periods)
            along = dot(from_foot, step) / long2
            aside = subtract(from_foot, scale(step, along))
            left2 = radius * radius - dot(aside, aside)
            if left2 > 0.0:
                reach = math.sqrt(left2 / long2)
                begin = max(0, int(math.ceil(along - reach)))
                end = min(found.shape[1], int(math.floor(along + reach)) + 1)
                for n in range(begin, end):
                    x = subtract(from_foot, scale(step, float(n)))
                    share = weight(kernel, math.sqrt(dot(x, x))) * j.mass * j.specific_volume
                    found[row, n] += np.int64(np.rint(share * UNIT))
