"""Walls: what they add to a scene (psph.kinds)."""

from collections.abc import Container, Iterator, Mapping
from functools import cached_property

import numpy as np

from psph.case.keys import AXES
from psph.kinds import Kind
from psph.physics.motion import deforms
from psph.physics.rigid.absorption import Absorbing
from psph.physics.stress.faces import DRAWN, DRAWN_SIDE, EDGE, NORMAL, SIDE
from psph.scene.motion_checks import motion_faults, motion_lines
from psph.scene.smooth import smooth_faces
from psph.scene.waving import wave_lines
from psph.work import Rank, Stage, Work


class Walls(Kind):
    """All that moves as it is told, or not at all; a frame that moves, and mirrors."""

    name = "walls"

    @cached_property
    def absorbs(self) -> bool:
        """Whether paddles answer to the water before them."""
        return any(isinstance(one.motion, Absorbing) for one in self.scene.species)

    @classmethod
    def is_in(cls, case) -> bool:
        """Every scene has room for them: mirrors, frames and clamps move as they are told too."""
        return True

    def faults(self) -> Iterator[str]:
        """Motions that leave what numbers can tell."""
        yield from motion_faults(self.scene)

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """The faces of smooth ones, along which soils and solids slide."""
        if NORMAL.name in fields:
            normal, side, edge = smooth_faces(self.scene, species, position)
            of = {NORMAL: normal, SIDE: side, EDGE: edge, DRAWN: normal, DRAWN_SIDE: side}
            yield from ((field.name, value) for field, value in of.items() if field.name in fields)

    @property
    def bears_midway(self) -> bool:
        """Yes."""
        return True

    def stages(self) -> Mapping[str, Stage]:
        """Paddles answer to the level at the end of the step, after the kick."""
        return {"find_limits": Stage(measure_levels, measure_levels)} if self.absorbs else {}

    def work(self, rank: Rank) -> Iterator[Work]:
        """Paddles that answer to the water before them."""
        if self.absorbs:
            from psph.simulation.paddles import Paddles

            yield Paddles(rank.scene, rank.plan)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """How they move, and where mirrors stand."""
        yield from (("matter", line) for line in self._matter())

    def _matter(self) -> Iterator[str]:
        scene = self.scene
        yield from motion_lines(scene)
        yield from wave_lines(scene)
        for part, one in zip(scene.layout.parts, scene.species):
            if not part.level and deforms(one.motion):
                does = type(one.motion).__doc__.splitlines()[0]
                yield f"  motion      walls.{one.name}: {type(one.motion).__name__}, {does}"
        for plane in scene.layout.mirror_planes:
            sticks = "; the fluid sticks to it" if plane.sticks else ""
            goes = ", which moves" if plane.motion else ""
            yield f"  mirror      {AXES[plane.axis]} = {plane.at:g} m{goes}{sticks}"


def measure_levels(simulation) -> None:
    """How high the water stands before the paddles that answer to it."""
    with simulation.ledger("paddles"):
        simulation.engine.of("paddles").answer(simulation, simulation.then, simulation.dt)
