"""What formulas are written with, whatever engine computes them.

The operators, whole powers, ``min``, ``max``, ``abs``, ``np.sqrt`` and ``np.exp`` work on numbers and on
several neighbours at once; ``where(condition, a, b)`` replaces a branch.  ``helper`` lets formulas share a
plain function.
"""

from psph.engine.jit import register_jitable as helper
from psph.engine.simd import where

__all__ = ["helper", "where"]
