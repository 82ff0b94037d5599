"""What elastic solids have planned: what they touch, where they stand, and how they step."""

import math
from functools import cached_property
from typing import Any

import numpy as np

from psph.acts import FLOWING, SOLIDS
from psph.fields import WALL
from psph.physics.solid.cracks import CUT
from psph.physics.solid.deformation import INERTIA, SMOOTHING
from psph.physics.solid.material import remembers
from psph.physics.solid.motion import MovingClamp, Riding
from psph.physics.solid.plastic import Lasting
from psph.simulation.passes import Pass, array_of, make_passes

TRUE_MASS = {"mass": INERTIA.name}
"""What contacts in a fluid see in place of the mass that solids show that."""


def pass_of_contacts(called, stored: tuple[str, ...]) -> Pass | None:
    """That of the contacts of elastic solids in a fluid; None where nothing touches."""
    own = [one for one in called if hasattr(one.effect, "push") and set(one.acts).isdisjoint(FLOWING)]
    passes = make_passes(own, stored, lambda name: TRUE_MASS.get(name, array_of(name, stored)))
    return passes[0] if passes else None


class SolidPlan:
    """What follows from a ``plan`` (psph.simulation.plan) for its elastic ``solids``
    (psph.physics.solid.material)."""

    def __init__(self, plan: Any, solids: tuple[Any, ...]):
        self._plan, self.solids = plan, solids

    @property
    def smoothing_length(self) -> float:
        """That of the solids' own kernel, m."""
        return SMOOTHING * self._plan.extremes.spacing

    @property
    def immersed(self) -> bool:
        """Whether elastic solids stand in a fluid."""
        return bool(self.solids) and self._plan.materials.flows

    @property
    def touching(self) -> bool:
        """Whether elastic solids look for each other: a pass then begins the sums of their forces."""
        return bool(self.solids and (self._plan.met if self.immersed else self._plan.passes))

    @property
    def alone(self) -> bool:
        """Whether that is the pass of all, as nothing flows."""
        return self.touching and not self.immersed

    @property
    def pressed(self) -> bool:
        """Whether elastic solids look for what moves as a whole: bodies, and walls."""
        return self.touching and any(one.kind == WALL for one in self._plan.materials.rigid)

    @property
    def riding(self) -> np.ndarray:
        """Whether the particles of each group go with a rigid body."""
        return self._plan.materials.where(lambda one: isinstance(one.motion, Riding))

    @property
    def substeps(self) -> bool:
        """Whether solids make steps of their own within one of the fluid.

        What they press or are fixed to and moves as a whole takes the steps of the fluid: beside it they
        take these too.
        """
        return self.immersed and not self.pressed and not self.riding.any()

    @property
    def contact_step(self) -> float:
        """The longest step that contacts in a fluid stand, s; infinity without."""
        effects = self._plan.met.effects if self._plan.met else ()
        return min((one.longest_step(self._plan.extremes) for one in effects), default=math.inf)

    @property
    def grips(self) -> np.ndarray:
        """Whether the particles of each group are in a clamp that moves, as it is told or with a body."""
        return self._plan.materials.where(lambda one: isinstance(one.motion, (MovingClamp, Riding)))

    @cached_property
    def laws(self) -> tuple:
        """The laws of the solids; elastic ones beside one that yields have a memory too, and leave it."""
        laws = tuple(one.law for one in self.solids)
        if not remembers(self.solids):
            return laws
        return tuple(law if hasattr(law, "flow") else Lasting(law) for law in laws)

    @property
    def cracks(self) -> bool:
        """Whether bonds of a solid may be cut."""
        return CUT.name in self._plan.arrays


def solid_plan(plan: Any) -> SolidPlan:
    """What elastic solids have planned; of a plan without them, that of none."""
    return plan.planned.get(SOLIDS) or SolidPlan(plan, ())
