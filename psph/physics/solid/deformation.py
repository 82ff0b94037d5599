"""What the pairs of a solid sum: total Lagrangian SPH, over neighbours in the reference that never change.

With X_ij = X_i − X_j in the reference, x_ij now, g_ij = −W′(|X_ij|)/|X_ij| ≥ 0 and the volumes V,

    L_i = (Σ_j V_j g_ij X_ij X_ijᵀ)⁻¹,   F_i = Σ_j V_j g_ij x_ij X_ijᵀ L_i,
    E = Σ_i w_i V_i ψ(F_i) + ¼ α E_Y Σ_i Σ_j V_i V_j g_ij |F_i X_ij − x_ij|².

F_i is the affine map that fits x_ij best with the weights V_j g_ij.  Therefore the second sum, the hourglass
control with Young's modulus E_Y, gives no force through F_i, and −∂E/∂x_i is

    ρ₀ a_i = Σ_j V_j g_ij [(B_i + B_j) X_ij − αE_Y x_ij],   B_i = ½αE_Y F_i − w_i P_i L_i,

w_i the share of its volume that counts (psph.physics.solid.shares), or 1.

E does not change when all is moved or turned: momentum and angular momentum are kept, whatever L is.
Bonet & Lok (1999), Comput. Methods Appl. Mech. Eng. 180, 97 (L); Vignjevic, Reveles & Campbell (2006), CMES
14, 181; Ganzenmüller (2015), Comput. Methods Appl. Mech. Eng. 286, 87 (hourglass control); Silling (2017),
Comput. Methods Appl. Mech. Eng. 322, 42 (its form as an energy).
"""

from typing import Any, NamedTuple

from psph.fields import REFERENCE, SYMMETRIC, VECTOR, Field
from psph.smoothing import WendlandC2
from psph.vectors import add, dyad, nearest_image, scale, subtract, zero_like

MOMENT = Field("moment", "1", "(Σ_j V_j g_ij X_ij X_ijᵀ)⁻¹ over the neighbours in the reference", SYMMETRIC)
STRESS = Field("stress", "Pa", "Cauchy stress of a solid, tension positive", SYMMETRIC, saved=True)
STRESS_ZZ = Field("stress_zz", "Pa", "Cauchy stress of a solid across the plane of 2D", saved=True)
VON_MISES = Field("von_mises", "Pa", "von Mises stress of a solid", saved=True)
STORED = Field("stored_energy", "J", "energy of deformation, with that of the hourglass control")
DRAWN = Field("drawn", "m/s2", "acceleration by the loads of a case at their full size", VECTOR)
PULLED = Field("pulled", "m/s2", "the part of it by loads that keep their direction", VECTOR)
PUSHED = Field("pushed", "m/s2", "the part of it by pressures, before faces have turned and grown", VECTOR)

INERTIA = Field("inertia", "kg", "true mass of a particle; of a solid in a fluid its mass is the fluid's")

OF_SOLIDS = (REFERENCE, MOMENT, STRESS, VON_MISES, STORED)
"""What particles carry only where a scene has solids; DRAWN where these have loads, PULLED and PUSHED
where one is a pressure, INERTIA where these are in a fluid, STRESS_ZZ in plane strain."""

KERNEL, SMOOTHING = "wendland-c2", 2.0**0.5
"""A solid's own kernel and its h/dx: its lists have no part in those of fluids."""

HOURGLASS, SHARED_HOURGLASS = 1.5, 0.75
"""The default α, and that beside shares, which make up for a part of what faces lose."""


class ReferencePair(NamedTuple):
    """Geometry of an ordered pair in the reference: ``X_ij`` in m, and V_j g_ij in 1/m²."""

    apart: Any
    weight: Any


class Gradient(NamedTuple):
    """Σ_j V_j g_ij x_ij X_ijᵀ; ``periods`` m, None for an open axis."""

    periods: tuple

    def start(self, i):
        """Nothing yet."""
        return zero_like(dyad(i.reference, i.reference))

    def gather(self, total, i, j, pair):
        """With neighbour j, by rows."""
        x_ij = nearest_image(subtract(i.position, j.position), self.periods)
        return add(total, dyad(scale(x_ij, pair.weight), pair.apart))


class GradientRate(NamedTuple):
    """Σ_j V_j g_ij v_ij X_ijᵀ, the rate of :class:`Gradient`; only damped solids ask for it."""

    def start(self, i):
        """Nothing yet."""
        return zero_like(dyad(i.reference, i.reference))

    def gather(self, total, i, j, pair):
        """With neighbour j, by rows."""
        v_ij = subtract(i.predicted_velocity, j.predicted_velocity)
        return add(total, dyad(scale(v_ij, pair.weight), pair.apart))


def pressure_of(stress, across, dimensions: int):
    """−tr σ/3, Pa (n,), of the components of a Cauchy stress (n, dim(dim + 1)/2) by rows from the diagonal on
    and, in plane strain, σ_zz ``across`` (n,); in 3D that is among them."""
    diagonal = [0, 2] if dimensions == 2 else [0, 3, 5]
    return -(stress[:, diagonal].sum(axis=1) + (across if dimensions == 2 else 0.0)) / 3.0


def support_of(smoothing_length: float) -> float:
    """How far neighbours in the reference are, m."""
    return WendlandC2.support * smoothing_length


def places_of(dimensions: int, damped: bool) -> tuple[int, int]:
    """Numbers in a record of the first and of the second pass."""
    return dimensions * (3 if damped else 2), dimensions * (2 + dimensions)
