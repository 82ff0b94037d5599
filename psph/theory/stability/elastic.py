"""Elastic matter on a lattice, stretched evenly: how small waves move in each description of it.

ξ̈ = −Ω ξ for a plane wave ξ exp(ik·x).  Sums of ∇W see only s(k) = Σ_R V g R sin k·R, g = −W′/r, in the
place of k: what has s = 0 strains nothing.  At the corners of the Brillouin zone every sin vanishes, so a
zigzag, whose neighbours move against each other, has no stiffness but that which a description adds.
"""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from psph.smoothing import kernel
from psph.theory.stability.couplings import FINE, slope_of
from psph.theory.stability.lattices import BravaisLattice, lattice
from psph.theory.stability.uniform import of_each

ONE_THIRD = 1.0 / 3.0


class ElasticMatter(NamedTuple):
    """Elastic matter on a lattice: Lamé's ``lame`` and ``shear`` in Pa, ``density`` at rest in kg/m³.

    ``stretches`` along the axes (d,) are those of the whole lattice from rest, where it has ``spacing`` m; 1D
    and 2D are in plane strain.  The kernel has h = ``smoothing`` times that spacing, stretched or not.
    """

    lame: float
    shear: float
    stretches: tuple[float, ...]
    lattice: str = "square"
    kernel: str = "wendland-c2"
    smoothing: float = 2.0**0.5
    density: float = 1.0
    spacing: float = 1.0

    @property
    def young(self) -> float:
        """Young's modulus, Pa."""
        return self.shear * (3.0 * self.lame + 2.0 * self.shear) / (self.lame + self.shear)

    @property
    def wave_speed(self) -> float:
        """c_l = √((λ + 2μ)/ρ), of the fastest wave, m/s."""
        return float(np.sqrt((self.lame + 2.0 * self.shear) / self.density))

    @property
    def at_rest(self) -> "ElasticMatter":
        """The same, not stretched."""
        return self._replace(stretches=(1.0,) * len(self.stretches))


class Sites:
    """The neighbours of a particle in stretched matter: ``sites`` R (n, d) m, r (n,), V m^d, the kernel."""

    def __init__(self, matter: ElasticMatter):
        made = lattice(matter.lattice, matter.spacing)
        self.lattice = BravaisLattice(made.basis * np.array(matter.stretches))
        self.smoothing_length = matter.smoothing * matter.spacing
        self.kernel = kernel(matter.kernel, self.smoothing_length, made.dimensions)
        whole = self.lattice.within(self.kernel.support * self.smoothing_length)
        self.sites = whole @ self.lattice.basis
        self.r = np.linalg.norm(self.sites, axis=1)
        self.volume = matter.spacing**made.dimensions * float(np.prod(matter.stretches))
        [self.nearest] = of_each(self.kernel.w, np.array([matter.spacing]))

    @cached_property
    def weight(self) -> np.ndarray:
        """V g = −V W′/r, 1/m² (n,)."""
        return -self.volume * self.slope(self.r) / self.r

    @cached_property
    def moment(self) -> np.ndarray:
        """M = Σ V g R Rᵀ, 1 where gradients are exact, (d, d)."""
        return np.einsum("n,na,nb->ab", self.weight, self.sites, self.sites)

    def slope(self, r: np.ndarray) -> np.ndarray:
        """W′(r)."""
        return of_each(self.kernel.dw, r)

    def nearness(self, r: np.ndarray, exponent: float) -> np.ndarray:
        """(W(r)/W(dx))^exponent, dx the spacing at rest."""
        return (of_each(self.kernel.w, r) / self.nearest) ** exponent

    def hessian(self, force) -> np.ndarray:
        """How the vector f(r) R/r changes with R, (n, d, d)."""
        unit = self.sites / self.r[:, None]
        return slope_of(force, self.r, unit, FINE * self.smoothing_length)


class TotalLagrangian(NamedTuple):
    """Neighbours are those of the reference; the energy of psph.physics.solid.deformation.

    ρ₀ Ω = A(q) + ½αE Σ V g [(1 − cos k·R)² + (sin k·R − q·R)²], q = M⁻¹ s over the sites R of the reference,
    A the acoustic tensor of Saint Venant and Kirchhoff's law at these stretches.  The second term, with the
    ``hourglass`` α, holds zigzags, whatever the stretch.
    """

    hourglass: float = 1.5

    def sites(self, matter: ElasticMatter) -> Sites:
        """Those of the lattice to which k belongs."""
        return Sites(matter.at_rest)

    def squares(self, matter: ElasticMatter, waves: np.ndarray) -> np.ndarray:
        """Ω of many k (waves, d) in the reference, rad/m: (waves, d, d), 1/s²."""
        around = self.sites(matter)
        phase = waves @ around.sites.T
        q = np.sin(phase) * around.weight @ around.sites @ np.linalg.inv(around.moment)
        tensor = np.einsum("ijkl,wj,wl->wik", tangent(matter), q, q)
        misfit = (1.0 - np.cos(phase)) ** 2 + (np.sin(phase) - q @ around.sites.T) ** 2
        held = 0.5 * self.hourglass * matter.young * (misfit @ around.weight)
        return (tensor + held[:, None, None] * np.eye(q.shape[1])) / matter.density


