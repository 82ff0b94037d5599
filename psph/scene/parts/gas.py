"""Ideal gases as parts of a scene."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from psph.case import Case, CaseError
from psph.case.ideal_gases import HEXAGONAL, IdealGas
from psph.case.keys import AXES
from psph.case.matter import RELAXED
from psph.case.snapshots import Begun
from psph.fields import VELOCITY
from psph.particles.reach import Reach
from psph.physics.gas.state import HEAT, LENGTH, OfHeat
from psph.scene.hexagonal import sites_of, steps_of
from psph.scene.lattice import TOLERANCE
from psph.scene.parts.gas_profile import GasProfile
from psph.scene.parts.gas_sides import side_faults
from psph.scene.parts.part import Part
from psph.scene.shapes import Corner

COUNTED = 8
"""Other particles by which a particle's own spacing is guessed."""

FAR = 20.0
"""Smoothing length over the middle one of a particle that stands far from all others."""

HEAVY = 1e4
"""The largest over the smallest mass of a file's particles that is worth a word."""

UNLIKE = 2.0
"""The usual distance of particles over ``space.spacing``, or the other way round, that is worth a word."""

BALL = {1: 2.0, 2: math.pi, 3: 4.0 / 3.0 * math.pi}
"""Volume of a ball of 1 m in each dimension."""


@dataclass(frozen=True)
class GasPart(Part):
    """An ideal gas, whose particles have sizes of their own; its table has a pressure, and numbers in place
    of the formulas of its ``start``."""

    start: GasProfile | None = None

    @property
    def moves_freely(self) -> bool:
        """Yes."""
        return True

    @property
    def one_mass(self) -> bool:
        """Unless its density differs on even sites."""
        return not isinstance(self.start.gas.density, str) or self.start.gas.stretch is not None

    @property
    def wave_speed(self) -> float:
        """Of sound at the start, where that is fastest."""
        return self.start.fastest_sound

    @property
    def own_sound_speed(self) -> float:
        """Of sound at the start, the mean."""
        return self.table.sound_speed

    @property
    def fastest(self) -> float:
        """By formulas."""
        return self.start.fastest

    def flow(self, position: np.ndarray) -> np.ndarray | None:
        """By formulas too."""
        more = super().flow(position)
        if not self.start.flows:
            return more
        return self.start.velocity(position) + (0.0 if more is None else more)

    @property
    def even(self) -> bool:
        """Whether it starts on a lattice, the same everywhere."""
        known = self.table.start, self.table.stretch, self.table.file, self.table.jitter
        return known == ("lattice", None, None, 0.0) and self.one_mass

    @property
    def relaxes(self) -> bool:
        """As its table says."""
        return self.table.start == RELAXED

    def places(self, layout: Any) -> np.ndarray | None:
        """Those of the closest packing, where it starts so."""
        if self.table.start != HEXAGONAL:
            return None
        return sites_of(layout, self.number, layout.spacing / self.finer)

    def particle_mass(self, cell: float, layout: Any) -> float:
        """By the volume that a particle has."""
        if self.table.start != HEXAGONAL:
            return super().particle_mass(cell, layout)
        volume = math.prod(steps_of(layout, layout.spacing / self.finer))
        return cell * volume / layout.spacing**layout.dimensions

    def somewhere(self, middle: Sequence[float]) -> Sequence[float]:
        """At one of its sites."""
        return self.start.sites[0].tolist()

    def stretched(self, position: np.ndarray) -> np.ndarray:
        """Where equal masses have the density."""
        return self.start.stretched(position)

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

    def guessed(self, layout: Any) -> np.ndarray:
        """First guesses of smoothing lengths (n,), m."""
        return np.array([layout.smoothing_length / self.finer])

    def stragglers(self, layout: Any) -> Iterator[str]:
        """Lines on a particle far from all others, on spacings and on masses that differ much."""
        yield from ()

    def faults(self, layout: Any) -> Iterator[str]:
        """Sides through which it cannot come or go."""
        yield from side_faults(layout, self)


def gas_part(case: Case, key: str, gas: IdealGas) -> tuple[type[GasPart], IdealGas, dict[str, Any]]:
    """The type, the table and what else makes the part of a ``gas`` at a ``key`` of its case.

    Raises CaseError with a line for each formula without a value somewhere.
    """
    space = case.space
    if gas.file is None:
        start = _sound(case, key, GasProfile.of(gas, space))
        return GasPart, start.settled(), {"finer": gas.finer(space.spacing), "start": start}
    begun = gas.file.begun(space.dimensions)
    if gas.pressure is not None or gas.thermal_energy is not None:
        begun = begun._replace(thermal_energy=None)
    start = _sound(case, key, GasProfile.of_file(gas, begun, space.spacing))
    return GivenPart, start.settled(), {"begun": begun, "start": start}


