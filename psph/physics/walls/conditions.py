"""The conditions that a wall can set to the fluid before it: ``walls.NAME.condition``."""

from typing import ClassVar

from psph.acts import DIMENSIONS, FRAME, MATTER, MIXED, SEAM, SYMMETRY, speaks_for

DYNAMIC = "dynamic"
"""Its particles have a density, which evolves as that of the fluid (psph.physics.walls.dry)."""

EXTRAPOLATED = "extrapolated"
"""Its pressure is that of the fluid before it (psph.physics.walls.extrapolated)."""

REPULSIVE = "repulsive"
"""Its particles repel the fluid, and bear nothing (psph.physics.walls.repulsive)."""

PENALTY = "penalty"
"""It pushes back what comes too near, and bears nothing (psph.physics.walls.penalty)."""

MIRROR = "mirror"
"""A plane without particles: the fluid sees its own image behind it (psph.composition.mirrors)."""

CONDITIONS = (DYNAMIC, EXTRAPOLATED, REPULSIVE, PENALTY, MIRROR)

BEARING = (DYNAMIC, EXTRAPOLATED)
"""Their particles bear a pressure.  Those of other walls fill the support of the fluid at rest density: they
stay dry (psph.physics.walls.dry), and no sum is made for them."""

STICKING = (DYNAMIC, EXTRAPOLATED, MIRROR)
"""A fluid sticks to them where the case says no_slip: of others no sum says how it flows before them."""


CORNERS = (*MATTER, *CONDITIONS, FRAME, SEAM, SYMMETRY, *DIMENSIONS, MIXED)
"""All that an effect may act on, or refuse: kinds of matter, walls by their condition, surroundings."""


@speaks_for(MIRROR, SYMMETRY)
class Mirror:
    """Beside what a plane mirror does not work (psph.acts)."""

    refuses: ClassVar = {
        MIXED: 'mirrors do not work in single precision; use "double"',
        FRAME: "does not work with mirrors, which know of no frame that moves; remove one of the two",
    }
