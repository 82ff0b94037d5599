"""An artificial stress against the clumping of what resists shear and is pulled."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import register_jitable
from psph.fields import SYMMETRIC, Stress
from psph.fields import Field as Declared
from psph.vectors import add, by_dimension, less_diagonal, outer, scale, times

REPULSION = Declared(
    "repulsion", "m5/(kg s2)", "−ε σ′/ρ² of the principal stresses σ′ > 0", SYMMETRIC, image=Stress
)

TURNS = 15
"""Turns of Jacobi, three a sweep: five sweeps find eigenvectors to rounding."""

NO_STRESS = 1e-300
"""Keeps equal principal stresses from dividing by zero, Pa."""


class PrincipalStress(NamedTuple):
    """Near neighbours repel along the directions in which they are pulled, in proportion to the tension.

    a_i = Σ_j m_j (R_i + R_j)(W_ij/W(dx))⁴ ∇W_ij, where R has −εσ′/ρ² for each principal stress σ′ > 0 of
    σ = s − p1, and 0 for the others; R is that of the pass before.  Gray, Monaghan & Swift (2001), Comput.
    Methods Appl. Mech. Eng. 190, 6641, with ε = 0.3.  ``inverse_near`` is 1/W(dx), m^d.
    """

    conserves = ("momentum",)

    epsilon: float
    inverse_near: float

    writes = REPULSION
    lagged = True

    def start(self, i):
        """It is a particle's own."""
        return 0.0

    def gather(self, total, i, j, pair):
        """No neighbour counts."""
        return total

    def finish_value(self, total, i, kernel):
        """R_i, m⁵/(kg s²) in 3D."""
        size = -self.epsilon * i.specific_volume * i.specific_volume
        return scale(pulled(less_diagonal(i.deviator, i.pressure, i.position), i.position), size)

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        nearness = pair.w * self.inverse_near
        return scale(times(add(i.repulsion, j.repulsion), pair.x_ij), nearness**4 * pair.m_dw_r)


def _pulled(m, a):
    return (max(m[0], 0.0),)


def _pulled_in_plane(m, a):
    mean, half = 0.5 * (m[0] + m[2]), 0.5 * (m[0] - m[2])
    q = np.sqrt(half * half + m[1] * m[1])
    large, small = max(mean + q, 0.0), max(mean - q, 0.0)
    both, part = 0.5 * (large + small), 0.5 * (large - small) / max(q, NO_STRESS)
    return both + part * half, part * m[1], both - part * half


@register_jitable
def _turned(m, u, v, w):
    """A turn of Jacobi in the plane of the first two axes, which then become the last and the first."""
    apart = m[3] - m[0]
    root = np.sqrt(apart * apart + 4.0 * m[1] * m[1])
    t = 2.0 * m[1] / (apart + np.copysign(root, apart) + np.copysign(NO_STRESS, apart))
    c = 1.0 / np.sqrt(1.0 + t * t)
    s = t * c
    turned = (m[3] + t * m[1], s * m[2] + c * m[4], 0.0, m[5], c * m[2] - s * m[4], m[0] - t * m[1])
    return turned, add(scale(u, s), scale(v, c)), w, add(scale(u, c), scale(v, -s))


def _pulled_in_space(m, a):
    u, v, w = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    for _ in range(TURNS):
        m, u, v, w = _turned(m, u, v, w)
    first, second = scale(outer(u), max(m[0], 0.0)), scale(outer(v), max(m[3], 0.0))
    return add(add(first, second), scale(outer(w), max(m[5], 0.0)))


pulled = by_dimension(_pulled, _pulled_in_plane, _pulled_in_space)
"""(m, a) → m with 0 in the place of its negative eigenvalues; ``a`` is any vector of the dimension."""
