"""What an elastic solid is made of, and how fast its waves are."""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from psph.physics.solid.compression import EvenBulk, MieGruneisen
from psph.physics.solid.laws import LAWS, moduli
from psph.physics.solid.plane import PlaneStress
from psph.physics.solid.plastic import JohnsonCook, LinearHardening, Metal
from psph.physics.solid.viscous import Branch, Viscoelastic

STEP = 0.6
"""Δt ≤ 0.6 min(h/(c_l + v), √(h/a)).  Gray, Monaghan & Swift (2001), Comput. Methods Appl. Mech. Eng. 190,
6641; Zhang, Rezavand & Hu (2021), J. Comput. Phys. 429, 110028."""

PRESSED = 3.0
"""How far a metal is expected to be pressed together: waves then pass three times as many particles of the
reference in a second, and the step is as much shorter.  Without, the foot of a Taylor bar falls apart."""

FRICTION_STEP = 0.125
"""Δt ≤ 0.125 h²ρ₀/η, as of viscous fluids (Morris and others 1997)."""

CALM = 0.08
"""C in :func:`calming_viscosity`: a solid on a chain of fluid cells needs 0.06, whatever its thickness and
frequency (tests/simulation/test_held_push.py)."""

MADE_OF = (
    "density",
    "young",
    "poisson",
    "law",
    "yield_stress",
    "hardening",
    "critical_stretch",
    "flaws",
)
"""The keys of a case that say what a solid is made of, as they stand."""


class ElasticSolid(NamedTuple):
    """An elastic solid: its ``law`` (psph.physics.solid.laws), ``density`` in the reference in kg/m³, and
    ``wave_speed`` c_l = √((λ + 2μ)/ρ₀) of its fastest wave in m/s; the ``viscosity`` of Kelvin and Voigt in
    Pa s, and the ``stiffness`` αE of the hourglass control in Pa.

    Bonds are cut beyond the ``critical_stretch``, infinite where it does not crack; ``flaws`` is the Weibull
    modulus of its scatter, 0 without (psph.physics.solid.cracks).  Its particles count by their shares where
    it is ``shared`` (psph.physics.solid.shares); ``finer`` is the spacing of the lattice over its own."""

    name: str
    law: Any
    density: float
    wave_speed: float
    viscosity: float
    stiffness: float
    critical_stretch: float = math.inf
    flaws: float = 0.0
    shared: bool = False
    finer: int = 1

    def longest_step(self, smoothing_length: float, speed: float) -> float:
        """By waves and friction, at the largest speed in m/s, s; ``smoothing_length`` is that of solids of
        the spacing of the lattice, m."""
        h = smoothing_length / self.finer
        by_waves = STEP * h / (self.wave_speed + speed)
        if yields((self,)):
            by_waves /= PRESSED
        if not self.viscosity:
            return by_waves
        return min(by_waves, FRICTION_STEP * h * h * self.density / self.viscosity)


