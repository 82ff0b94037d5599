"""Remedy: a force between neighbours that keeps their order everywhere and bears no pressure.

psph itself has it where particles are in disorder (psph.physics.order.potential).  A case beside this file
says ``use = ["pair_potential.py"]``.
"""

from typing import NamedTuple

import numpy as np

from psph.acts import MADE_FOR_FLUIDS
from psph.composition.pair import Pair
from psph.fields import view_of
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.facts import Facts
from psph.physics.order.potential import NeutralPotential, Strength, neutral_potential, repulsion
from psph.theory.stability import parts


class PairPotential(NamedTuple):
    """Near neighbours repel, farther ones attract: pairs keep their distance, and no pressure is added.

    a_i = −(2K/ρ₀) dx^d Σ_j ψ′(r) x_ij/r, ψ′ and K as in :class:`psph.physics.order.potential.LocalPotential`.
    It is a potential, so momentum, angular momentum and energy are conserved.  Between two masses the force
    is that between two of the smaller mass: the heavier one is moved less.  psph's own.
    """

    refuses = MADE_FOR_FLUIDS

    conserves = ("momentum", "angular momentum")

    strength: Strength = 0.008

    def in_scene(self, scene: Facts):
        """The potential of the scene's lattice, for one mass or for several."""
        made = neutral_potential(self.strength, scene.sound_speed, scene.spacing, scene.dimensions)
        alike = len({material.mass for material in scene.species}) == 1
        return EqualMasses(*made) if alike else UnequalMasses(*made)


class EqualMasses(NeutralPotential):
    """Near neighbours repel, farther ones attract: pairs keep their distance, and no pressure is added."""

    conserves = ("momentum", "angular momentum")

    def linear(self, scene: Facts):
        """The same attraction of pairs in linear theory."""
        one = view_of(("mass",))(1.0)

        def attraction(r):
            pairs = (Pair(r2=x * x, r=x, inverse_r=1.0 / x) for x in r)
            return -r * np.array([self.radial(one, one, pair) for pair in pairs])

        return parts.PairForce(attraction)


class UnequalMasses(NeutralPotential):
    """Near neighbours repel, farther ones attract: pairs of different masses.

    That of one mass times min(m_i, m_j)/m_i.
    """

    conserves = ("momentum", "angular momentum")

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return min(1.0, j.mass * (1.0 / i.mass)) * repulsion(self, pair)


CATALOGUE = Catalogue(effects=(Entry("physics.pair_potential", PairPotential),))
