"""The linearised scheme: the effect of a small displacement of a neighbour on a particle.

With ξ the displacement, u = dξ/dt, and δρ,

    du_a/dt  = −Σ_b stiffness (ξ_a − ξ_b) − Σ_b damping (u_a − u_b) + Σ_b push δρ_b
    dδρ_a/dt = −Σ_b pull·(u_a − u_b) − Σ_b diffusion (δρ_a − δρ_b)

Every part depends on R = x_b − x_a alone.  The part of δρ_a itself in du_a/dt vanishes since
Σ ∇W = 0 on a lattice.  For the symmetric form push = m (c²/ρ² − 2P/ρ³) ∇W(R), pull = m ∇W(R),
stiffness = 2Pm/ρ² H(R), H the Hessian of W.  The forms ``minimum`` and ``difference`` take
pressures relative to those around: P drops out, push = m c²/ρ² ∇W(R).
"""

from typing import NamedTuple

import numpy as np

from psph.theory.stability import SYMMETRIC
from psph.theory.stability.parts import PressureTerm
from psph.theory.stability.uniform import Uniform

FINE = 1e-5
"""Step over h of the difference that gives the slope of a force: exact to 1e-9 but at knots."""


class Couplings(NamedTuple):
    """For each neighbour R: ``whole`` (n, d) the lattice numbers of R, and what it does.

    ``sites`` (n, d) m; ``stiffness`` (n, d, d) 1/s²; ``damping`` (n, d, d) 1/s; ``push`` (n, d)
    and ``pull`` (n, d) between δρ and motion; ``diffusion`` (n,) 1/s, and the parts of it that walls
    do not give to the fluid, ``spreading`` (n,), or exchange with each other, ``meeting`` (n,).
    """

    whole: np.ndarray
    sites: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    push: np.ndarray
    pull: np.ndarray
    diffusion: np.ndarray
    spreading: np.ndarray
    meeting: np.ndarray

    @property
    def halved(self) -> "Couplings":
        """One of each R, −R, counted twice: a plane wave needs no more."""
        ahead = [n > (0,) * len(n) for n in map(tuple, self.whole.tolist())]
        numbers, sites, *parts = (part[ahead] for part in self)
        return Couplings(numbers, sites, *(2.0 * part for part in parts))


def couplings(uniform: Uniform) -> Couplings:
    """The scheme linearised about a uniform state."""
    whole = uniform.lattice.within(uniform.reach)
    sites = whole @ uniform.lattice.basis
    r = np.linalg.norm(sites, axis=1)
    unit = sites / r[:, None]
    mass, slope = uniform.density * uniform.volume, uniform.slope(r)
    remedies = uniform.settings.remedies
    stresses = _stresses(uniform)
    response = sum(stress.response * stress.weight(r) for stress in stresses)

    def force(r):
        pressures = sum(stress.pressure * stress.weight(r) for stress in stresses)
        pressed = 2.0 * mass / uniform.density**2 * pressures * uniform.slope(r)
        return pressed + sum(remedy.force(uniform, r) for remedy in _with(remedies, "force"))

    damped = [remedy.damping(uniform, r) for remedy in _with(remedies, "damping")]
    none = np.zeros_like(r)
    spreading, meeting = (
        sum((getattr(remedy, of)(uniform, r) for remedy in _with(remedies, of)), none)
        for of in ("spreading", "meeting")
    )
    return Couplings(
        whole,
        sites,
        slope_of(force, r, unit, FINE * uniform.smoothing_length),
        _matrices(unit, sum((a for a, _ in damped), none), sum((b for _, b in damped), none)),
        (mass * response * slope)[:, None] * unit,
        (mass * slope)[:, None] * unit,
        spreading + meeting,
        spreading,
        meeting,
    )


def _stresses(uniform: Uniform) -> list[PressureTerm]:
    """The terms of the pressure gradient."""
    if uniform.settings.form == SYMMETRIC:
        own = PressureTerm(uniform.pressure, uniform.response)
    else:
        own = PressureTerm(0.0, (uniform.sound_speed / uniform.density) ** 2)
    added = [remedy.stress(uniform) for remedy in _with(uniform.settings.remedies, "stress")]
    return [own, *added]


def _with(remedies, method: str):
    return [remedy for remedy in remedies if hasattr(remedy, method)]


def slope_of(force, r: np.ndarray, unit: np.ndarray, step: float) -> np.ndarray:
    """f′ r̂r̂ᵀ + f/r (1 − r̂r̂ᵀ): how the vector f r̂ changes with its end."""
    steepness = (force(r + step) - force(r - step)) / (2.0 * step)
    across = force(r) / r
    return _matrices(unit, steepness - across, across)


def _matrices(unit: np.ndarray, along: np.ndarray, anyhow: np.ndarray) -> np.ndarray:
    """along r̂r̂ᵀ + anyhow, (n, d, d)."""
    outer = unit[:, :, None] * unit[:, None, :]
    return along[:, None, None] * outer + anyhow[:, None, None] * np.eye(unit.shape[1])
