"""Run-up along a slope."""

import math
from typing import NamedTuple

import numpy as np

from psph.output.flowing import ALL, counted
from psph.output.gauges.carried import Carrier
from psph.parallel.reductions import largest

BESIDE = 2.0
"""Spacings from the line within which fluid counts: faces at an angle to the lattice are steps."""

GAP = 2.0
"""Spacings without fluid beyond which there is spray, and no longer the tongue."""


class RunUpGauge(NamedTuple):
    """How far the fluid's tongue reaches up a slope, along a line on it from ``foot`` to ``top`` (dim,) m.

    ``run_up`` is the distance along the line, m, from the foot to the last particle of the fluid beside the
    line, without a gap below it, and the half of its cell, a cube with the ``spacing``, m, as its edge: a
    film of one layer counts, spray does not.  0 where the foot is dry.  ``height`` is that of this place
    above the foot, m, along the unit vector ``up``.  Fluids are those of the groups ``of``.  With a
    ``carrier`` the ends are those of the start.
    """

    name: str
    every: float
    foot: tuple[float, ...]
    top: tuple[float, ...]
    spacing: float
    up: tuple[float, ...]
    carrier: Carrier | None = None
    of: tuple[int, ...] = ALL

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return [f"{self.name}.run_up", f"{self.name}.height"]

    def row(self, simulation) -> tuple[float, float]:
        """The values, the same on every rank."""
        ends = np.array([self.foot, self.top])
        foot, top = ends if self.carrier is None else self.carrier.places(simulation, ends)
        length = math.dist(self.foot, self.top)
        along = (top - foot) / length
        store = simulation.store
        counting = counted(store.kinds, self.of)[store.shown("group")]
        away = simulation.domain.inside(store.shown("position")[counting]) - 0.5 * (foot + top)
        for axis, period in enumerate(simulation.domain.periods):
            if period is not None:
                away[:, axis] -= period * np.rint(away[:, axis] / period)
        distance = away @ along
        aside = np.linalg.norm(away - distance[:, None] * along, axis=1)
        reached = distance[aside < BESIDE * self.spacing] + 0.5 * length
        half = 0.5 * self.spacing * np.abs(along).sum()
        tip = tongue(self._farthest(simulation.comm, reached, length), GAP * self.spacing)
        run_up = min(tip + half, length) if tip > -np.inf else 0.0
        return run_up, run_up * float(along @ np.array(self.up))

    def _farthest(self, comm, reached: np.ndarray, length: float) -> np.ndarray:
        """The largest of the distances ``reached``, m, in each half spacing of the line, −inf where there is
        none."""
        part = 0.5 * self.spacing
        farthest = np.full(math.ceil(length / part) + 2, -np.inf)
        place = np.floor(reached / part).astype(np.int64) + 1  # the first is before the foot
        here = (place >= 0) & (place < len(farthest))
        np.maximum.at(farthest, place[here], reached[here])
        return largest(comm, farthest)


def tongue(farthest: np.ndarray, gap: float) -> float:
    """The last particle of the fluid that begins at the foot and has no gap, m; −inf where there is none.

    ``farthest`` are distances from the foot in order, −inf where there is nothing.
    """
    end, below = -np.inf, 0.0
    for distance in farthest[np.isfinite(farthest)].tolist():
        if distance - below > gap:
            break
        end = below = distance
    return end
