"""How far gases see at the faces where they end."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from psph.case.keys import AXES
from psph.moments import length_at_a_face
from psph.particles.sizes import CUTOFFS_A_PERIOD, Sizes
from psph.scene.mirrors import distances
from psph.scene.shapes import bounds
from psph.smoothing import unit_kernel


def face_faults(layout: Any, parts: Sequence[Any], sizes: Sizes) -> Iterator[str]:
    """A line for each period, and each pair of mirrors, that is too short for how far particles at the open
    faces of ``parts`` see at the start.

    Those have half of their neighbours, and longer smoothing lengths for it.  Of parts on a lattice alone;
    gas may expand later, which the run tells.
    """
    longest = _longest(layout, parts)
    reach = sizes.reach(longest)
    told = (
        f"at open faces of gases smoothing lengths are {longest:.4g} m at the start, where nothing stands "
        f"behind, and lists reach {reach:.4g} m; make space.spacing smaller, or"
    )
    for name, period in zip(AXES, layout.periods):
        if period is not None and CUTOFFS_A_PERIOD * reach > period:
            least = CUTOFFS_A_PERIOD * reach
            yield (
                f"space.upper: the domain is {period:.6g} m long along the periodic axis {name}; {told} the "
                f"domain longer than {least:.4g} m"
            )
    for axis, (low, high) in distances(layout.mirror_planes).items():
        if reach > high - low:
            yield f"space: mirrors at {AXES[axis]} = {low:g} and {high:g} m; {told} put them farther apart"


def _longest(layout: Any, parts: Sequence[Any]) -> float:
    """The smoothing length at the open faces, m, or 0: by the finest of what ends where all do."""
    kernel = unit_kernel(layout.kernel, layout.dimensions)
    at_a_face = length_at_a_face(kernel, layout.case.space.smoothing, layout.dimensions) * layout.spacing
    corners = np.array([bounds(part.shape) for part in parts if part.even])
    if len(corners) < len(parts):
        return 0.0
    finer = np.array([part.finer for part in parts])
    outward = corners * np.array([-1.0, 1.0])[:, None]
    outermost = outward >= outward.max(axis=0) - layout.support
    lengths = (
        at_a_face / finer[outermost[:, side, axis]].max()
        for axis, period in enumerate(layout.periods)
        for side in (0, 1)
        if period is None and not _mirrored(layout, axis, side)
    )
    return max(lengths, default=0.0)


def _mirrored(layout: Any, axis: int, side: int) -> bool:
    """Whether a mirror is across an axis, below (0) or above (1)."""
    return any(plane.axis == axis and (plane.side < 0) == (side == 0) for plane in layout.mirror_planes)
