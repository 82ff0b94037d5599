"""Walls remember from where lines of contact came: between two angles a line stays where it is.

A line that advances does so at a larger angle than one that recedes, and in between it rests: Dussan (1979),
Annu. Rev. Fluid Mech. 11, 371.  So a drop sticks to a tilted wall while its weight along it is less than
σ (cos φ_r − cos φ_a) by the width of its lines: Furmidge (1962), J. Colloid Sci. 17, 309.  As the friction of
solids (psph.physics.solid.contact) that is a spring with a limit, but it hangs at the places of the wall: the
memory is not of the particles of the fluid, which are stirred, and depends on places alone, not on steps.
psph's own.
"""

from typing import NamedTuple

import numpy as np

from psph.acts import FLUIDS
from psph.fields import Field, Same
from psph.formula import where
from psph.moments import sites_around
from psph.physics.facts import Facts
from psph.physics.surface.tension import SurfaceTension

STRETCH = 0.25
"""Of the wetness of a place, by which a line is moved when it pulls with all that it can: some ½ spacing."""

DRY, WET = 0.01, 0.97
"""Wetness below and above which a place has no line, and forgets: disorder leaves 0.97."""

LEAST = 0.05
"""Of all neighbours, that of those beyond the wall that is taken at least: deep rows see few."""

UNKNOWN = -9.0
"""At ease nowhere yet."""

LINE_COSINE = Field(
    "line_cosine", "1", "cosine of the angle of lines of contact at the place, of a wall or body", image=Same
)
LINE_EASE = Field(
    "line_ease", "1", "wetness of the place at which its line is at ease", start=UNKNOWN, image=Same
)


class LineMemory(NamedTuple):
    """Walls remember from where lines of contact came, so that drops stick.

    cos φ_w = ½(cos φ_r + cos φ_a) − ½(cos φ_r − cos φ_a) (f_w − f⁰_w)/¼, that fraction −1 to 1.  f_w, the
    wetness, is Σ V_j (1 − r²/R²) over the heavier fluid over that over all that is not wall, f⁰ = 3f − 1 of
    the time when the place was last all dry or all wet, or of the start: a line that comes over dry wall
    advances, one that comes over wet wall recedes, and that of the start is at ease in between.
    """

    acts = (FLUIDS,)
    refuses = SurfaceTension.refuses

    def in_scene(self, scene: Facts):
        """The form that knows the lattice and the heavier fluid; None where each wall has one angle."""
        if SurfaceTension().in_scene(scene) is None or not any(one.wetting_range for one in scene.species):
            return None
        inverse = (scene.kernel.inverse_h / scene.kernel.support) ** 2
        sites = np.array([*sites_around(scene.kernel, scene.spacing, scene.dimensions)], float)
        shares = 1.0 - ((sites * scene.spacing) ** 2).sum(axis=1) * inverse
        full = float(np.maximum(shares, 0.0).sum()) * scene.spacing**scene.dimensions
        heaviest = max((one for one in scene.species if one.fluid), key=lambda one: (one.density, -one.fluid))
        return PlacesOfLines(inverse, full, float(heaviest.fluid))

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "no wall has one angle for lines that advance and one for others, or no fluid a tension"


class PlacesOfLines(NamedTuple):
    """Walls remember from where lines of contact came, so that drops stick.

    The form of :class:`LineMemory` in a scene: ``inverse`` is 1/R² in 1/m², ``full`` Σ dx^d (1 − r²/R²) over
    the lattice in m^d, and ``heaviest`` the number of the fluid that wets.
    """

    inverse: float
    full: float
    heaviest: float

    writes = (LINE_COSINE, LINE_EASE)

    def start(self, i):
        """Nothing of the heavier fluid, nothing of walls."""
        return 0.0, 0.0

    def gather(self, total, i, j, pair):
        """Take neighbour j into each."""
        share = j.specific_volume * j.mass * max(1.0 - pair.r2 * self.inverse, 0.0)
        apart = j.fluid - self.heaviest
        return total[0] + share * max(1.0 - apart * apart, 0.0), total[1] + share * (1.0 - j.is_fluid)

    def finish_value(self, total, i, kernel):
        """cos φ, and f⁰; of a fluid 0."""
        wetness = min(total[0] / max(self.full - total[1], LEAST * self.full), 1.0)
        has_line = where(wetness > DRY, 1.0, 0.0) * where(wetness < WET, 1.0, 0.0)
        knows = has_line * where(i.line_ease > 0.5 * UNKNOWN, 1.0, 0.0)
        ease = where(knows > 0.5, i.line_ease, 3.0 * wetness - 1.0)
        pulled = min(max((wetness - ease) / STRETCH, -1.0), 1.0)
        rigid = 1.0 - i.is_fluid
        return rigid * (i.wetting - i.wetting_range * pulled), rigid * ease
