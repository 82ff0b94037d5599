"""Elastic solids, alone or in a fluid: what they add to a scene (psph.kinds)."""

from collections.abc import Container, Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from psph.acts import SOLIDS
from psph.case.updated import referred_in, updated_in
from psph.composition.loads import Pushes
from psph.composition.space import Metres
from psph.fields import FLUID, Field
from psph.kinds import Kind
from psph.particles.records import record_width
from psph.physics.solid.compression import OF_HEAT
from psph.physics.solid.contact import COVER, FACE, OF_FRICTION, REACH
from psph.physics.solid.cracks import OF_CRACKS
from psph.physics.solid.deformation import (
    DRAWN,
    KERNEL,
    OF_SOLIDS,
    PUSHED,
    SMOOTHING,
    STRESS_ZZ,
    places_of,
    support_of,
)
from psph.physics.solid.material import STEP, is_damped
from psph.physics.solid.plastic import OF_PLASTIC
from psph.physics.solid.viscous import RELAXED
from psph.scene.calming import damped_solids, solids_of
from psph.scene.faces import drawn_faces
from psph.scene.sites import sites_within
from psph.scene.solid_checks import fast_start, solid_advice, solid_faults, solid_lines, solid_warnings
from psph.scene.solids import solid_fields
from psph.simulation.solid_plan import SolidPlan, pass_of_contacts, solid_plan
from psph.work import Rank, Work

NUMBER, ROW, ENTRY = 8, 12, 4
"""Bytes of a number, of the position of a list, and of a neighbour in it."""

FLOPS = 100
"""Operations of a pair in both passes of a solid, in 2D and 3D about as many."""


class SolidMatter(Kind):
    """What elastic solids have in common, however they find their neighbours."""

    def faults(self) -> Iterator[str]:
        """Solids too thin for any stress, and clamps and loads that hold nothing."""
        yield from solid_faults(self.scene)

    def warnings(self) -> Iterator[str]:
        """Numbers of theirs that are likely a slip."""
        yield from solid_warnings(self.scene)


class UpdatedSolids(SolidMatter):
    """Elastic solids whose neighbours are those of the present: they share the pair loop with what flows, and
    their stress is that of effects (psph.physics.stress)."""

    name = "updated"

    @classmethod
    def is_in(cls, case) -> bool:
        """Where there are some."""
        return bool(updated_in(case))


