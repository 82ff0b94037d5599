"""The words in which an effect says on what it acts."""

from psph.formula import helper, where

FLUIDS, SOILS, UPDATED, SOLIDS, BODIES = (
    "fluids",
    "soils",
    "updated Lagrangian solids",
    "solids",
    "rigid bodies",
)
"""Kinds of matter: what flows, elastic solids that keep their neighbours of the start, and what is rigid."""

MATTER = (FLUIDS, SOILS, UPDATED, SOLIDS, BODIES)

FLOWING = (FLUIDS, SOILS, UPDATED)
"""What moves freely and finds its neighbours in space: these share one pair loop."""


def acts_on(effect) -> tuple[str, ...]:
    """The kinds of matter on which an effect acts: its attribute ``acts``.

    Where it declares none: all matter if it has a body force, else what flows.
    """
    return getattr(effect, "acts", MATTER if hasattr(effect, "body") else FLOWING)


@helper
def of_fluids(i, value):
    """``value`` for a particle of a fluid, 0 for one that bears an evolved stress: a soil, a solid."""
    return where(i.shear_modulus > 0.0, 0.0, value)
