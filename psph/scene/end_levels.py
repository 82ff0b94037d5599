"""Open ends beside regions with finer particles: all that an end has and sees is of the coarsest level."""

from collections.abc import Iterator

import numpy as np

from psph.case.ends import OpenEnd
from psph.physics.motion import moments
from psph.scene.end_rides import ride_of
from psph.scene.end_rows import raised
from psph.scene.ends import BEYOND, SEEN, groups_of
from psph.scene.levels import Levels
from psph.scene.shapes import bounds
from psph.scene.sweeps import MOMENTS


def level_faults(scene, name: str, end: OpenEnd) -> Iterator[str]:
    """An end that finer particles may come to."""
    levels = Levels(scene.layout)
    if levels.count == 1:
        return
    region, away = levels.nearest(_places(scene, name, end))
    if away < levels.widest:
        where = scene.case.space.refine[region].where
        yield (
            f"ends.{name}.at: {end.at:.4g} m: what stands behind its plane and within {SEEN:g} spacings in "
            f"front comes within {max(away, 0.0):.3g} m of {where}, around which finer "
            f"particles need {levels.widest:.3g} m; move the plane, or the region, by "
            f"{levels.widest - away:.3g} m"
        )


def _places(scene, name: str, end: OpenEnd) -> np.ndarray:
    """Places (n, dim), m, a spacing apart at the most, of all that an end may ever have or see."""
    layout, dx = scene.layout, scene.spacing
    lower, upper = map(np.array, bounds(layout.parts[groups_of(layout, name)[0]].shape))
    lower, upper = raised(layout, end, lower, upper)
    ride = ride_of(scene, end)
    ways = [ride.place(time) - end.at for time in moments(scene.case.time.end, MOMENTS)]
    sides = np.array([SEEN, -BEYOND]) * dx * end.sign
    lower[end.axis] += min(ways) + sides.min()
    upper[end.axis] += max(ways) + sides.max()
    axes = [np.linspace(low, up, 2 + int((up - low) / dx)) for low, up in zip(lower, upper)]
    return np.stack([x.ravel() for x in np.meshgrid(*axes)], axis=1)
