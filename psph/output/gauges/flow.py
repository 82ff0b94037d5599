"""Flow through a section."""

from typing import NamedTuple

import numpy as np

from psph.output.flowing import ALL, counted
from psph.parallel.reductions import exact_sums
from psph.smoothing import kernel, weight


class FlowGauge(NamedTuple):
    """Flow of the fluid through a section across an ``axis``, positive along it.

    Q = Σ_j V_j u_j W(d_j) over the fluid particles j before and behind the section, with the velocity
    u_j along the axis, the distance d_j from the section and the kernel W of one dimension, ∫W dd = 1;
    Q_m the same with masses.  ``lower`` and ``upper`` (dim,) m are its corners, also across a seam.
    Fluids are those of the groups ``of``.  m³/s and kg/s; per metre of depth in 2D.
    """

    name: str
    every: float
    axis: int
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    of: tuple[int, ...] = ALL

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return [f"{self.name}.flow", f"{self.name}.mass_flow"]

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        store, plan = simulation.store, simulation.plan
        across = kernel("wendland-c2", plan.smoothing_length, 1)
        x = simulation.domain.inside(store.shown("position"))
        away = x[:, self.axis] - self.lower[self.axis]
        period = simulation.domain.periods[self.axis]
        if period is not None:
            away -= period * np.rint(away / period)
        others = [d for d in range(x.shape[1]) if d != self.axis]
        within = np.abs(away) < across.support * plan.smoothing_length
        for d in others:
            past = x[:, d] - self.lower[d]
            if (repeats := simulation.domain.periods[d]) is not None:
                past -= repeats * np.floor(past / repeats)
            within &= (past >= 0.0) & (past < self.upper[d] - self.lower[d])
        within &= counted(store.kinds, self.of)[store.shown("group")]
        shares = np.array([weight(across, abs(d)) for d in away[within].tolist()])
        mass = store.shown("mass")[within] * store.shown("velocity")[within, self.axis] * shares
        return exact_sums(simulation.comm, np.column_stack([mass / store.shown("density")[within], mass]))
