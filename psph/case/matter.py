"""What fluids and solids have in common: where they are at the start, and how they move then."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import WrapValidator
from pydantic_core import PydanticCustomError

from psph.case.findings import Finding, Location
from psph.case.keys import Vector, key
from psph.case.placed import Placed
from psph.case.shapes import Shape
from psph.case.study import EXACT
from psph.rows import projected

RELAXED = "relaxed"
"""The start of what flows without order, but evenly crowded."""


def _velocity(value: Any, validate) -> Any:
    """One message for anything that is not a velocity; a list gets the messages of its numbers."""
    if value == [] or isinstance(value, str) and value != EXACT:
        raise PydanticCustomError("psph", 'not a velocity; give one number per dimension in m/s, or "exact"')
    return validate(value)


class FreeMatter(Placed):
    """Particles that move freely, and how they start."""

    shape: Shape = key("where it is at the start")
    velocity: Annotated[Literal[EXACT] | Vector | None, WrapValidator(_velocity)] = key(
        'velocity at the start: numbers, or "exact" (needs [exact])',
        None,
        unit="m/s",
        otherwise="zeros",
    )
    velocity_gradient: tuple[Vector, ...] | None = key(
        "gradient of the velocity at the start, one row per component: u = velocity + gradient (x - "
        "velocity_center); [[0, -1], [1, 0]] turns at 1 rad/s",
        None,
        unit="1/s",
        otherwise="zeros",
        strict=False,
        min_length=1,
    )
    velocity_center: Vector | None = key(
        "the point where velocity_gradient adds zero", None, unit="m", otherwise="zeros"
    )
    jitter: float = key(
        "largest random shift of a particle along each axis, in spacings", 0.0, unit="1", ge=0
    )
    seed: int = key("seed of the random shifts", 0, ge=0)

    def sheared(self, x: np.ndarray) -> np.ndarray:
        """What ``velocity_gradient`` adds to the velocity at ``x`` (n, dim), m/s (n, dim)."""
        return np.column_stack([projected(x - self.velocity_center, row) for row in self.velocity_gradient])


def relaxed_findings(case, here: Location, matter: Any) -> Iterator[Finding]:
    """A start of ``matter`` in another order than the lattice's where there is none, or beside what speaks of
    sites."""
    loc, start = (*here, "start"), matter.start
    if start == "lattice":
        return
    if case.space.dimensions == 1:
        yield loc, start, "a row of particles has but one even order; remove this key"
    if case.perturbations:
        yield loc, start, "perturbations name sites of the lattice; remove them, or this key"
    if matter.jitter:
        says = f'start = "{start}" has an order of its own; remove one of the two'
        yield (*here, "jitter"), matter.jitter, says
