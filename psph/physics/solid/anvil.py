"""Rigid planes that solids may hit."""

from typing import NamedTuple

import numpy as np

from psph.acts import BODIES, SOLIDS
from psph.formula import helper
from psph.physics.facts import Facts
from psph.vectors import add, dot, scale, subtract, zero_like


class Anvils(NamedTuple):
    """Rigid, frictionless planes push back the particles of solids that come nearer than half a spacing.

    a_i = (c_l/dx)² Σ max(dx/2 − (x_i − X)·n, 0) n over the planes through X with the normal n: a spring as
    stiff as the layer of particles that it holds, with the fastest wave c_l of all solids.  A pressure p on
    the plane presses it in by dx p/(ρ c_l²).  The force has a potential, and no part along the plane.
    """

    acts = (SOLIDS,)
    refuses = {BODIES: "rigid bodies do not feel them; take a wall, or remove one of the two"}

    planes: tuple = ()
    half: float = 0.0
    stiffness: float = 0.0

    def in_scene(self, scene: Facts):
        """With the planes of the scene, or None."""
        if not scene.hard_planes:
            return None
        return Anvils(tuple(scene.hard_planes), 0.5 * scene.spacing, (scene.sound_speed / scene.spacing) ** 2)

    def body(self, i):
        """The push, m/s²."""
        push = zero_like(i.position)
        for place, normal in self.planes:
            push = add(push, scale(normal, self.stiffness * pressed(self.half, i.position, place, normal)))
        return push

    def potential(self, i):
        """(c_l/dx)² Σ max(dx/2 − (x_i − X)·n, 0)²/2, J/kg."""
        total = 0.0
        for place, normal in self.planes:
            total += pressed(self.half, i.position, place, normal) ** 2
        return 0.5 * self.stiffness * total


@helper
def pressed(half, position, place, normal):
    """How far a particle is nearer than ``half`` to a plane through ``place``, m."""
    return np.maximum(half - dot(subtract(position, place), normal), 0.0)
