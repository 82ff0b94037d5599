"""Rigid bodies: what they add to a scene (psph.kinds)."""

from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np

from psph.fields import Field
from psph.kinds import Kind
from psph.physics.motion import COUPLE
from psph.physics.rigid.body import RigidBody
from psph.scene.answering import answer
from psph.scene.bodies import BRAKED, body_step, braked, in_words, lightest_share
from psph.scene.body_checks import body_faults, body_warnings, period_faults
from psph.scene.body_parts import bodies_of
from psph.scene.joints import joint_words
from psph.scene.lines import line_faults, line_warnings, line_words, strung_at_start
from psph.scene.solids import meets
from psph.scene.volumes import moved_as_whole
from psph.work import Rank, Stage, Work


class RigidBodies(Kind):
    """Rigid bodies that forces move."""

    name = "bodies"

    @classmethod
    def motion_of(cls, layout, part) -> RigidBody:
        """By the mass and the inertia of its sites."""
        return moved_as_whole(layout, part)

    @classmethod
    def answer(cls, census, friction: bool) -> float:
        """By their masses and arms (psph.scene.answering)."""
        return answer(census, friction)

    @cached_property
    def longest_steps(self) -> tuple[float, float]:
        """The longest steps that they stand of one pass and of two, s."""
        return body_step(self.scene), body_step(self.scene, 2)

    @cached_property
    def share(self) -> float:
        """The least mass of one over that of the fluid beside it."""
        return lightest_share(self.scene)

    def faults(self) -> Iterator[str]:
        """Bodies that a mirror or a period does not let turn or go."""
        yield from body_faults(self.scene)
        yield from period_faults(self.scene)
        yield from line_faults(self.scene)

    def warnings(self) -> Iterator[str]:
        """Numbers of theirs that are likely a slip."""
        yield from body_warnings(self.scene)
        yield from line_warnings(self.scene)

    def curves(self) -> dict[str, np.ndarray]:
        """Chains hang."""
        return strung_at_start(self.scene)

    @property
    def fields(self) -> tuple[Field, ...]:
        """Contacts with elastic solids turn the normals of their faces, and so have a moment."""
        return (COUPLE,) if meets(self.scene) else ()

    @property
    def bears_held(self) -> bool:
        """Not light ones: friction stops them within a step or a few."""
        return self.share >= BRAKED

    @property
    def bears_midway(self) -> bool:
        """Yes."""
        return True

    def stages(self) -> Mapping[str, Stage]:
        """Their kick comes before that of the particles, with the new forces."""
        return {"kick": Stage(push_bodies, push_bodies)}

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """The longest step that they stand, beside what brakes a light body too."""
        step = self.longest_steps[plan.rate_passes - 1]
        if step < np.inf:
            yield step, "bodies"
        for call in plan.called if self.share < BRAKED else ():
            if getattr(call.effect, "brakes", False):
                yield braked(self.share, call.effect.longest_step(plan.extremes)), f"{call.title} of bodies"

    def work(self, rank: Rank) -> Iterator[Work]:
        """Their motion."""
        from psph.simulation.floating import FloatingBodies

        yield FloatingBodies(rank.scene, rank.plan)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What each is."""
        for body in bodies_of(self.scene.census):
            yield "matter", f"  body        {body.name}: {in_words(self.scene, body)}"
        for words in joint_words(self.scene):
            yield "matter", f"  joint       {words}"
        for words in line_words(self.scene):
            yield "matter", f"  line        {words}"


def push_bodies(simulation) -> None:
    """The second kick of rigid bodies, with the new forces."""
    with simulation.ledger("bodies"):
        simulation.engine.of("bodies").push(simulation.engine, simulation.then, simulation.dt)
