"""Ideal gases of a case, and the rules between their keys."""

import math
from collections.abc import Iterator
from typing import ClassVar, Self

from psph.acts import BODIES, FLUIDS, FRAME, IDEAL_GASES, MIXED, SOILS, SOLIDS, SYMMETRY, UPDATED, speaks_for
from psph.case.findings import Finding
from psph.case.keys import key
from psph.case.matter import FreeMatter
from psph.case.schemes import GAS
from psph.physics.walls.conditions import CONDITIONS

FINEST = 16
"""Of how many parts of the scene's spacing that of a gas may be one, along an axis."""

FEWEST = 1.1
"""Least h n^(1/d): with less a particle alone has all the neighbours that are asked for."""

SAME = 1e-6
"""How near rounding has to be."""

REPELLING = ("wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic", "gaussian")
"""Kernels that fall smoothly from r = 0, so that a smoothing length is found by Newton's method."""


@speaks_for(IDEAL_GASES)
class IdealGas(FreeMatter):
    """An ideal gas, compressible: p = (γ − 1) ρ u; shocks heat it.  Not a weakly compressible fluid."""

    density: float = key("density at the start", unit="kg/m3", gt=0)
    pressure: float | None = key(
        "pressure at the start", None, unit="Pa", otherwise="that of thermal_energy", gt=0
    )
    thermal_energy: float | None = key(
        "thermal energy by mass at the start, in place of the pressure", None, unit="J/kg", gt=0
    )
    gamma: float = key("adiabatic index γ: 5/3 of one atom, 7/5 of two", 1.4, unit="1", gt=1, le=10)
    spacing: float | None = key(
        f"distance of its particles at the start, a whole part of space.spacing down to 1/{FINEST}: so gases "
        "of unlike densities have particles of one mass",
        None,
        unit="m",
        otherwise="space.spacing",
        gt=0,
    )

    viscosity: ClassVar = 0.0
    rheology: ClassVar = None
    equation_of_state: ClassVar = None
    continues: ClassVar = ""
    word: ClassVar = IDEAL_GASES
    refuses: ClassVar = {
        **{
            one: f"ideal gases push no {one} and feel none; remove one of the two"
            for one in (FLUIDS, SOILS, UPDATED, SOLIDS, BODIES)
        },
        **dict.fromkeys(
            CONDITIONS, "ideal gases feel no walls yet; remove the wall, or let the axis be periodic"
        ),
        FRAME: "ideal gases know of no frame that moves; remove one of the two",
        SYMMETRY: "ideal gases know of no mirrors yet; draw the whole scene",
        MIXED: 'ideal gases are computed in double precision, since energy is exact; use "double"',
    }

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Gases whose state or sites are not told, and what was made for others."""
        if not case.ideal_gases:
            return
        yield from _beside(case)
        space = case.space
        for name, gas in case.ideal_gases.items():
            here = ("ideal_gases", name)
            if (gas.pressure is None) == (gas.thermal_energy is None):
                says = "give pressure or thermal_energy, and not both"
                yield (*here, "pressure"), gas.pressure, says
            if isinstance(gas.velocity, str):
                yield (*here, "velocity"), gas.velocity, "no exact solution has gases; give numbers"
            finer = gas.finer(space.spacing)
            if abs(space.spacing - finer * (gas.spacing or space.spacing)) > SAME * space.spacing or (
                finer > FINEST
            ):
                fits = f"give {space.spacing / 2:g} or such"
                says = f"is no whole part of space.spacing down to 1/{FINEST}; {fits}"
                yield (*here, "spacing"), gas.spacing, says

    def finer(self, spacing: float) -> int:
        """The ``spacing`` of the scene, m, over its own: a whole number from 1 on."""
        return 1 if self.spacing is None else max(1, round(spacing / self.spacing))

    @property
    def heat(self) -> float:
        """Thermal energy by mass at the start, u = p/((γ − 1) ρ), J/kg."""
        if self.thermal_energy is not None:
            return self.thermal_energy
        return self.pressure / ((self.gamma - 1.0) * self.density)

    @property
    def sound_speed(self) -> float:
        """Of the start, √(γ (γ − 1) u), m/s."""
        return math.sqrt(self.gamma * (self.gamma - 1.0) * self.heat)

    def settled(self) -> Self:
        """The same, with the pressure that follows from the thermal energy."""
        return self.model_copy(update={"pressure": (self.gamma - 1.0) * self.density * self.heat})


def _beside(case) -> Iterator[Finding]:
    """What a case with gases has that knows nothing of them."""
    space = case.space
    if case.scheme != GAS:
        yield ("scheme",), case.scheme, f'it is not made for ideal gases; give scheme = "{GAS}"'
    if space.kernel not in REPELLING:
        yield ("space", "kernel"), space.kernel, f"not for ideal gases; give one of {', '.join(REPELLING)}"
    if space.smoothing < FEWEST:
        yield ("space", "smoothing"), space.smoothing, f"too few neighbours; give {FEWEST:g} or more"
    if space.normalised:
        yield ("space", "normalised"), True, "smoothing lengths vary; remove this key"
    if case.physics.sound_speed is not None:
        says = "ideal gases have a speed of sound of their own, by pressure and density; remove this key"
        yield ("physics", "sound_speed"), case.physics.sound_speed, says
    for table in ("regions", "probes"):
        if getattr(case, table, None):
            yield (table,), ..., f"nothing is known of {table} in ideal gases; remove the one or the other"
    for name, value in case.exact:
        if value is not None:
            yield ("exact", name), ..., "no exact solution is known of ideal gases; remove this table"
