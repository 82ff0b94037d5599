"""Ideal gases of a case, and the rules between their keys."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, PlainSerializer, WrapValidator
from pydantic_core import PydanticCustomError

from psph.acts import BODIES, FLUIDS, FRAME, IDEAL_GASES, MIXED, SOILS, SOLIDS, UPDATED, speaks_for
from psph.case.findings import Finding
from psph.case.keys import AXES, SIDES, key
from psph.case.matter import RELAXED, FreeMatter, relaxed_findings
from psph.case.place_formulas import RADIUS, Formula, names_in
from psph.case.schemes import GAS
from psph.case.shapes import Shape
from psph.case.snapshots import Snapshot
from psph.physics.walls.conditions import CONDITIONS, MIRROR
from psph.theory.solutions.catalogue import is_compressible

FINEST = 16
"""Of how many parts of the scene's spacing that of a gas may be one, along an axis."""

FEWEST = 1.1
"""Least h n^(1/d): with less a particle alone has all the neighbours that are asked for."""

SAME = 1e-6
"""How near rounding has to be."""

REPELLING = ("wendland-c2", "wendland-c4", "wendland-c6", "cubic", "quintic", "gaussian")
"""Kernels that fall smoothly from r = 0, so that a smoothing length is found by Newton's method."""


HEXAGONAL = "hexagonal"

OF_SITES = ("shape", "density", "start", "stretch", "spacing", "jitter", "inflow")
"""Keys of a gas that starts on sites, and not from a file."""


def _named(value: Any) -> Any:
    """A file by its name alone."""
    return {"file": value} if isinstance(value, str) else value


def _positive(value: Any, validate) -> Any:
    """One message for what is neither a number above 0 nor a formula."""
    if not isinstance(value, (int, float, str)) or isinstance(value, bool):
        raise PydanticCustomError("psph", "neither a number nor a formula; give one of them")
    if not isinstance(value, str) and math.isnan(value):
        raise PydanticCustomError("psph", "not a number; give one above 0")
    if not isinstance(value, str) and not value > 0.0:
        raise PydanticCustomError("psph", "a number that must be above 0; give a larger one")
    return validate(value)


Positive = Annotated[float | Formula, WrapValidator(_positive)]
"""A number above 0, or a formula of place."""

OfFile = Annotated[
    Snapshot, BeforeValidator(_named), PlainSerializer(lambda snapshot: snapshot.file, return_type=str)
]
"""The particles of a file that a case names."""


