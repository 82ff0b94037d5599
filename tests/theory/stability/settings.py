"""What the tests of stability start from."""

from psph.theory.stability.uniform import Settings

TENSION = Settings("cubic", 1.2, "square", -2500.0, density=900.0, sound_speed=5.0, spacing=1e-3)
"""Case 4.2 of the paper, in SI units."""


def of(kernel, smoothing, lattice="square", pressure=1.0, **more):
    """In units of |P|, ρ and dx."""
    return Settings(kernel, smoothing, lattice, pressure, **more)
