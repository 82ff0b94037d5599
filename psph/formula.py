"""What formulas are written with, whatever engine computes them.

The operators, whole powers, ``min``, ``max``, ``abs``, ``np.sqrt`` and ``np.exp`` work on numbers and on
several neighbours at once; ``where(condition, a, b)`` replaces a branch.  ``helper`` lets formulas share a
plain function, ``long_helper`` one that LLVM would not write into a loop by itself: what is left as a call
may round differently in a process that compiles and in one that loads the loop from the cache.  An effect
whose own methods are so long says ``written_in = True``.
"""

from psph.engine.jit import inside as long_helper
from psph.engine.jit import register_jitable as helper
from psph.engine.simd import where

__all__ = ["helper", "long_helper", "where"]
