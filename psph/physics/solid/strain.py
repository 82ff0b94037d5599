"""What follows from the deformation gradient F: its dilation J, what of it is elastic, and the stress P of τ.

A history C_p⁻¹, the inverse of the part of C = FᵀF that does no work, is symmetric, turns with nothing, and
gives the elastic strain whatever the turn of the solid: b = J^{−2/3} F C_p⁻¹ Fᵀ (psph.physics.solid.plastic).
"""

import numpy as np

from psph.engine.jit import overload, register_jitable
from psph.formula import where
from psph.vectors import (
    cofactor,
    determinant,
    dot,
    first_row,
    less_diagonal,
    matrix_product,
    norm_squared,
    product_transposed,
    scale,
    transposed,
)


@register_jitable
def dilation(f, a):
    """J = det F; 1 for an F of zeros, that of a particle whose neighbours do not span space: no stress."""
    volume = dot(first_row(f, a), first_row(cofactor(f, a), a))
    return where(volume == 0.0, 1.0, volume)


@register_jitable
def nominal(kirchhoff, f, volume, a):
    """P = τ F⁻ᵀ by rows of a symmetric τ in Pa."""
    inverse = scale(transposed(cofactor(f, a), a), 1.0 / volume)
    return transposed(matrix_product(inverse, kirchhoff, a), a)


@register_jitable
def elastic_part(f, metric, volume, a):
    """b = J^{−2/3} F C_p⁻¹ Fᵀ, and in plane strain b_zz, where det C_p⁻¹ = 1; 0 in 3D."""
    whole = less_diagonal(metric, -1.0, a)
    even = np.abs(volume) ** (-2.0 / 3.0)
    b = scale(product_transposed(matrix_product(f, whole, a), f, a), even)
    return b, only_in_plane(even / determinant(whole, a), a)


@register_jitable
def history_of(b, b_zz, f, volume, a):
    """C_p⁻¹ − 1 = J^{2/3} F⁻¹ b F⁻ᵀ − 1 of the deviator of b, whose trace is such that det b = 1."""
    unit = unit_trace(b, b_zz, a)
    inverse = scale(transposed(cofactor(f, a), a), 1.0 / volume)
    again = matrix_product(inverse, less_diagonal(b, -unit, a), a)
    metric = scale(product_transposed(again, inverse, a), np.abs(volume) ** (2.0 / 3.0))
    return less_diagonal(metric, 1.0, a)


def only_in_plane(value, a):
    """``value`` in plane strain, 0 in 3D, where what is across is among the components."""
    return value if len(a) < 3 else 0.0


@register_jitable
def unit_trace(s, s_zz, a):
    """m for which det(s + m1) = 1, s the deviator of three dimensions: m³ − m s:s/2 + det s = 1."""
    half, third = 0.5 * (norm_squared(s, a) + s_zz * s_zz), whole_determinant(s, s_zz, a)
    m = 1.0
    for _ in range(6):
        m -= (m * m * m - m * half + third - 1.0) / (3.0 * m * m - half)
    return m


def whole_determinant(s, s_zz, a):
    """det s of three dimensions."""
    return determinant(s, a) * s_zz if len(a) < 3 else determinant(s, a)


@overload(only_in_plane)
def _typed_only_in_plane(value, a):
    return (lambda value, a: value) if len(a) < 3 else (lambda value, a: 0.0)


@overload(whole_determinant)
def _typed_whole_determinant(s, s_zz, a):
    if len(a) < 3:
        return lambda s, s_zz, a: determinant(s, a) * s_zz
    return lambda s, s_zz, a: determinant(s, a)
