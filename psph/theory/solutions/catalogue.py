"""Every exact solution by the name that a case gives it.  A new one is one line here.

A solution is a NamedTuple of its parameters.  Its methods take places ``x`` (n, dim) in m, a time
in s and a :class:`~psph.theory.solutions.setting.Setting`: ``velocity`` (n, dim) in m/s and ``pressure``
(n,) in Pa, as far as they are known; ``unfit`` says what of a case speaks against it, ``top_speed``
what sound has to be faster than, ``up_to_a_constant`` which fields a case may raise by any number.
"""

from psph.theory.solutions.channel import Couette, Poiseuille
from psph.theory.solutions.drop import EllipticDrop
from psph.theory.solutions.still import Hydrostatic
from psph.theory.solutions.vortices import Beltrami, Gresho, TaylorGreen
from psph.theory.solutions.waves import SoundWave, StandingWave

SOLUTIONS = {
    "taylor_green": TaylorGreen,
    "beltrami": Beltrami,
    "gresho": Gresho,
    "poiseuille": Poiseuille,
    "couette": Couette,
    "sound_wave": SoundWave,
    "standing_wave": StandingWave,
    "hydrostatic": Hydrostatic,
    "elliptic_drop": EllipticDrop,
}

FIELDS = ("velocity", "pressure")
"""Fields that a solution may have."""


def known(solution) -> tuple[str, ...]:
    """The fields that a solution has."""
    return tuple(name for name in FIELDS if hasattr(solution, name))
