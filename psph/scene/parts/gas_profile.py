"""How an ideal gas starts from place to place: by the numbers and the formulas of its table."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from psph.case.forms import Box
from psph.case.ideal_gases import IdealGas
from psph.case.keys import AXES
from psph.case.place_formulas import RADIUS, at_places
from psph.case.shapes import Shape
from psph.case.snapshots import Begun
from psph.scene.lattice import TOLERANCE, lattice_around
from psph.scene.shapes import bounds, inside, shown

SAMPLES = 1_000_000
"""Sites at which a formula is looked at, at the most."""

PIECES = 4096
"""Of the way along which particles are moved to where a formula of the density has them."""


@dataclass(frozen=True, eq=False)
class GasProfile:
    """The start of a ``gas`` between the corners ``lower`` and ``upper`` of its shape, m, at places (n, dim).

    ``sites`` (n, dim) m are some of its own.  Of a file the table has mean numbers where the file has others.
    """

    gas: IdealGas
    lower: np.ndarray
    upper: np.ndarray
    sites: np.ndarray

    @classmethod
    def of(cls, gas: IdealGas, space) -> "GasProfile":
        """That of a gas with a shape in the ``space`` of its case; of many sites some are looked at."""
        lower, upper = map(np.array, bounds(gas.shape))
        spacing = space.spacing
        while np.prod((upper - lower) / spacing) > SAMPLES:
            spacing *= 2.0
        lattice = lattice_around([(tuple(lower), tuple(upper))], space.origin, spacing, None)
        grid, form = lattice.grid(0, lattice.planes), lattice.shape(0, lattice.planes)
        held = np.broadcast_to(inside(gas.shape, grid, TOLERANCE * spacing), form)
        sites = np.stack([np.broadcast_to(x, form)[held] for x in grid], axis=1)
        return cls(gas, lower, upper, sites if len(sites) else 0.5 * (lower + upper)[None])

    @classmethod
    def of_file(cls, gas: IdealGas, begun: Begun, spacing: float) -> "GasProfile":
        """That of a gas from a file, in a box around its particles half a ``spacing`` wider, m."""
        lower, upper = begun.ends(spacing)
        mass, told = float(begun.mass.sum()), {"shape": Shape(box=Box(lower=lower, upper=upper))}
        told["density"] = mass / math.prod(up - low for low, up in zip(lower, upper))
        if begun.thermal_energy is not None:
            told["thermal_energy"] = float(begun.mass @ begun.thermal_energy) / mass
        return cls(gas.model_copy(update=told), np.array(lower), np.array(upper), begun.position)

    @property
    def middle(self) -> np.ndarray:
        """Of its shape, m: where r is 0."""
        return 0.5 * (self.lower + self.upper)

    def density(self, x: np.ndarray) -> np.ndarray:
        """ρ, kg/m^d."""
        return self._at(self.gas.density, x)

    def pressure(self, x: np.ndarray) -> np.ndarray:
        """p, Pa: as it is told, or (γ − 1) ρ u."""
        if self.gas.pressure is not None:
            return self._at(self.gas.pressure, x)
        return (self.gas.gamma - 1.0) * self.density(x) * self._at(self.gas.thermal_energy, x)

    def heat(self, x: np.ndarray) -> np.ndarray:
        """u, J/kg: as it is told, or by the pressure."""
        if self.gas.thermal_energy is not None:
            return self._at(self.gas.thermal_energy, x)
        return self.pressure(x) / ((self.gas.gamma - 1.0) * self.density(x))

    def velocity(self, x: np.ndarray) -> np.ndarray:
        """v (n, dim), m/s, without what velocity_gradient adds."""
        return np.stack([self._at(one, x) for one in self.gas.velocity], axis=1)

    def stretched(self, x: np.ndarray) -> np.ndarray:
        """Where the particles of even places ``x`` are so that equal masses have the density."""
        along = self.gas.stretch
        if along is None:
            return x
        cut, share = self._shares
        if along == RADIUS:
            away = x - self.middle
            r = np.sqrt((away**2).sum(axis=1))
            new = np.interp((r / cut[-1]) ** x.shape[1], share, cut)
            return self.middle + away * np.divide(new, r, out=np.ones_like(r), where=r > 0.0)[:, None]
        d, found = AXES.index(along), x.copy()
        found[:, d] = np.interp((x[:, d] - cut[0]) / (cut[-1] - cut[0]), share, cut)
        return found

    @cached_property
    def mean_density(self) -> float:
        """Over the shape, kg/m^d: of its sites, of a stretch exactly."""
        return self._mass_of_stretch[-1] if self.gas.stretch else float(self.density(self.sites).mean())

    @cached_property
    def fastest_sound(self) -> float:
        """The fastest sound, m/s."""
        return float(np.sqrt(self.gas.gamma * (self.gas.gamma - 1.0) * self.heat(self.sites)).max())

    @cached_property
    def fastest(self) -> float:
        """The largest speed by formulas, m/s."""
        return float(np.sqrt((self.velocity(self.sites) ** 2).sum(axis=1)).max()) if self.flows else 0.0

    @property
    def flows(self) -> bool:
        """Whether its velocity has formulas."""
        return any(isinstance(one, str) for one in self.gas.velocity)

    def settled(self) -> IdealGas:
        """The table of the gas with numbers in place of formulas: means, and no velocity."""
        gas, told = self.gas, {}
        if isinstance(gas.density, str):
            told["density"] = self.mean_density
        for name in ("pressure", "thermal_energy"):
            if isinstance(getattr(gas, name), str):
                told[name] = float(self._at(getattr(gas, name), self.sites).mean())
        if self.flows:
            told["velocity"] = (0.0,) * len(gas.velocity)
        known = gas.model_copy(update=told)
        return known.model_copy(update={"pressure": (gas.gamma - 1.0) * known.density * known.heat})

    def faults(self) -> Iterator[tuple[str, str]]:
        """Keys of formulas without a value somewhere, and why."""
        for name in ("density", "pressure", "thermal_energy"):
            value = getattr(self.gas, name)
            if isinstance(value, str):
                yield from self._fault(name, value, self._at(value, self.sites), " above 0")
        for k, value in enumerate(self.gas.velocity):
            if isinstance(value, str):
                yield from self._fault(f"velocity[{k}]", value, self._at(value, self.sites), "")

    def _fault(self, name: str, formula: str, found: np.ndarray, above: str) -> Iterator[tuple[str, str]]:
        bad = np.flatnonzero(~(np.isfinite(found) & ((found > 0.0) | (not above))))
        if len(bad):
            at = shown(self.sites[bad[0]])
            yield (
                name,
                f'"{formula}" is {found[bad[0]]:g} at {at}; give a formula that is a number{above} there',
            )

    def _at(self, value, x: np.ndarray) -> np.ndarray:
        return at_places(value, x, self.middle)

    @cached_property
    def _shares(self) -> tuple[np.ndarray, np.ndarray]:
        """Cuts along the way of the stretch, m, and which part of the mass is before each."""
        cut, mass, _ = self._mass_of_stretch
        return cut, mass / mass[-1]

    @cached_property
    def _mass_of_stretch(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Cuts along the way, m, the mass before each by the area across, and the mean density, kg/m^d."""
        dimensions, along = len(self.lower), self.gas.stretch
        radial = along == RADIUS
        d = 0 if radial else AXES.index(along)
        begin = self.middle[d] if radial else self.lower[d]
        cut = np.linspace(begin, self.upper[d], PIECES + 1)
        places = np.tile(self.middle, (PIECES, 1))
        places[:, d] = 0.5 * (cut[1:] + cut[:-1])
        way = cut - begin if radial else cut
        volume = np.diff(way**dimensions) if radial else np.diff(way)
        mass = np.concatenate([[0.0], np.cumsum(self.density(places) * volume)])
        return way, mass, float(mass[-1] / volume.sum())
