"""What a plan says of its elastic solids: what they touch, where they stand, and how they step."""

import math
from functools import cached_property
from typing import Any

from psph.fields import WALL
from psph.kinds import Kind
from psph.physics.motion import MovingClamp
from psph.physics.solid.cracks import CUT
from psph.physics.solid.deformation import SMOOTHING
from psph.physics.solid.material import remembers
from psph.physics.solid.plastic import Lasting
from psph.simulation.materials import Materials
from psph.simulation.passes import Pass


class OfSolids:
    """The part of a plan (psph.simulation.plan) that follows from its elastic solids."""

    materials: Materials
    arrays: tuple[str, ...]
    passes: tuple[Pass, ...]
    met: Pass | None
    matter: tuple[Kind, ...]
    extremes: Any

    def of(self, name: str) -> Any:
        """The kind of matter of that name, or None."""
        return next((kind for kind in self.matter if kind.name == name), None)

    @cached_property
    def solids(self) -> tuple[Any, ...]:
        """The elastic solids (psph.physics.solid.material)."""
        kind = self.of("solids")
        return kind.made if kind else ()

    @property
    def solid_smoothing_length(self) -> float:
        """That of the solids' own kernel, m."""
        return SMOOTHING * self.extremes.spacing

    @property
    def immersed(self) -> bool:
        """Whether elastic solids stand in a fluid."""
        return bool(self.solids) and self.materials.flows

    @property
    def touching(self) -> bool:
        """Whether elastic solids look for each other: a pass then begins the sums of their forces."""
        return bool(self.solids and (self.met if self.immersed else self.passes))

    @property
    def alone(self) -> bool:
        """Whether that is the pass of all, as nothing flows."""
        return self.touching and not self.immersed

    @property
    def pressed(self) -> bool:
        """Whether elastic solids look for what moves as a whole: bodies, and walls."""
        return self.touching and any(one.kind == WALL for one in self.materials.rigid)

    @property
    def substeps(self) -> bool:
        """Whether solids make steps of their own within one of the fluid.

        What they press and moves as a whole takes the steps of the fluid: beside it they take these too.
        """
        return self.immersed and not self.pressed

    @property
    def contact_step(self) -> float:
        """The longest step that contacts in a fluid stand, s; infinity without."""
        effects = self.met.effects if self.met else ()
        return min((one.longest_step(self.extremes) for one in effects), default=math.inf)

    @property
    def grips(self) -> tuple[Any, ...]:
        """The motions of clamps that move, among those that are rigid."""
        return tuple(one for one in self.materials.rigid if isinstance(one, MovingClamp))

    @cached_property
    def solid_laws(self) -> tuple:
        """The laws of the solids; elastic ones beside one that yields have a memory too, and leave it."""
        laws = tuple(one.law for one in self.solids)
        if not remembers(self.solids):
            return laws
        return tuple(law if hasattr(law, "flow") else Lasting(law) for law in laws)

    @property
    def cracks(self) -> bool:
        """Whether bonds of a solid may be cut."""
        return CUT.name in self.arrays
