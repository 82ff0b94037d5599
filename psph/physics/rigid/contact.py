"""Contact of rigid bodies with each other and with walls."""

from typing import NamedTuple

from psph.formula import where

WALL_SOLID = 1.0
"""The number of a wall among solids; those of bodies are above."""

LOSS = 0.3
"""Damping of a contact over that at which one particle would not swing back."""


class Contact(NamedTuple):
    """A body's particles are repelled by those of other solids where they are nearer than a spacing.

    f_ij = max(k (dx − r) − ζ u_ij·x_ij/r, 0) along x_ij/r where r < dx, with k = ρ₀c² dx^(d−2), so that
    a face pressed in by a spacing bears ρ₀c² as the fluid does, and ζ = 0.6 ρ₀c dx^(d−1).  Before a mirror
    it is repelled by its own image: its face then stands on the mirror.  It has no
    friction along the face but the roughness of the lattice.  ``stiffness`` k in N/m, ``damping`` ζ in N
    s/m, ``distance`` dx in m.
    """

    stiffness: float
    damping: float
    distance: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        other, is_body = j.solid - i.solid, max(i.solid - WALL_SOLID, 0.0)
        depth = max(self.distance - pair.r, 0.0) * (1.0 - j.is_fluid)
        per_mass = 1.0 / i.mass  # once a particle, where a division in each pair would cost
        stiffness, damping = self.stiffness * per_mass, self.damping * per_mass
        push = max(stiffness * depth - damping * pair.u_dot_x * pair.inverse_r, 0.0)
        return where(is_body * depth * other * other > 0.0, push * pair.inverse_r, 0.0)


def contact_of(scene) -> Contact:
    """The contact of a scene's bodies: as stiff as its heaviest fluid."""
    density, c = max(one.density for one in scene.species), scene.sound_speed
    dx, d = scene.spacing, scene.dimensions
    return Contact(density * c * c * dx ** (d - 2), 2.0 * LOSS * density * c * dx ** (d - 1), dx)