def solid_of(
    name: str,
    density: float,
    young: float,
    poisson: float,
    law: str,
    damping: float,
    hourglass: float,
    yield_stress: float | None = None,
    hardening: float = 0.0,
    johnson_cook: dict[str, float] | None = None,
    critical_stretch: float | None = None,
    flaws: float | None = None,
    mie_gruneisen: dict[str, float] | None = None,
    length: float = 0.0,
    shared: bool = False,
    finer: int = 1,
    hyperelastic: Any = None,
    sheet: bool = False,
    branches: tuple[Branch, ...] = (),
) -> ElasticSolid:
    """The solid of these numbers: ``young`` and ``poisson`` E in Pa and ν, ``damping`` η in Pa s; where it
    yields, ``yield_stress`` and ``hardening`` in Pa, or the numbers of a table ``johnson_cook``; where it
    cracks, ``critical_stretch`` and perhaps the Weibull modulus ``flaws``; with the numbers of a table
    ``mie_gruneisen`` its pressure is by that law, shocks as wide as some ``length`` in m; ``shared`` and
    ``finer`` as in :class:`ElasticSolid`.  A ``hyperelastic`` law stands in the place of that named; a
    ``sheet`` is in plane stress; the stress of ``branches`` relaxes."""
    lame, shear = moduli(young, poisson)
    bulk = lame + 2.0 * shear / 3.0
    compression: Any = EvenBulk(bulk)
    if mie_gruneisen is not None:
        compression = mie_gruneisen_of(density, bulk, length, **mie_gruneisen)
        bulk = density * compression.sound_speed**2
    stiff = shear + sum(one.shear for one in branches)
    speed = ((bulk + 4.0 * stiff / 3.0) / density) ** 0.5
    yielding: Any = None
    if johnson_cook is not None:
        yielding = johnson_cook_of(density, **johnson_cook)
    elif yield_stress is not None:
        yielding = LinearHardening(yield_stress, hardening)
    own: Any = hyperelastic or LAWS[law](lame, shear)
    own = Metal(compression, shear, yielding) if yielding else PlaneStress(own) if sheet else own
    own = Viscoelastic(own, branches) if branches else own
    most = math.inf if critical_stretch is None else critical_stretch
    stiffness = hourglass * young
    return ElasticSolid(name, own, density, speed, damping, stiffness, most, flaws or 0.0, shared, finer)


def mie_gruneisen_of(
    density: float, bulk: float, length: float, slope: float, gruneisen: float, sound_speed: float | None
) -> MieGruneisen:
    """The pressure of a solid of ``density`` in kg/m³; ``sound_speed`` None: that of its ``bulk`` modulus."""
    return MieGruneisen(density, sound_speed or (bulk / density) ** 0.5, slope, gruneisen, length)


def calming_viscosity(young: float, poisson: float, share: float, dt: float) -> float:
    """η in Pa s that calms the waves of a solid in a fluid which a step of the fluid does not resolve.

    η = 2 C E′ Δt z, E′ = E/(1 − ν²), with z = ρ_f c Δt/(ρ_s H) the ``share`` of its speed that a solid of
    thickness H loses in a step Δt = ``dt`` s to sound.  The push of the fluid is held for a step and answers
    to velocities of the steps before, so a wave of the solid with ωΔt near 1 and more gets it with the wrong
    sign, and grows by a part of z a step (docs/coupling.md).  The stress of Kelvin and Voigt damps it by
    ηω²Δt/2E′ = C z (ωΔt)².  What a step resolves keeps its energy to the second order in Δt.
    """
    return 2.0 * CALM * young / (1.0 - poisson**2) * dt * share


HEAT = 0.9
"""The part of plastic work that becomes heat.  Taylor & Quinney (1934), Proc. R. Soc. London A 143, 307."""


def johnson_cook_of(density: float, heat_capacity: float | None, **numbers) -> JohnsonCook:
    """The strength of a solid of ``density`` in kg/m³ and a ``heat_capacity`` in J/(kg K); without one its
    temperature stays."""
    return JohnsonCook(heated=HEAT / (density * heat_capacity) if heat_capacity else 0.0, **numbers)


def yields(solids: Iterable[ElasticSolid]) -> bool:
    """Whether any solid yields: then all particles carry the history of a metal."""
    return any(isinstance(one.law, Metal) for one in solids)


def relaxing(solids: Iterable[ElasticSolid]) -> int:
    """The most branches of a solid whose stress relaxes: as many histories all particles carry."""
    return max((len(getattr(one.law, "branches", ())) for one in solids), default=0)


def remembers(solids: Iterable[ElasticSolid]) -> bool:
    """Whether any solid yields or relaxes."""
    return any(hasattr(one.law, "flow") for one in solids)


def is_heated(solids: Iterable[ElasticSolid]) -> bool:
    """Whether any solid books its internal energy."""
    return any(isinstance(getattr(one.law, "compression", None), MieGruneisen) for one in solids)


def is_damped(solids: Iterable[ElasticSolid]) -> bool:
    """Whether any solid has a viscosity: then velocities are summed, and travel, too."""
    return any(one.viscosity for one in solids)
