"""The conditions that a wall can set to the fluid before it: ``walls.NAME.condition``."""

DYNAMIC = "dynamic"
"""Its particles have a density, which evolves as that of the fluid (psph.physics.walls.dry)."""

EXTRAPOLATED = "extrapolated"
"""Its pressure is that of the fluid before it (psph.physics.walls.extrapolated)."""

CONDITIONS = (DYNAMIC, EXTRAPOLATED)
