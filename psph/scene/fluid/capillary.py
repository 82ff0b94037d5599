"""How fast surface tension moves what it pulls at."""

import math

from psph.case.tensions import tensions_in
from psph.physics.surface.tension import inertias
from psph.scene.census import Census

FILM = 4.0
"""Spacings across the thinnest film that a case resolves."""


def capillary_speed(census: Census) -> float:
    """√(2σ/(ρe)), m/s: that at which the edge of a film of the thickness e draws back, e four spacings.

    Taylor (1959), Proc. R. Soc. Lond. A 253, 313; Culick (1960), J. Appl. Phys. 31, 1128.  A drop of four
    spacings a radius has a pressure of ρ/2 times its square.
    """
    case = census.layout.case
    fluids = [(case.fluids[name].density, tensions) for name, tensions in tensions_in(case).items()]
    lightest = min(inertias(fluids), default=math.inf)
    return math.sqrt(2.0 / (lightest * FILM * census.layout.spacing))
