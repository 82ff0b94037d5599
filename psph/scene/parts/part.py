"""What every part of a case tells of itself, and what its species needs to know."""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from psph.case import Case
from psph.case.parameters import last_part
from psph.case.shapes import Shape
from psph.fields import WALL


class Known(NamedTuple):
    """What is known of a scene when its species are made.

    ``sound_speed`` in m/s; the laws of viscosities, ``rheologies``, and those that bound an evolved stress,
    ``strengths``; the P-wave modulus of each elastic solid in Pa, ``wave_moduli``; the extreme coordinates of
    the particles of each part in m, ``lowest`` and ``highest`` (parts, dim); ``gravity`` in m/s², and the
    ``spacing`` in m.
    """

    sound_speed: float
    rheologies: tuple[Any, ...]
    strengths: tuple[Any, ...]
    wave_moduli: tuple[float, ...]
    lowest: np.ndarray
    highest: np.ndarray
    gravity: tuple[float, ...]
    spacing: float


@dataclass(frozen=True)
class Part:
    """A table of the case that holds particles.

    ``name`` is that of its particles in frames, ``key`` where the case tells of it; ``table`` is what it
    says; ``motion`` how its particles move (psph.physics.motion), None of a body, whose mass the sites tell;
    ``number`` is its place among the parts, ``whole`` that of the part of which it is a clamp, else its own;
    ``source`` that of the part whose density and state at the start it has.  ``solid`` is 0 for what flows,
    1 for a wall, and the number of an elastic solid or a rigid body from 2 on; ``elastic`` the number of the
    total Lagrangian solid that it is of, or None; ``loaded`` whether the fluid's push on it is asked for.
    """

    name: str
    key: str
    table: Any
    motion: Any
    number: int
    whole: int
    source: int
    solid: int = WALL
    elastic: int | None = None
    loaded: bool = False

    flows: ClassVar[bool] = False
    """Whether it moves freely and finds its neighbours in space."""
    is_elastic: ClassVar[bool] = False
    """Whether it is a total Lagrangian solid, which moves freely."""
    is_clamp: ClassVar[bool] = False
    """Whether it is a clamped part of a solid."""
    is_wall: ClassVar[bool] = False
    """Whether it is a wall."""
    is_body: ClassVar[bool] = False
    """Whether it is a rigid body."""
    bears_stress: ClassVar[bool] = False
    """Whether its deviatoric stress evolves (psph.physics.stress)."""

    @property
    def shape(self) -> Shape:
        """Where it is at the start."""
        return self.table.shape

    @property
    def moves_freely(self) -> bool:
        """Whether forces move its particles one by one."""
        return self.flows or self.is_elastic

    @property
    def jitter(self) -> float:
        """Largest random shift of its particles along each axis at the start, in spacings."""
        return self.table.jitter

    @property
    def displaces(self) -> bool:
        """Whether it is a wall that takes the place of what flows."""
        return False

    def law(self, case: Case):
        """Its equation of state: the one that it names, or that of all."""
        name = getattr(self.table, "equation_of_state", None) or case.physics.equation_of_state
        [law] = (entry.effect for entry in case.catalogue.states if last_part(entry) == name)
        return law()

    def shown(self, known: Known) -> dict[str, Any]:
        """Of its species what others have too that continue it."""
        return {"density": self.table.density, "viscosity": 0.0, "wave_speed": known.sound_speed}

    def own(self, known: Known) -> dict[str, Any]:
        """Of its species what is its own."""
        return {}