@speaks_for(IDEAL_GASES)
class IdealGas(FreeMatter):
    """An ideal gas, compressible: p = (γ − 1) ρ u; shocks heat it.  Not a weakly compressible fluid."""

    shape: Shape | None = key("where it is at the start", None, otherwise="where the particles of file are")
    file: OfFile | None = key(
        "in place of a shape the particles of a file, by places, velocities, masses and heat: HDF5 like "
        "Gadget's, CSV or .npz, in the case's folder or below",
        None,
    )
    velocity: tuple[float | Formula, ...] | None = key(  # type: ignore[assignment]
        "velocity at the start: numbers, or formulas",
        None,
        unit="m/s",
        otherwise="zeros",
        strict=False,
    )
    density: Positive | None = key(
        "density at the start, or a formula of x, y, z and r, the distance from the middle of its shape, by "
        "masses that differ",
        None,
        unit="kg/m3",
        otherwise="that of the particles of file",
    )
    start: Literal["lattice", HEXAGONAL, RELAXED] = key(
        'where particles are at the start: "lattice"; "hexagonal", packed closest; or "relaxed", without '
        "order but evenly crowded, as a glass",
        "lattice",
    )
    stretch: Literal["x", "y", "z", "r"] | None = key(
        "the coordinate that density is a formula of, along which particles of one mass then stand closer: "
        "an axis of a box, or r of a disc or ball",
        None,
        otherwise="masses differ",
    )
    pressure: Positive | None = key(
        "pressure at the start, or a formula", None, unit="Pa", otherwise="that of thermal_energy, or of file"
    )
    thermal_energy: Positive | None = key(
        "thermal energy by mass at the start, in place of the pressure", None, unit="J/kg"
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

    inflow: Literal[SIDES] | None = key(
        "side of the domain through which it goes on coming in as it does at the start: numbers for density, "
        "velocity and pressure or heat, a box that begins there, on the lattice",
        None,
        otherwise="none",
    )
    outflow: Literal[SIDES] | None = key(
        "side of the domain through which it leaves, faster than sound", None, otherwise="none"
    )

    viscosity: ClassVar = 0.0
    rheology: ClassVar = None
    equation_of_state: ClassVar = None
    continues: ClassVar = ""
    word: ClassVar = IDEAL_GASES
    takes_pistons: ClassVar = True
    takes_own_steps: ClassVar = True
    refuses: ClassVar = {
        **{
            one: f"ideal gases push no {one} and feel none; remove one of the two"
            for one in (FLUIDS, SOILS, UPDATED, SOLIDS, BODIES)
        },
        **dict.fromkeys(
            (one for one in CONDITIONS if one != MIRROR),
            'ideal gases feel no walls of particles; give condition = "mirror", or let the axis be periodic',
        ),
        FRAME: "ideal gases know of no frame that moves; remove one of the two",
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
            for where, value, says in gas._of_file(space) if gas.file else gas._of_shape():
                yield (*here, *where), value, says
            for where, value, says in gas._formulas(space.dimensions):
                yield (*here, *where), value, says
            yield from relaxed_findings(case, here, gas)
            for where, value, says in gas._inflow(space.dimensions):
                yield (*here, *where), value, says
            finer = gas.finer(space.spacing)
            if gas.start == RELAXED and finer > 1:
                yield (
                    (*here, "spacing"),
                    gas.spacing,
                    'start = "relaxed" has that of space; remove one of the two',
                )
            if abs(space.spacing - finer * (gas.spacing or space.spacing)) > SAME * space.spacing or (
                finer > FINEST
            ):
                fits = f"give {space.spacing / 2:g} or such"
                says = f"is no whole part of space.spacing down to 1/{FINEST}; {fits}"
                yield (*here, "spacing"), gas.spacing, says

    def _of_shape(self) -> Iterator[Finding]:
        """What is missing or too much of a gas that starts on sites."""
        if self.shape is None:
            yield (), ..., "has no shape; give one, or the file of its particles"
        if self.density is None:
            yield ("density",), None, "is missing; give one in kg/m3"
        if (self.pressure is None) == (self.thermal_energy is None):
            yield ("pressure",), self.pressure, "give pressure or thermal_energy, and not both"

    def _of_file(self, space) -> Iterator[Finding]:
        """The same of one from a file."""
        for name in OF_SITES:
            if getattr(self, name) not in (None, 0.0, "lattice"):
                yield (name,), ..., "the file says where its particles are and how many; remove this key"
        if wrong := self.file.misfit(space.dimensions):
            yield ("file",), self.file.file, wrong
        told = [self.pressure, self.thermal_energy, self.file.begun(space.dimensions).thermal_energy]
        if all(one is None for one in told):
            says = "has no thermal energy; add it to the file, or give pressure or thermal_energy"
            yield ("file",), self.file.file, says
        if None not in told[:2]:
            yield ("pressure",), self.pressure, "give pressure or thermal_energy, and not both"

    def _formulas(self, dimensions: int) -> Iterator[Finding]:
        """Formulas of coordinates that there are not, and a stretch that does not fit."""
        velocity, known = self.velocity or (), {*AXES[:dimensions], RADIUS}
        if velocity and len(velocity) != dimensions:
            yield ("velocity",), velocity, f"{len(velocity)} numbers or formulas; give {dimensions}"
        told = {("velocity", k): one for k, one in enumerate(velocity)}
        told |= {(name,): getattr(self, name) for name in ("density", "pressure", "thermal_energy")}
        for where, value in told.items():
            for foreign in sorted(names_in(value) - known):
                yield where, value, f"there is no {foreign} in {dimensions}D; give {', '.join(sorted(known))}"
        if self.stretch is None or self.shape is None:
            return
        if names_in(self.density) != {self.stretch}:
            yield ("stretch",), self.stretch, f"needs density as a formula of {self.stretch} alone; give one"
            return
        fits = ("disc", "ball") if self.stretch == RADIUS else ("box",)
        if self.shape.is_placed or self.shape.form_name not in fits:
            says = f"moves particles within a {' or '.join(fits)} alone; give such a shape, or remove this"
            yield ("stretch",), self.stretch, says

    def _inflow(self, dimensions: int) -> Iterator[Finding]:
        """Sides that are not there, and what comes in otherwise than layer by layer, all alike."""
        told = {name: getattr(self, name) for name in ("inflow", "outflow")}
        missing = [name for name, side in told.items() if side and AXES.index(side[0]) >= dimensions]
        for name in missing:
            yield (name,), told[name], f"there is no such side in {dimensions}D; give another"
        if missing or self.inflow is None or self.shape is None:
            return
        if self.outflow == self.inflow:
            yield (
                ("outflow",),
                self.outflow,
                "is where it comes in; give another side, or remove one of the two",
            )
        axis, sign = AXES.index(self.inflow[0]), 1.0 if self.inflow.endswith("lower") else -1.0
        told = self.density, self.pressure, self.thermal_energy, *(self.velocity or ())
        along = [0.0 if isinstance(one, str) else sign * one for one in self.velocity or ()]
        if any(isinstance(one, str) for one in told) or self.velocity_gradient or self.stretch:
            yield ("inflow",), self.inflow, "comes in the same everywhere; give numbers in place of formulas"
        elif not along or along[axis] <= 0.0 or any(v for d, v in enumerate(along) if d != axis):
            says = "needs a velocity straight in through that side, above 0; give one"
            yield ("velocity",), self.velocity, says
        if self.start != "lattice" or self.jitter:
            yield ("inflow",), self.inflow, 'comes layer by layer; leave "start" and "jitter" out'
        if self.shape.is_placed or self.shape.form_name != "box":
            yield ("shape",), ..., "what comes in starts in a box; give one"

    @property
    def is_even(self) -> bool:
        """Whether all its particles have one mass."""
        return self.file is None and (self.stretch is not None or not isinstance(self.density, str))

    def finer(self, spacing: float) -> int:
        """The ``spacing`` of the scene, m, over its own: a whole number from 1 on."""
        return 1 if self.spacing is None else max(1, round(spacing / self.spacing))

    @property
    def heat(self) -> float:
        """Thermal energy by mass at the start, u = p/((γ − 1) ρ), J/kg, where it is the same everywhere."""
        if self.thermal_energy is not None:
            return self.thermal_energy
        return self.pressure / ((self.gamma - 1.0) * self.density)

    @property
    def sound_speed(self) -> float:
        """Of the start, √(γ (γ − 1) u), m/s, where that is the same everywhere."""
        return math.sqrt(self.gamma * (self.gamma - 1.0) * self.heat)


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
    if case.time.halvings and (moved := _moved_by_time(case)):
        says = f"steps of their own do not know of {moved}; remove this key, or what moves or passes there"
        yield ("time", "halvings"), case.time.halvings, says
    if getattr(case, "regions", None):
        yield ("regions",), ..., "nothing is known of regions in ideal gases; remove the one or the other"
    for name, value in case.exact:
        if value is not None and not is_compressible(name):
            yield ("exact", name), ..., "is none of ideal gases; remove this table"


def _moved_by_time(case) -> str:
    """What comes, goes or moves at the rim of gases, by its key; else empty."""
    told = [
        f"ideal_gases.{name}.{side}"
        for name, gas in case.ideal_gases.items()
        for side in ("inflow", "outflow")
        if getattr(gas, side)
    ]
    told += [f"walls.{name}.motion" for name, wall in case.walls.items() if wall.motion is not None]
    return next(iter(told), "")
