"""Ideal gases as parts of a scene."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from psph.case import Case
from psph.case.ideal_gases import IdealGas
from psph.case.keys import AXES
from psph.case.snapshots import Begun
from psph.fields import VELOCITY
from psph.particles.reach import Reach
from psph.physics.gas.state import HEAT, LENGTH, OfHeat
from psph.scene.lattice import TOLERANCE
from psph.scene.parts.part import Part

COUNTED = 8
"""Other particles by which a particle's own spacing is guessed."""

BALL = {1: 2.0, 2: math.pi, 3: 4.0 / 3.0 * math.pi}
"""Volume of a ball of 1 m in each dimension."""


class GasPart(Part):
    """An ideal gas, whose particles have sizes of their own; its table has a pressure."""

    @property
    def moves_freely(self) -> bool:
        """Yes."""
        return True

    @property
    def wave_speed(self) -> float:
        """Of sound at the start."""
        return self.table.sound_speed

    @property
    def own_sound_speed(self) -> float:
        """The same."""
        return self.table.sound_speed

    @property
    def law_key(self) -> str:
        """By its adiabatic index."""
        return f"{self.key}.gamma"

    def law(self, case: Case) -> OfHeat:
        """Its pressure comes from its heat."""
        return OfHeat(self.table.gamma)

    def reach(self, whole: Reach, spacing: float, contact: bool) -> Reach:
        """That of the scene's spacing, at the start."""
        return whole

    def quickest(self, layout: Any) -> float:
        """The largest c/h at the start, 1/s."""
        return self.wave_speed * self.finer / layout.smoothing_length

    def outside(self, layout: Any) -> Iterator[str]:
        """A line where it begins outside the domain."""
        yield from ()


def gas_part(gas: IdealGas, space) -> tuple[type[GasPart], IdealGas, dict[str, Any]]:
    """The type, the table and what else makes the part of a ``gas`` in the ``space`` of its case."""
    table = gas.settled(space)
    if gas.file is None:
        return GasPart, table, {"finer": gas.finer(space.spacing)}
    begun = gas.file.begun(space.dimensions)
    if gas.pressure is not None or gas.thermal_energy is not None:
        begun = begun._replace(thermal_energy=None)
    return GivenPart, table, {"begun": begun}


@dataclass(frozen=True)
class GivenPart(GasPart):
    """An ideal gas of the particles of a file, ``begun``; its table has a box around them."""

    begun: Begun | None = None

    one_mass: ClassVar[bool] = False
    drawn: ClassVar[bool] = False

    @property
    def wave_speed(self) -> float:
        """Of sound at the start, where that is fastest."""
        return float(self.sound.max())

    @property
    def sound(self) -> np.ndarray:
        """Speed of sound of each particle at the start (n,), m/s."""
        heat = self.begun.thermal_energy
        own = 1.0 if heat is None else np.sqrt(heat / self.table.heat)
        return self.table.sound_speed * own * np.ones(len(self.begun.mass))

    def quickest(self, layout: Any) -> float:
        """The largest c/h at the start, 1/s."""
        return float((self.sound / layout.begun[self.number][LENGTH.name]).max())

    def outside(self, layout: Any) -> Iterator[str]:
        """A line for the first of its particles that is."""
        slack, (begun, table) = TOLERANCE * layout.spacing, (self.begun, self.table)
        for d, x in enumerate(begun.position.T):
            low, up = layout.lower[d], layout.upper[d]
            for k in np.flatnonzero((x < low - slack) | (x > up + slack))[:1]:
                yield (
                    f"{self.key}.file: {table.file.file}: row {begun.row[k]} is at {AXES[d]} = {x[k]:.6g} m, "
                    f"outside the domain from {low:.6g} to {up:.6g}; change space.lower and space.upper"
                )
                return

    def claimed(self, layout: Any, grid, tolerance: float) -> np.ndarray:
        """No site."""
        return np.zeros([1] * len(grid), bool)

    def places(self, layout: Any) -> np.ndarray:
        """Those of the file, within the periods of a ``layout``."""
        return np.stack([layout.folded(d, x) for d, x in enumerate(self.begun.position.T)], axis=1)

    def particle_mass(self, cell: float, dimensions: int) -> float:
        """The mean."""
        return float(self.begun.mass.mean())

    def begins(self, layout: Any) -> dict[str, np.ndarray]:
        """Velocities, masses, heat, and a first guess of the smoothing lengths, whatever the file says of
        these."""
        found = {
            VELOCITY.name: self.begun.velocity,
            "mass": self.begun.mass,
            LENGTH.name: self.lengths(layout),
        }
        heat = self.begun.thermal_energy
        return found if heat is None else found | {HEAT.name: heat, f"predicted_{HEAT.name}": heat}

    def lengths(self, layout: Any) -> np.ndarray:
        """A first guess of the smoothing length of each particle (n,), m: η times the spacing of so many
        particles as are in the ball up to the COUNTED-th other one."""
        from scipy.spatial import cKDTree  # late: most scenes do without

        dimensions, x = layout.dimensions, layout.placed[self.number]
        counted = min(COUNTED, len(x) - 1)
        whole = layout.smoothing_length
        if not counted:
            return np.full(1, whole)
        low, periods = np.array(layout.lower), [period or 0.0 for period in layout.periods]
        tree = cKDTree(np.where(np.array(periods) > 0.0, x - low, x), boxsize=periods)
        reach = tree.query(tree.data, k=[counted + 1])[0][:, 0]
        each = reach * (BALL[dimensions] / counted) ** (1.0 / dimensions)
        return np.where(reach > 0.0, layout.case.space.smoothing * each, whole)
