"""Density that remembers how densely the particles lie."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS, MADE_FOR_FLUIDS
from psph.fields import Field as Declared
from psph.fields import Same
from psph.formula import helper, where
from psph.moments import moments_below_a_surface
from psph.physics.facts import Facts
from psph.physics.fluid.buffers import open_ended
from psph.physics.fluid.several import several
from psph.physics.walls.conditions import BEARING, MIRROR

SPARSE, NEARLY_FULL = 0.97, 0.99
"""Fullness below which a particle is near a surface, at least; and from which a row below a plane surface is
taken for full."""

FULLNESS = Declared("fullness", "1", "volume of the neighbours over that of a whole lattice", image=Same)


class SummationDensity(NamedTuple):
    """Density returns slowly to the one that the places of the particles give.

    dρ_i/dt = β c/h ρ_i (f_i − f̂_i), f_i = Σ_j m_j/ρ_j r W′ over what Σ dx^d r W′ is on the lattice, and
    f̂ the f nearest to it that the scene starts with; nothing near a surface, where f is less than half-way
    between the rows that a plane surface makes sparse and those below (0.97 with the default scheme in 2D,
    whose second row has 0.94; 0.98 in 3D).
    Without it nothing ties the density of the continuity equation to the places: where particles are in
    disorder a fluid sinks together under its weight, and its density does not know.  Colagrossi &
    Landrini (2003), J. Comput. Phys. 191, 448, renew the density every so many steps for such reasons;
    Zhang, Rezavand & Hu (2020), J. Comput. Phys. 404, 109135, take the sum in every step.  The slow
    form is psph's own: sound, in which f stays 1, does not feel it.  f is right on average: it is 0.999
    among particles that a flow has mixed; single ones differ by some thousandths, which costs vortices
    accuracy.  So it is left out where no free surface, nor a lighter fluid, lets the fluid sink, and no open
    end lets more or fewer particles come than go (without it 1.9 % more stand about the cylinder at
    Reynolds number 20 after 12 s); before walls that bear no pressure, whose rows are not full; and beside
    matter with an evolved stress.
    """

    acts = (FLUIDS, *BEARING, MIRROR)
    refuses = MADE_FOR_FLUIDS

    rate: Annotated[
        float,
        Field(
            ge=0,
            le=0.1,
            description="β: share of the difference that is gone in h/c",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.002

    def in_scene(self, scene: Facts):
        """The form that knows the lattice and the start."""
        if not _applies(scene):
            return None
        *rows, full = moments_below_a_surface(scene.kernel, scene.spacing, scene.dimensions)
        sparse, deepest = around_a_surface([row / full for row in rows])
        low, high = scene.starting_fullness
        return SummedOnLattice(self.rate, full, min(low, deepest), high, sparse)

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        return (
            "it needs a free surface, several fluids or open ends, bearing walls, and no matter with an "
            "evolved stress"
        )


class SummedOnLattice(NamedTuple):
    """Density returns slowly to the one that the places of the particles give.

    The form of :class:`SummationDensity` in a scene: ``full`` is Σ dx^d r W′ over its lattice, ``low`` and
    ``high`` the smallest and the largest f that it starts with; where f < ``sparse`` a surface is near.
    """

    rate: float
    full: float
    low: float
    high: float
    sparse: float

    writes = FULLNESS
    lagged = True
    slow = True
    held = True

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add V_j r W′."""
        return total + _share(j, pair)

    def finish_value(self, total, i, kernel):
        """f."""
        return total / self.full

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s): what it has of f."""
        settled = min(max(i.fullness, self.low), self.high)
        excess = where(i.fullness > self.sparse, i.fullness - settled, 0.0) * i.is_fluid
        strength = self.rate / self.full * i.sound_speed / i.smoothing_length
        return strength * excess / i.specific_volume * _share(j, pair)

    def linear(self, scene: Facts):
        """It does not act on a small disturbance."""
        return None


def around_a_surface(rows: list[float]) -> tuple[float, float]:
    """Fullness below which a particle is near a surface, and the smallest of a row that is not.

    ``rows``: fullness of the first, second ... row of the lattice below a plane surface.
    """
    deepest = min([row for row in rows if row >= NEARLY_FULL], default=1.0)
    sparse = max(row for row in rows if row < NEARLY_FULL)
    return max(SPARSE, 0.5 * (sparse + deepest)), deepest


def _applies(scene: Facts) -> bool:
    loosens = scene.has_free_surface or several(scene) or open_ended(scene)
    return loosens and all(one.bearing and not one.shear_modulus for one in scene.species)


@helper
def _share(j, pair):
    return j.specific_volume * pair.m_dw_r * pair.r2
