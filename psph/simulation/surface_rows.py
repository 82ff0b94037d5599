"""What rows of particles of several sizes bear below a surface, one in terms of the other.

Fluid at rest bears less in its first rows than its weight asks for, by parts of ρ g dx
(:mod:`psph.physics.fluid.rows`).  Did rows of another spacing follow that pressure as it is, water would flow
from fine to coarse along the surface: at 14 mm/s after half a second, with 20 and 10 mm side by side.
"""

from typing import NamedTuple

import numpy as np

from psph.formula import helper
from psph.physics.fluid.rows import pressures_of_rows


class RowsAtRest(NamedTuple):
    """``borne`` (n,) is p over ρ g dx at the depths 0, ½, 1½ … dx, empty where no rows are known; ``weight``
    is ρ g dx/h, Pa/m, ``softness`` 1/c², s²/m², and ``density`` ρ, kg/m³."""

    borne: np.ndarray
    weight: float
    softness: float
    density: float


def rows_of(scene) -> RowsAtRest:
    """Of the fluid of a ``scene`` with levels of sizes."""
    fluid = next(one for one in scene.species if one.is_fluid)
    weight = fluid.density * float(np.linalg.norm(scene.gravity)) * scene.spacing / scene.smoothing_length
    return RowsAtRest(pressures_of_rows(scene), weight, 1.0 / fluid.sound_speed**2, fluid.density)


@helper
def weighed(rows, length, pressure):
    """ρ g times the depth, Pa, at which a row whose smoothing ``length`` is in m bears a ``pressure``, Pa;
    below the rows that are known, and over the surface, the pressure itself."""
    unit, last = rows.weight * length, len(rows.borne) - 1
    if last < 1 or pressure <= 0.0 or pressure >= unit * rows.borne[last]:
        return pressure
    share, n = pressure / unit, 0
    while share >= rows.borne[n + 1]:
        n += 1
    part = (share - rows.borne[n]) / (rows.borne[n + 1] - rows.borne[n])
    return unit * (0.5 * part if n == 0 else n - 0.5 + part)


@helper
def borne(rows, length, weight):
    """The pressure, Pa, that such a row bears where ρ g times its depth is a ``weight``, Pa."""
    unit, last = rows.weight * length, len(rows.borne) - 1
    if last < 1 or weight <= 0.0 or weight >= unit * (last - 0.5):
        return weight
    n = int(weight / unit + 0.5)
    part = weight / unit - (n - 0.5) if n else 2.0 * weight / unit
    return unit * (rows.borne[n] + part * (rows.borne[n + 1] - rows.borne[n]))
