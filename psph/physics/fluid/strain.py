"""The rate of strain of a flow, from the velocities of neighbours: exact where the flow is linear."""

from psph.formula import helper
from psph.vectors import (
    add,
    adjugate,
    determinant,
    dyad,
    matrix_product,
    outer,
    scale,
    symmetric_part,
    zero_like,
)

FEWEST = 0.1
"""Determinant of M, about 1 on a lattice, below which the rate of strain fades."""


@helper
def no_rate(i):
    """No neighbour yet: velocity differences, and how they lie."""
    return dyad(zero_like(i.position), zero_like(i.position)), outer(zero_like(i.position))


@helper
def rate_weight(j, pair):
    """−V_j W′/r: what neighbour j weighs in both sums."""
    return -j.specific_volume * pair.m_dw_r


@helper
def take_rate(total, pair, u_ij, moving, lying):
    """Add −V_j u_ij ∇W_ijᵀ and −V_j x_ij ∇W_ijᵀ of a neighbour with these weights."""
    change = scale(dyad(u_ij, pair.x_ij), moving)
    return add(total[0], change), add(total[1], scale(outer(pair.x_ij), lying))


@helper
def linear_gradient(total, i, least=FEWEST):
    """−Σ_j V_j u_ij ∇W_ijᵀ M⁻¹, M = −Σ_j V_j x_ij ∇W_ijᵀ, by rows, 1/s; fades where det M < ``least``."""
    changes, place = total
    size = max(determinant(place, i.position), least)
    inverse = scale(adjugate(place, i.position), 1.0 / size)
    return matrix_product(changes, inverse, i.position)


@helper
def linear_rate(total, i):
    """E, the symmetric part of :func:`linear_gradient`, 1/s."""
    return symmetric_part(linear_gradient(total, i), i.position)
