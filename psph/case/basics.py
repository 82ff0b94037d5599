"""What every case has before its matter: its names, its space and time, and what acts in it."""

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from pydantic import Strict

from psph.case.keys import SIDES, Axis, Table, Text, Vector, key
from psph.case.physics import physics_table
from psph.case.profiles import PROFILES
from psph.case.refined import Refined
from psph.case.schemes import SCHEMES, STABLE
from psph.smoothing import KERNELS

if TYPE_CHECKING:  # made from the catalogue of effects
    Physics: TypeAlias = Any
else:
    Physics = physics_table()


ROUNDING = 1e-6
"""Of a spacing."""


class Space(Table):
    """Dimensions, resolution and extent."""

    dimensions: int = key("number of dimensions, 1 to 3", ge=1, le=3)
    spacing: float = key("distance between particles at the start", unit="m", gt=0)
    smoothing: float = key(
        "smoothing length h in units of the spacing, h/dx",
        1.4,
        unit="1",
        ge=0.6,
        le=4,
    )
    kernel: Literal[tuple(KERNELS)] = key("smoothing kernel", next(iter(KERNELS)))
    normalised: bool = key(
        "divide the kernel gradient by its first moment on the initial lattice",
        False,
    )
    periodic: Annotated[tuple[Axis, ...], Strict(False)] = key("periodic axes", ())
    symmetry: Annotated[tuple[Literal[SIDES], ...], Strict(False)] = key(
        "sides of the domain that are planes of symmetry: the flow before one is mirrored behind it", ()
    )
    lower: Vector | None = key(
        "lowest corner of the domain; required where an axis is periodic or has a plane of symmetry",
        None,
        unit="m",
        otherwise="found from the shapes",
    )
    upper: Vector | None = key(
        "highest corner of the domain; required where an axis is periodic or has a plane of symmetry",
        None,
        unit="m",
        otherwise="found from the shapes",
    )
    refine: Annotated[tuple[Refined, ...], Strict(False)] = key(
        "regions whose fluid and walls have a finer spacing", ()
    )
    origin: Vector | None = key(
        "origin of the lattice: particles start at origin + (k + 1/2) spacing, k whole",
        None,
        unit="m",
        otherwise="zeros",
    )

    @property
    def finest(self) -> float:
        """The smallest spacing of any region, m."""
        return self.spacing / max((one.factor for one in self.refine), default=1)

    @property
    def layers(self) -> int:
        """Rows of particles over which the kernel of one at a face reaches."""
        smooths: Any = KERNELS[self.kernel]
        return math.ceil(smooths.support * self.smoothing - ROUNDING)


class Time(Table):
    """Simulated time and time steps."""

    end: float = key("simulated time at which the run ends", unit="s", gt=0)
    cfl: float = key(
        "time step in units of h/(c + largest speed), for each of its passes", 0.2, unit="1", gt=0, le=0.5
    )
    passes: Literal[1, 2, "auto"] = key(
        "passes over the neighbours that a step takes: one for all rates, or one for the rate of density at "
        "half of the step and one for forces at its end, where all that is in the scene bears it; auto: two "
        "where steps are that much longer by it",
        1,
    )
    lead: float = key(
        "in two passes: pressures are those of the densities so many steps later, by which sound fades",
        0.0,
        unit="steps",
        ge=0,
        le=0.1,
    )
    gather_every: int = key(
        "corrected gradients and other slow sums are renewed every so many passes", 1, ge=1
    )
    damping_every: int = key(
        "rates of friction, of the pair potential and of summed density serve for so many passes", 1, ge=1
    )
    halvings: int = key(
        "how often the longest step of a gas is halved where it begins: each particle takes its own step, as "
        "long as it and its neighbours bear; 0: all take the shortest",
        0,
        ge=0,
        le=10,
    )
    step: float | None = key("a fixed time step", None, unit="s", otherwise="chosen in each step", gt=0)


class Basics(Table):
    """The first keys of a case."""

    title: Text = key("title of the case, one line", "")
    use: Annotated[tuple[Text, ...], Strict(False)] = key(
        "Python files in the folder of the case or below that bring effects, motions or regions", ()
    )
    scheme: Literal[tuple(SCHEMES)] = key(
        "stable: the default; sph: plain SPH; ssph: the paper's; solid: for updated Lagrangian solids; "
        "gas: for ideal gases; for keys that the case does not give",
        STABLE,
    )
    profile: Literal[tuple(PROFILES)] | None = key(
        "changes of the default scheme by one name", None, otherwise="no profile"
    )
    precision: Literal["double", "mixed"] = key(
        "mixed: pairs in single precision, particles and time integration in double", "double"
    )
    space: Space = key("dimensions, resolution and extent")
    time: Time = key("simulated time and time steps")
    physics: Physics = key("forces and other effects on the fluids", make=Physics)
