"""How wide the particles of a frame are, where each has a size of its own."""

from collections.abc import Iterable, Mapping

import numpy as np

from psph.fields import OF_SCENE

LENGTH = OF_SCENE[0].name
"""The field of frames that holds the smoothing length h of each particle, where these differ."""

MASS = "mass"
"""The field that holds masses, where those of a group differ."""


def of_sizes(saved: Iterable[str]) -> tuple[str, ...]:
    """What of these the ``saved`` fields of frames hold."""
    return tuple(name for name in (LENGTH, MASS) if name in saved)


def widths(frame: Mapping[str, np.ndarray], space: Mapping) -> np.ndarray:
    """The mean distance of a particle's neighbours (n,), m: h/η where frames hold h, n^(−1/d) of a gas, else
    the ``spacing`` of the ``space`` of a case."""
    if LENGTH in frame:
        return frame[LENGTH] / space["smoothing"]
    return np.full(len(frame["position"]), float(space["spacing"]))