class ElasticSolids(SolidMatter):
    """The elastic solids of a scene, which keep their neighbours of the start; ``immersed`` where they stand
    in a fluid."""

    name = SOLIDS
    columns = ("stored_energy",)
    pushes_within = True
    may_save = (*OF_SOLIDS, STRESS_ZZ, *OF_PLASTIC, *RELAXED, *OF_HEAT, *OF_CRACKS)

    @cached_property
    def immersed(self) -> bool:
        """Whether anything flows."""
        return any(one.kind == FLUID for one in self.scene.species)

    @classmethod
    def is_in(cls, case) -> bool:
        """Where there are some that are not updated Lagrangian."""
        return bool(referred_in(case))

    def advice(self, guard: str, suspect) -> Iterator[str]:
        """Of their steps, laws and damping; alone also of the speed of an impact."""
        yield from fast_start(self.scene) if guard == "speed" and not self.immersed else ()
        yield from solid_advice(self.scene)

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """The faces that the case draws, of what touches, and how far below these it is."""
        if FACE.name in fields:
            normal, depth = drawn_faces(self.scene.layout, species, position)
            yield FACE.name, normal
            yield COVER.name, depth[:, None]

    @classmethod
    def materials(cls, speeds) -> tuple:
        """What they are made of (psph.physics.solid.material), damped in a fluid."""
        return damped_solids(speeds)

    @property
    def made(self) -> tuple:
        """The same of this scene's."""
        return solids_of(self.scene.starts)

    @property
    def fields(self) -> tuple[Field, ...]:
        """What they carry, as they yield, crack, have loads or stand in a fluid."""
        return solid_fields(self.scene)

    @property
    def moves(self) -> bool:
        """In a fluid they make steps of their own."""
        return self.immersed

    def renews(self, passes: Sequence) -> tuple[str, ...]:
        """What contacts read of a ghost that is found anew just before they are summed, where nothing
        flows."""
        return () if self.immersed or not passes else tuple(field.name for field in (FACE, *OF_FRICTION))

    def own_pass(self, called: Sequence, stored: Sequence[str]) -> Any:
        """In a fluid that of their contacts."""
        return pass_of_contacts(called, tuple(stored)) if self.immersed else None

    def loads(self, passes: Sequence) -> Any:
        """Where nothing flows they are what pushes."""
        return None if self.immersed or not passes else Pushes

    def planned(self, plan) -> SolidPlan:
        """What they touch, and how they step."""
        return SolidPlan(plan, self.made)

    def heeds(self, plan) -> tuple:
        """Contacts, within their own steps in a fluid."""
        return plan.met.effects if plan.met and solid_plan(plan).substeps else ()

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """That of their waves, if they make no steps of their own, and without a fluid that of the largest
        acceleration."""
        own, h = solid_plan(plan), solid_plan(plan).smoothing_length
        for one in () if own.substeps else own.solids:
            yield one.longest_step(h, speed), f"waves in solids.{one.name}"
        if acceleration > 0.0 and not self.immersed:
            yield STEP * (h / acceleration) ** 0.5, "force"

    def work(self, rank: Rank) -> Iterator[Work]:
        """What each part of it does; each is imported where it is there."""
        scene, plan, store, domain, ledger = rank
        own = solid_plan(plan)
        if own.pressed:
            from psph.simulation.pressed import Pressed

            yield Pressed(scene, plan, store)
        from psph.simulation.solids import Solids

        solids, immersion = Solids(scene, plan, store, domain, ledger), None
        yield solids
        if own.immersed:
            from psph.simulation.immersion import Immersion

            immersion = Immersion(solids, scene, plan, store, domain, ledger)
            yield immersion
        if own.touching:
            from psph.simulation.solid_overlap import SolidOverlap

            yield SolidOverlap(rank, immersion)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What each is, and how they see each other and step."""
        yield from (("matter", line) for line in solid_lines(self.scene))
        yield from (("reach", line) for line in self._reach(plan))
        yield "messages", self._message(plan)
        passes = "Passes over the neighbours in the reference, two a step: deformation, then inner forces"
        yield "passes", passes
        yield from (("steps", line) for line in self._steps(plan, dt))

    def _reach(self, plan) -> Iterator[str]:
        """Their kernel, and how far they touch."""
        h, most = solid_plan(plan).smoothing_length, max(one.finer for one in self.made)
        parted = f"; as fine as {h / most:g} m" if most > 1 else ""
        neighbours = sites_within(self.scene, support_of(h))
        yield (
            f"  kernel      of solids: {KERNEL}, h = {h:g} m "
            f"(h/dx {SMOOTHING:.4g}{parted}), about {neighbours:.0f} neighbours in the reference"
        )
        if solid_plan(plan).touching:
            yield (
                f"  contact     within {REACH * self.scene.spacing:g} m of other solids and walls; lists "
                f"reach {self.scene.layout.reach.cutoff:.4g} m"
            )

    def _message(self, plan) -> str:
        """What partners on other ranks get."""
        d = self.scene.dimensions
        first, second = places_of(d, is_damped(self.made))
        return (
            f"  partners    twice a step: places, {NUMBER * (first - d)} bytes each, then what carries the "
            f"stress, {NUMBER * (second - 2 * d)} bytes each"
        )

    def _steps(self, plan, dt: float) -> Iterator[str]:
        """How many steps they take in a step of the fluid, and why."""
        own = solid_plan(plan)
        if not own.substeps:
            return
        from psph.simulation.immersion import substeps

        h, speed = own.smoothing_length, self.scene.expected_speed
        count = substeps(own.solids, h, dt, speed, own.contact_step)
        known = ((one.longest_step(h, speed), f"solids.{one.name}") for one in own.solids)
        longest, name = min([*known, (own.contact_step, "their contact")])
        yield (
            f"  solids make {count} steps in a step of {dt:.3g} s, under one push of the fluid: {name} "
            f"stands {longest:.3g} s; each is two passes over the reference and two messages to partners"
        )

    def bytes_of_particle(self, plan) -> float:
        """The records, the reference list and the row of ids."""
        entries = (
            sites_within(self.scene, support_of(solid_plan(plan).smoothing_length)) + (Metres.lanes - 1) / 2
        )
        widths = map(record_width, places_of(self.scene.dimensions, is_damped(self.made)))
        return NUMBER * sum(widths) + (ENTRY + NUMBER) * entries + ROW

    def flops(self) -> float:
        """In both passes."""
        return FLOPS

    def examples(self, plan) -> tuple:
        """Their laws, and what they have beside their stress."""
        own = solid_plan(plan)
        return (
            tuple((law, bool(one.viscosity) or None) for law, one in zip(own.laws, own.solids)),
            DRAWN.name in plan.arrays or None,
            PUSHED.name in plan.arrays or None,
            own.cracks or None,
            bool(own.grips.any()) or None,
        )

    def rehearsed(self) -> tuple[int, ...]:
        """In a fluid one of the solid too."""
        return (self.scene.layout.parts.solids[0],) if self.immersed else ()
