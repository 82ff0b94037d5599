"""Fluids, walls and bodies of a finer spacing as parts of a scene, and what follows another spacing."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from psph.scene.levels import Levels
from psph.scene.parts.part import Known, Part
from psph.scene.parts.rigid import RigidPart
from psph.scene.sweeps import farthest_way


@dataclass(frozen=True)
class LevelPart(Part):
    """Particles of a fluid that are of one ``level`` of sizes (psph.scene.refined), or of level 0 those that
    follow: they begin on no sites of the lattice."""

    level: int = 0
    follows: bool = False

    may_be_empty = True
    drawn = False
    jitter = 0.0

    @property
    def origin(self) -> int:
        """The number of its fluid."""
        return self.source

    def claimed(self, layout, grid, tolerance: float) -> np.ndarray:
        """No site."""
        return np.zeros((), bool)

    def own(self, known: Known) -> dict[str, Any]:
        """Its level, and the number of its fluid among fluids."""
        return {"fluid": 1 + self.source, "level": self.level}

    def particle_mass(self, cell: float, layout) -> float:
        """By the spacing of its level, kg."""
        return cell * 0.5 ** (self.level * layout.dimensions)

    def places(self, layout) -> np.ndarray | None:
        """The sites of its level where its fluid is and where it has its state, m."""
        levels = Levels(layout)
        found = levels.held(self.level, self.source) if self.level else None
        if found is None:
            return None
        own = levels.active(self.level, found) != self.follows
        return found[own] if own.any() else None


@dataclass(frozen=True)
class LevelWall(RigidPart):
    """The same of a wall."""

    level: int = 0
    origin: int = 0

    may_be_empty = True
    drawn = False
    rigid = False
    looks = "wall"

    def own(self, known: Known) -> dict[str, Any]:
        """That of a wall, and its level."""
        return super().own(known) | {"level": self.level}

    def way(self, end: float) -> float:
        """How far it goes until the ``end``, s, at the most, m."""
        return farthest_way(self.motion, self.room, end)

    claimed = LevelPart.claimed
    particle_mass = LevelPart.particle_mass

    def places(self, layout) -> np.ndarray | None:
        """The sites of its level that its wall has, as far as its fluid may come to see it, m."""
        levels, way = Levels(layout), self.way(layout.case.time.end)
        return levels.held(self.level, self.origin, levels.support(self.level - 1) + way, self.room)


@dataclass(frozen=True)
class LevelBody(LevelWall):
    """The same of a rigid body: all of it, wherever it may come."""

    looks = "rigid body"

    def way(self, end: float) -> float:
        """Any."""
        return math.inf
