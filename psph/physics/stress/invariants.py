"""Invariants of a deviatoric stress; in 2D the matter is in plane strain, and s_zz = −(s_xx + s_yy)."""

from psph.formula import helper
from psph.vectors import norm_squared, trace


@helper
def j2(s, like):
    """J₂ = ½ s:s with s_zz, Pa²; ``like`` is any vector of the dimension."""
    out_of_plane = trace(s, like)  # 0 in 3D
    return 0.5 * (norm_squared(s, like) + out_of_plane * out_of_plane)
