"""What every part of a case tells of itself, and what its species needs to know."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from psph.case import Case
from psph.case.parameters import last_part
from psph.case.shapes import Shape
from psph.fields import WALL
from psph.particles.reach import Reach
from psph.scene.shapes import Corner, bounds, inside

SHAKEN = 1.0
"""Largest random shift along each axis, in spacings, from which particles relax: from half of it they go
back to their rows."""

LOOKS = ("fluid", "wall", "elastic solid", "rigid body")
"""As what particles are shown by other programs, in the order of its numbers there."""


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
    1 for a wall, and the number of an elastic solid or a rigid body from 2 on; ``bonded`` the number of the
    total Lagrangian solid that it is of, or None; ``loaded`` whether the fluid's push on it is asked for;
    ``finer`` is the spacing of the lattice over that of its particles.
    """

    name: str
    key: str
    table: Any
    motion: Any
    number: int
    whole: int
    source: int
    solid: int = WALL
    bonded: int | None = None
    loaded: bool = False
    finer: int = 1

    flows: ClassVar[bool] = False
    """Whether it moves freely and finds its neighbours in space."""
    keeps_neighbours: ClassVar[bool] = False
    """Whether it moves freely and its neighbours are those of the start."""
    rigid: ClassVar[bool] = False
    """Whether its particles keep their places to each other, or go where the case says."""
    is_wall: ClassVar[bool] = False
    """Whether it is a wall, which may take the place of what flows."""
    bears_stress: ClassVar[bool] = False
    """Whether its deviatoric stress evolves (psph.physics.stress)."""
    keeps_form: ClassVar[bool] = False
    """Whether it keeps its form, so that it may hang, stand or fly by itself."""
    may_be_empty: ClassVar[bool] = False
    """Whether it may begin without a particle."""
    drawn: ClassVar[bool] = True
    """Whether the case draws its shape, from which another can be subtracted."""
    looks: ClassVar[str] = LOOKS[0]
    """As what it is shown."""

    @property
    def origin(self) -> int:
        """The number of the part that it is with particles of another size, else its own."""
        return self.number

    @property
    def level(self) -> int:
        """That of its particles among sizes, 0 the coarsest (psph.scene.levels)."""
        return 0

    @property
    def follows(self) -> bool:
        """Whether its particles follow those of another size, which are where they are."""
        return False

    @property
    def of_another(self) -> bool:
        """Whether it is clamped, and so a part of another."""
        return self.whole != self.number

    def borne_by(self, other: "Part") -> bool:
        """Whether another part bears it, in whose shape it may be."""
        return False

    @property
    def moves_whole(self) -> bool:
        """Whether forces move it as a whole."""
        return self.motion is None

    @property
    def shape(self) -> Shape:
        """Where it is at the start."""
        return self.table.shape

    @property
    def room(self) -> tuple[Corner, Corner]:
        """Corners of a box around it at the start, m."""
        return bounds(self.shape)

    @property
    def moves_freely(self) -> bool:
        """Whether forces move its particles one by one."""
        return self.flows or self.keeps_neighbours

    def claimed(self, layout: Any, grid: Sequence[np.ndarray], tolerance: float) -> np.ndarray:
        """True at the points of a ``grid`` that it claims in a ``layout``, as psph.scene.shapes.inside."""
        return inside(self.shape, grid, tolerance)

    def places(self, layout: Any) -> np.ndarray | None:
        """Where its particles are (n, dim), m, if they are on no sites of a ``layout``; else None."""
        return None

    def begins(self, layout: Any) -> dict[str, np.ndarray]:
        """Fields of such particles by name (n, ...), of which a table tells other numbers, or none."""
        return {}

    def particle_mass(self, cell: float, layout: Any) -> float:
        """Mass of one of its particles, kg, the mean where they differ; ``cell`` kg are in that of a site of
        a ``layout``."""
        return cell / self.finer**layout.dimensions

    @property
    def one_mass(self) -> bool:
        """Whether all its particles have one mass."""
        return True

    @property
    def fastest(self) -> float:
        """The largest speed of its start that differs by place and that no corner of a box tells, m/s."""
        return 0.0

    def flow(self, position: np.ndarray) -> np.ndarray | None:
        """What differs by place of its velocity at the start (n, dim), m/s; None: nothing does."""
        gradient = self.moves_freely and self.table.velocity_gradient
        return self.table.sheared(position) if gradient else None

    def stretched(self, position: np.ndarray) -> np.ndarray:
        """Where its particles start that would be on even places, ``position`` (n, dim), m."""
        return position

    def somewhere(self, middle: Sequence[float]) -> Sequence[float]:
        """A place where it can be, m; where it can be anywhere, the ``middle`` of the domain."""
        return middle

    @property
    def jitter(self) -> float:
        """Largest random shift of its particles along each axis at the start, in spacings."""
        return self.table.jitter

    @property
    def shake(self) -> float:
        """The same of the places that its particles get first: as told, or that from which they relax."""
        return SHAKEN if self.relaxes else self.jitter

    @property
    def relaxes(self) -> bool:
        """Whether its particles find their places before they start (psph.scene.relaxing)."""
        return False

    @property
    def fitted(self) -> bool:
        """Whether its particles stand along its faces (psph.scene.fitting)."""
        return False

    @property
    def displaces(self) -> bool:
        """Whether it takes the place of what flows."""
        return False

    @property
    def wave_speed(self) -> float:
        """Of the fastest wave that its own moduli give it, m/s; 0 where its speed of sound is chosen."""
        return 0.0

    @property
    def own_sound_speed(self) -> float | None:
        """The numerical speed of sound that the case gives it, m/s; None: that of all."""
        return None

    def reach(self, whole: Reach, spacing: float, contact: bool) -> Reach | None:
        """How far its particles feel and see others, where that is not told by other parts.

        ``whole`` is by the kernel; ``contact`` says whether the case asks for that of solids.
        """
        return whole if self.flows else None

    @property
    def wave_modulus(self) -> float:
        """Of the fastest wave of what it is made of, ρ₀ c_l² in Pa, by which contacts are stiff; 0: it has
        none."""
        return 0.0

    @property
    def rheology(self) -> Any:
        """The law of its viscosity where that depends on the rate of strain, or None."""
        return None

    def strength(self, gravity: tuple[float, ...]) -> Any:
        """The law that bounds its stress (psph.physics.stress.strength), under ``gravity`` in m/s², or
        None."""
        return None

    def law(self, case: Case):
        """Its equation of state: the one that it names, or that of all."""
        name = getattr(self.table, "equation_of_state", None) or case.physics.equation_of_state
        [law] = (entry.effect for entry in case.catalogue.states if last_part(entry) == name)
        return law()

    @property
    def may_crack(self) -> bool:
        """Whether it may get new faces."""
        return False

    @property
    def ends_kernel(self) -> bool:
        """Whether it has to be as thick as the kernel reaches, beside what flows."""
        return self.is_wall

    @property
    def law_key(self) -> str:
        """The key of the case that calls for its equation of state; empty where that is the one of all."""
        name = getattr(self.table, "equation_of_state", None)
        return f"{self.key}.equation_of_state = {name}" if name else ""

    def shown(self, known: Known) -> dict[str, Any]:
        """Of its species what others have too that continue it."""
        sound = self.own_sound_speed or known.sound_speed
        return {"density": self.table.density, "viscosity": 0.0, "wave_speed": sound, "sound_speed": sound}

    def own(self, known: Known) -> dict[str, Any]:
        """Of its species what is its own."""
        return {}
