"""A guest: an effect of two passes with sums of the same step.  Surface tension by curvature.

n_i = h Σ_j V_j ∇W_ij comes first; then, with the normals of this very step, a_i = −γ Σ_j (n_i − n_j)
where j is in reach.  After Akinci, Akinci & Teschner (2013), ACM Trans. Graph. 32, 182.
"""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.fields import VECTOR, Turned
from psph.fields import Field as Declared
from psph.physics.catalogue import Catalogue, Entry
from psph.vectors import add, scale, subtract, zero_like


class Curvature(NamedTuple):
    """A surface pulls itself flat."""

    strength: Annotated[float, Field(ge=0, description="strength γ", json_schema_extra={"unit": "m^d/s2"})]

    writes = Declared("normal", "1", "h times the gradient of the kernel sum", VECTOR, image=Turned)

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add V_j ∇W_ij."""
        return add(total, scale(pair.x_ij, j.specific_volume * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """n_i."""
        return scale(total, i.smoothing_length)

    def push(self, i, j, pair):
        """−γ W_ij (n_i − n_j), m/s²."""
        return scale(subtract(i.normal, j.normal), -self.strength * pair.w)


CATALOGUE = Catalogue(effects=(Entry("physics.curvature", Curvature),))
