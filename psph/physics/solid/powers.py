"""Powers of a symmetric matrix with eigenvalues above 0, to full precision where these are alike."""

import numpy as np

from psph.formula import helper, long_helper
from psph.vectors import add, by_dimension, determinant, less_diagonal, norm_squared, scale, trace

ALIKE = 1e-5
"""Of their mean: two eigenvalues so near are one to a divided difference, which is a derivative then."""


@helper
def slope(x, y, p):
    """(x^p − y^p)/(x − y), p((x + y)/2)^{p−1} where these are alike."""
    mean = 0.5 * (x + y)
    if abs(x - y) > ALIKE * mean:
        return (x**p - y**p) / (x - y)
    return p * mean ** (p - 1.0)


@helper
def bend(x, y, z, p):
    """The second divided difference of the power p between x > y > z, half its second derivative where
    these are alike."""
    if x - z > 10.0 * ALIKE * y:
        return (slope(x, y, p) - slope(y, z, p)) / (x - z)
    return 0.5 * p * (p - 1.0) * y ** (p - 2.0)


@long_helper
def power_in_plane(b, p, a):
    """b^p of a plane by its two eigenvalues."""
    middle, half = 0.5 * (b[0] + b[2]), 0.5 * (b[0] - b[2])
    most = middle + np.sqrt(half * half + b[1] * b[1])
    least = determinant(b, a) / most
    per = slope(most, least, p)
    return less_diagonal(scale(b, per), per * most - most**p, a)


@long_helper
def power_in_space(b, p, a):
    """b^p by Newton's interpolation between its three eigenvalues: f₁ + f₁₂(b − λ₁) + f₁₂₃(b − λ₁)(b − λ₂).

    An error of the eigenvalues that are alike does no harm: what it leaves out is f‴ times the
    characteristic polynomial of b.
    """
    mean = trace(b, a) / 3.0
    off = less_diagonal(b, mean, a)
    size = np.sqrt(norm_squared(off, a) / 6.0)
    even = max(size, 1e-300)
    turn = determinant(scale(off, 1.0 / even), a)
    angle = np.arccos(min(max(0.5 * turn, -1.0), 1.0)) / 3.0
    x = mean + 2.0 * size * np.cos(angle)
    z = mean + 2.0 * size * np.cos(angle + 2.0 * np.pi / 3.0)
    y = 3.0 * mean - x - z
    one, two = slope(x, y, p), bend(x, y, z, p)
    first = less_diagonal(b, x, a)
    bent = scale(squared_apart(b, x, y, a), two)
    return less_diagonal(add(scale(first, one), bent), -(x**p), a)


squared_apart = by_dimension(
    lambda m, x, y, a: ((m[0] - x) * (m[0] - y),),
    lambda m, x, y, a: (
        (m[0] - x) * (m[0] - y) + m[1] * m[1],
        m[1] * (m[0] + m[2] - x - y),
        (m[2] - x) * (m[2] - y) + m[1] * m[1],
    ),
    lambda m, x, y, a: (
        (m[0] - x) * (m[0] - y) + m[1] * m[1] + m[2] * m[2],
        m[1] * (m[0] + m[3] - x - y) + m[2] * m[4],
        m[2] * (m[0] + m[5] - x - y) + m[1] * m[4],
        (m[3] - x) * (m[3] - y) + m[1] * m[1] + m[4] * m[4],
        m[4] * (m[3] + m[5] - x - y) + m[1] * m[2],
        (m[5] - x) * (m[5] - y) + m[2] * m[2] + m[4] * m[4],
    ),
)
"""(m, x, y, a) → (m − x)(m − y) of a symmetric matrix."""

power = by_dimension(lambda b, p, a: (b[0] ** p,), power_in_plane, power_in_space)
"""(b, p, a) → b^p of a symmetric matrix with eigenvalues above 0; ``a`` is any vector of the dimension."""