class UpdatedLagrangian(NamedTuple):
    """Neighbours are those of the present; density and deviatoric stress follow the flow (Jaumann).

    Gradients of the velocity are exact for linear flows; with ``corrected`` also those of the continuity
    equation and of the force.  ``artificial_stress`` is the ε of Gray, Monaghan & Swift (2001), Comput.
    Methods Appl. Mech. Eng. 190, 6641: R = −εσ′/ρ² for each principal stress σ′ > 0, beside σ/ρ², times
    (W/W(dx))^``exponent``.  p = K ln(ρ/ρ₀), K = λ + 2μ/3.
    """

    artificial_stress: float = 0.0
    exponent: float = 4.0
    corrected: bool = True

    def sites(self, matter: ElasticMatter) -> Sites:
        """Those of the lattice to which k belongs."""
        return Sites(matter)

    def squares(self, matter: ElasticMatter, waves: np.ndarray) -> np.ndarray:
        """Ω of many k (waves, d) in the present, rad/m: (waves, d, d), 1/s²."""
        around = self.sites(matter)
        one, phase = np.eye(len(matter.stretches)), waves @ around.sites.T
        sines, still = np.sin(phase), 1.0 - np.cos(phase)
        inverse = np.linalg.inv(around.moment)
        bulk = matter.lame + 2.0 * ONE_THIRD * matter.shear
        rho = matter.density / np.prod(matter.stretches)
        strain = np.log(matter.stretches)
        deviator = 2.0 * matter.shear * np.diag(strain - strain.sum() * ONE_THIRD)
        sigma = deviator + bulk * strain.sum() * one
        own = inverse if self.corrected else one
        s = sines * around.weight @ around.sites
        q, pull = s @ inverse, s @ own
        mass = rho * around.volume
        bent = around.hessian(around.slope)

        repelled = around.hessian(lambda r: around.nearness(r, self.exponent) * around.slope(r))
        far = sines * (around.weight * around.nearness(around.r, self.exponent)) @ around.sites
        extra, answer = _repulsion(np.diag(sigma), self.artificial_stress)
        columns = []
        for way in one:
            # All of δ… are over i, the imaginary unit; so is a in the end, times i.
            grown = -rho * pull @ way  # δρ
            rate = np.einsum("a,wb->wab", way, q)
            turn, flow = _parts(rate)
            shear = flow - ONE_THIRD * np.einsum("waa,bc->wbc", flow, one)
            stress = 2.0 * matter.shear * shear + turn @ deviator - deviator @ turn
            stress = stress - (bulk / rho) * grown[:, None, None] * one
            loss = (2.0 / rho**3) * grown[:, None, None]
            flux = stress / rho**2 - loss * sigma
            push = rho * np.einsum("wab,wb->wa", flux, pull)
            push = push + rho * np.einsum("wab,wb->wa", answer * stress / rho**2 - loss * extra, far)
            if self.corrected:
                change = -inverse @ self._moment_change(around, way, sines, still, grown / rho) @ inverse
                push = push + np.einsum("ab,wbc,wc->wa", sigma / rho, change, s)
            straight = 2.0 * mass / rho**2 * (sigma @ own @ _against(still, bent, way))
            straight = straight + 2.0 * mass / rho**2 * (extra @ _against(still, repelled, way))
            columns.append(push - straight.T)
        return np.stack(columns, axis=2)

    @staticmethod
    def _moment_change(around, way, sines, still, thinned):
        """δM/i of a wave along ``way``, by the places of neighbours and by their volumes, (waves, d, d)."""
        sites, r = around.sites, around.r
        step = FINE * around.smoothing_length
        ahead, behind = (-around.volume * around.slope(x) / x for x in (r + step, r - step))
        bend = (ahead - behind) / (2.0 * step) / r
        both = sites[:, :, None] * way
        moved = (bend * (sites @ way))[:, None, None] * sites[:, :, None] * sites[:, None, :]
        moved = moved + around.weight[:, None, None] * (both + both.transpose(0, 2, 1))
        outer = around.weight[:, None, None] * sites[:, :, None] * sites[:, None, :]
        return np.tensordot(sines, moved, 1) - thinned[:, None, None] * np.tensordot(1.0 - still, outer, 1)


def tangent(matter: ElasticMatter) -> np.ndarray:
    """∂P_ij/∂F_kl of Saint Venant and Kirchhoff's law at the stretches, Pa, (d, d, d, d)."""
    one = np.eye(len(matter.stretches))
    f = np.diag(matter.stretches)
    strain = 0.5 * (f @ f - one)
    second = matter.lame * np.trace(strain) * one + 2.0 * matter.shear * strain
    stiff = matter.lame * np.einsum("ab,cd->abcd", one, one)
    stiff = stiff + matter.shear * (np.einsum("ac,bd->abcd", one, one) + np.einsum("ad,bc->abcd", one, one))
    return np.einsum("ik,lj->ijkl", one, second) + np.einsum("ia,ajcl,kc->ijkl", f, stiff, f)


def _parts(rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The skew and the symmetric part of matrices."""
    turned = np.swapaxes(rate, -1, -2)
    return 0.5 * (rate - turned), 0.5 * (rate + turned)


def _against(still: np.ndarray, hessian: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Σ_R H(R) (1 − cos k·R) ξ for a ξ along ``way``, (d, waves)."""
    return (still @ (hessian @ way)).T


def _repulsion(principal: np.ndarray, epsilon: float) -> tuple[np.ndarray, np.ndarray]:
    """−ε max(σ′, 0) of a diagonal stress, (d, d), and the factors of the entries of δσ in its change."""
    pulled = -epsilon * np.maximum(principal, 0.0)
    apart = principal[:, None] - principal
    same = np.abs(apart) <= 1e-12 * np.abs(principal).max(initial=0.0)
    slope = np.where(principal > 0.0, -epsilon, 0.0)
    factors = (pulled[:, None] - pulled) / np.where(same, 1.0, apart)
    return np.diag(pulled), np.where(same, slope[:, None], factors)