def _sound(case: Case, key: str, start: GasProfile) -> GasProfile:
    if wrong := [f"{case.file}: {key}.{name}: {says}" for name, says in start.faults()]:
        raise CaseError(wrong)
    return start


@dataclass(frozen=True)
class GivenPart(GasPart):
    """An ideal gas of the particles of a file, ``begun``; its table has a box around them."""

    begun: Begun | None = None

    drawn: ClassVar[bool] = False

    @property
    def room(self) -> tuple[Corner, Corner]:
        """Around its particles."""
        return self.begun.ends(0.0)

    @property
    def one_mass(self) -> bool:
        """No."""
        return False

    @property
    def wave_speed(self) -> float:
        """Of sound at the start, where that is fastest."""
        return float(self.sound.max())

    @property
    def fastest(self) -> float:
        """Of its particles."""
        return super().fastest + float(np.sqrt((self.begun.velocity**2).sum(axis=1)).max())

    @property
    def sound(self) -> np.ndarray:
        """Speed of sound of each particle at the start (n,), m/s."""
        heat, gamma = self.begun.thermal_energy, self.table.gamma
        heat = self.start.heat(self.begun.position) if heat is None else heat
        return np.sqrt(gamma * (gamma - 1.0) * heat)

    def quickest(self, layout: Any) -> float:
        """The largest c/h at the start, 1/s."""
        return float((self.sound / self.guessed(layout)).max())

    def guessed(self, layout: Any) -> np.ndarray:
        """Of each particle."""
        return layout.begun[self.number][LENGTH.name]

    def stragglers(self, layout: Any) -> Iterator[str]:
        """The particle that reaches much farther than most; a usual distance unlike the scene's spacing; and
        masses that differ much."""
        lengths = self.guessed(layout)
        k, most = int(lengths.argmax()), float(np.median(lengths))
        apart = most / layout.smoothing_length
        if not 1.0 / UNLIKE < apart < UNLIKE:
            mean = f"{apart * layout.spacing:.3g} m"
            yield (
                f"{self.key}.file: {self.table.file.file}: its particles are about {mean} apart, and "
                f"space.spacing is {layout.spacing:g} m; give {mean}, or pictures and forecasts are off"
            )
        mass = self.begun.mass
        if mass.max() > HEAVY * mass.min():
            row, ends = self.begun.row[int(mass.argmax())], f"{mass.min():.3g} to {mass.max():.3g} kg"
            yield (
                f"{self.key}.file: {self.table.file.file}: masses from {ends}, the largest in row {row}: "
                "light particles beside heavy ones are thrown about; make them more alike"
            )
        if lengths[k] > FAR * most:
            yield (
                f"{self.key}.file: {self.table.file.file}: row {self.begun.row[k]} stands so far from others "
                f"that its smoothing length is about {lengths[k]:.3g} m, most have {most:.3g} m: planes are "
                "as wide as it reaches, so that few ranks share the run; leave it out, or run on few"
            )

    def faults(self, layout: Any) -> Iterator[str]:
        """A line for the first of its particles outside the domain."""
        yield from super().faults(layout)
        slack, begun = TOLERANCE * layout.spacing, self.begun
        for d, x in enumerate(begun.position.T):
            low, up = layout.lower[d], layout.upper[d]
            for k in np.flatnonzero((x < low - slack) | (x > up + slack))[:1]:
                at = f"row {begun.row[k]} is at {AXES[d]} = {x[k]:.6g} m"
                yield (
                    f"{self.key}.file: {self.table.file.file}: {at}, "
                    f"outside the domain from {low:.6g} to {up:.6g}; change space.lower and space.upper"
                )
                return

    def claimed(self, layout: Any, grid, tolerance: float) -> np.ndarray:
        """No site."""
        return np.zeros([1] * len(grid), bool)

    def places(self, layout: Any) -> np.ndarray:
        """Those of the file, within the periods of a ``layout``."""
        return np.stack([layout.folded(d, x) for d, x in enumerate(self.begun.position.T)], axis=1)

    def particle_mass(self, cell: float, layout: Any) -> float:
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
