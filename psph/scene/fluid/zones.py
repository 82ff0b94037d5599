"""What `check` says of the zones of a scene in which waves fade."""

from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.scene.scene import Scene

ZONES = "damping_zone", "other_damping_zone"


def zones_off_the_fluid(scene: Scene) -> Iterator[str]:
    """Zones that begin where no fluid is at the start: waves meet all of their damping at once, or none."""
    fluids = [n for n in range(len(scene.case.fluids)) if scene.census.sizes[n]]
    for name in ZONES if fluids else ():
        if (zone := getattr(scene.case.physics, name)) is None:
            continue
        half = 0.5 * scene.spacing
        axis = AXES.index(zone.axis)
        low = float(np.min(scene.census.lowest[fluids, axis])) - scene.spacing
        high = float(np.max(scene.census.highest[fluids, axis])) + scene.spacing
        if not low <= zone.begin <= high:
            yield (
                f"physics.{name}.begin: {zone.begin:g} m, and fluid stands from {low + half:.4g} to "
                f"{high - half:.4g} m along {zone.axis}; let it begin in the fluid, and end where this ends"
            )
