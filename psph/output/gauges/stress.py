"""Stress at a point of a solid or a soil."""

from typing import NamedTuple

import numpy as np

from psph.output.gauges.fit import fitted, nearest
from psph.physics.solid.deformation import STRESS, STRESS_ZZ
from psph.physics.stress.deviator import DEVIATOR


class StressGauge(NamedTuple):
    """Cauchy stress, tension positive, at a point ``at`` (dim,) in m of matter whose particles have the
    ``groups``, Pa.

    By the straight function that fits the particles within ``reach`` m (psph.output.gauges.fit).  Where the
    matter ``keeps`` its neighbours of the start, these and the point are those of the reference, so that the
    point moves with it; else it stays in space.  There σ = s − p1, in 2D with s_zz = −(s_xx + s_yy) and of
    soils with the pressure of the water in the pores.  Mean stress tr σ/3, von Mises √(3/2 s:s).
    """

    name: str
    every: float
    groups: tuple[int, ...]
    at: tuple[float, ...]
    reach: float
    keeps: bool

    def columns(self, scene) -> list[str]:
        """Their names, without the time: ``foot.stress_xx`` … ``foot.mean_stress``, ``foot.von_mises``."""
        axes = "xyz"[: scene.dimensions]
        pairs = [a + b for n, a in enumerate(axes) for b in axes[n:]] + ["zz"] * (scene.dimensions == 2)
        return [f"{self.name}.{one}" for one in (*(f"stress_{p}" for p in pairs), "mean_stress", "von_mises")]

    def row(self, simulation) -> list[float]:
        """The values, the same on every rank."""
        store = simulation.store
        chosen = store.of_groups(self.groups)
        places = store.shown("reference" if self.keeps else "position")[chosen]
        places = places if self.keeps else simulation.domain.inside(places)
        away = nearest(places - np.array(self.at), simulation.domain.periods)
        stress = fitted(simulation.comm, away, self.reach, self._of_particles(store, chosen))
        if store.dimensions == 2:
            whole = np.diag([stress[0], stress[2], stress[3]])
            whole[0, 1] = whole[1, 0] = stress[1]
        else:
            whole = np.zeros((3, 3))
            whole[np.triu_indices(3)] = whole.T[np.triu_indices(3)] = stress
        mean = np.trace(whole) / 3.0
        deviator = whole - mean * np.eye(3)
        return [*stress.tolist(), float(mean), float(np.sqrt(1.5 * (deviator**2).sum()))]

    def _of_particles(self, store, chosen: np.ndarray) -> np.ndarray:
        """σ of the particles ``own``, Pa (n, 6), in 2D xx, xy, yy and zz (n, 4)."""
        plane = store.dimensions == 2
        if self.keeps:
            parts = [store.shown(STRESS.name)[chosen]]
            return np.column_stack([*parts, store.shown(STRESS_ZZ.name)[chosen]] if plane else parts)
        s, pressure = store.shown(DEVIATOR.name)[chosen], store.shown("pressure")[chosen]
        if plane:
            s = np.column_stack([s, -(s[:, 0] + s[:, 2])])
        return s - pressure[:, None] * np.array(
            [1.0, 0.0, 1.0, 1.0] if plane else [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]
        )
