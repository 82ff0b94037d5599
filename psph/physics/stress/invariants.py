"""Invariants of a deviatoric stress; in 2D the matter is in plane strain, and s_zz = −(s_xx + s_yy)."""

from psph.formula import helper
from psph.vectors import by_dimension, determinant, norm_squared, trace


@helper
def j2(s, like):
    """J₂ = ½ s:s with s_zz, Pa²; ``like`` is any vector of the dimension."""
    out_of_plane = trace(s, like)  # 0 in 3D
    return 0.5 * (norm_squared(s, like) + out_of_plane * out_of_plane)


j3 = by_dimension(
    lambda s, a: 0.0,
    lambda s, a: -(s[0] + s[2]) * (s[0] * s[2] - s[1] * s[1]),
    lambda s, a: determinant(s, a),
)
"""(s, a) → J₃ = det s with s_zz, Pa³; ``a`` is any vector of the dimension."""
