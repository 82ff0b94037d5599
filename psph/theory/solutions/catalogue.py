"""Every exact solution by the name that a case gives it.  A new one is one line here.

A solution is a NamedTuple of its parameters.  Its methods take places ``x`` (n, dim) in m, a time
in s and a :class:`~psph.theory.solutions.setting.Setting`: ``velocity`` (n, dim) in m/s, ``pressure``
(n,) in Pa and ``density`` (n,) in kg/m^d, as far as they are known.  ``compressible`` is true of those of
ideal gases.  Of :class:`~psph.theory.solutions.setting.Surroundings` alone ``unfit``
says what of a case speaks against it, and ``top_speed`` what sound has to be faster than;
``up_to_a_constant`` names the fields that a case may raise by any number.
"""

import numpy as np

from psph.theory.solutions.channel import Couette, Poiseuille
from psph.theory.solutions.drop import EllipticDrop
from psph.theory.solutions.layers import InterfacialWave
from psph.theory.solutions.setting import Surroundings
from psph.theory.solutions.still import Hydrostatic
from psph.theory.solutions.thread import LiquidThread
from psph.theory.solutions.tube import ShockTube
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
    "interfacial_wave": InterfacialWave,
    "liquid_thread": LiquidThread,
    "hydrostatic": Hydrostatic,
    "elliptic_drop": EllipticDrop,
    "shock_tube": ShockTube,
}

FIELDS = ("velocity", "pressure", "density")
"""Fields that a solution may have."""


def known(solution) -> tuple[str, ...]:
    """The fields that a solution has."""
    return tuple(name for name in FIELDS if hasattr(solution, name))


def is_compressible(name: str) -> bool:
    """Whether the solution of a ``name`` is one of gas that is compressed."""
    return getattr(SOLUTIONS[name], "compressible", False)


OF_A_FLUID = ("density", "viscosity")
"""What of a setting belongs to its fluid."""


class _Listener:
    """Answers as a setting does, and remembers what it was asked for."""

    sound_speed = 1.0
    """Any number will do, m/s: not the answer counts but the question."""

    def __init__(self, surroundings: Surroundings):
        self._surroundings, self.asked = surroundings, set()

    def __getattr__(self, name: str):
        self.asked.add(name)
        return getattr(self._surroundings, name)


def asked_of_fluid(solution, surroundings: Surroundings) -> tuple[str, ...]:
    """What a solution asks of the fluid: those of its density and viscosity on which its fields depend."""
    listener = _Listener(surroundings)
    for name in known(solution):
        getattr(solution, name)(np.zeros((1, surroundings.dimensions)), 1.0, listener)
    return tuple(name for name in OF_A_FLUID if name in listener.asked)
