"""Self-gravity: all that has mass and that forces move attracts all else of that."""

from typing import Annotated, Literal, NamedTuple

import pydantic

from psph.acts import MATTER, ONE, SEAM, SYMMETRY, TWO
from psph.engine.jit import register_jitable
from psph.fields import VECTOR, Field
from psph.physics.facts import Facts
from psph.physics.motion import goes_free, is_free, is_rigid
from psph.physics.walls.conditions import EXTRAPOLATED, MIRROR

ATTRACTION = Field("attraction", "m/s2", "pull of all mass that does not move as a whole", VECTOR)
ATTRACTION_ENERGY = Field("attraction_energy", "J/kg", "half of the potential of that pull")
WHOLE_ATTRACTION = Field("whole_attraction", "m/s2", "pull of all mass that moves as a whole", VECTOR)

REACH = 3.0
"""Softening lengths beyond which the pull is Newton's: the potential of a mass at its own place is −Gm/ε."""

STEEPEST = 0.332
"""The largest r g ε², at r = 1.14 ε."""

FINE = 0.05
"""Of ε/|a|, under the root, in a time step."""

MOST = 20_000
"""Particles up to which "auto" takes the direct sum: about a second on one core."""

DIRECT, TREE, AUTO = "direct", "tree", "auto"

BY_SIZE = "h"
"""The softening by the smoothing length of each particle."""

FLAT = (
    "needs three dimensions: the mass of a particle in 1D or 2D is one for each m² or m of depth, whose pull"
)
FLAT += " falls otherwise with distance; set space.dimensions = 3, or take physics.central_force"
UNSEEN = "the mass beyond this plane would pull too, and the sum does not have it; draw all of the scene"
BY_WEIGHT = "walls of this condition continue the pressure by the weight alone; take another condition"


class SelfGravity(NamedTuple):
    """All that moves attracts all else, by its mass.

    a_i = −G Σ_j m_j g(r) x_ij, φ_i = −G Σ_j m_j f(r): the fields of a Wendland C2 kernel of the support H =
    3ε, beyond which they are Newton's (:func:`softened`); by sizes the mean of both fields of a pair, each
    by its own H (:class:`psph.physics.gas.softening.SofteningChange`).  Fluids, soils, solids and rigid
    bodies pull and are pulled; walls, and what else moves as it is told, do neither.  Price & Monaghan
    (2007), Mon. Not. R. Astron. Soc. 374, 1347."""

    acts = MATTER
    refuses = {
        **dict.fromkeys((ONE, TWO), FLAT),
        SEAM: "the images of a period would pull too; take the axis out of space.periodic",
        SYMMETRY: UNSEEN,
        **dict.fromkeys((MIRROR, EXTRAPOLATED), BY_WEIGHT),
    }

    constant: Annotated[
        float,
        pydantic.Field(
            gt=0,
            description="G; 6.674e-11 in nature",
            json_schema_extra={"unit": "m3/(kg s2)"},
        ),
    ]
    softening: Annotated[
        Annotated[float, pydantic.Field(gt=0)] | Literal[BY_SIZE],
        pydantic.Field(
            description="ε: at 0 the potential of a mass m is -Gm/ε, beyond 3ε the pull is Newton's; "
            '"h", of gases: by the support of each particle',
            json_schema_extra={"unit": "m"},
        ),
    ]
    method: Annotated[
        Literal[AUTO, DIRECT, TREE],
        pydantic.Field(
            description="all pairs, or a tree of cells; auto: the tree for more than 20,000 particles"
        ),
    ] = AUTO
    accuracy: Annotated[
        float,
        pydantic.Field(
            gt=0,
            le=0.1,
            description="of a tree: cells of mass M and size b at r count as one if GM b⁴/r⁶ < accuracy |a|",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.003

    def in_scene(self, scene: Facts):
        """The form that particles feel."""
        return MutualPull(self.constant, softening_of(self, scene))


class MutualPull(NamedTuple):
    """All that moves attracts all else, by its mass.

    :class:`SelfGravity` as particles feel it, with ε in m.
    """

    acts = MATTER

    constant: float
    softening: float

    def body(self, i):
        """The pull, m/s², summed before the pass over the neighbours (psph.simulation.attraction)."""
        return i.attraction

    def potential(self, i):
        """Half of the potential, J/kg: each pair has its energy once."""
        return i.attraction_energy

    def strongest(self, mass: float) -> float:
        """The most that a ``mass`` in kg can pull, m/s²: r g has its maximum within the kernel."""
        return STEEPEST * self.constant * mass / self.softening**2


class WholeAttraction(NamedTuple):
    """The same pull, by what moves as a whole.

    Its energy is not in the potential of what it pulls, since the whole moves: its work is booked.
    """

    acts = MATTER
    refuses = SelfGravity.refuses

    constant: float
    softening: float | str
    method: str = AUTO
    accuracy: float = 0.0

    def in_scene(self, scene: Facts):
        """The form that particles feel, where something moves so."""
        some = any(is_whole(one.motion) for one in scene.species)
        return WholePull(self.constant, softening_of(self, scene)) if some else None

    def why_absent(self, scene: Facts):
        """Why it is not there."""
        return "nothing moves as a whole"


class WholePull(NamedTuple):
    """All that moves as a whole attracts all else, by its mass.

    :class:`WholeAttraction` as particles feel it.
    """

    acts = MATTER

    constant: float
    softening: float

    def body(self, i):
        """The pull, m/s²."""
        return i.whole_attraction


def softening_of(told, scene: Facts) -> float:
    """ε, m; of gases by size that of the lattice, a third of the support."""
    by_size = told.softening == BY_SIZE
    return scene.kernel.support * scene.smoothing_length / REACH if by_size else told.softening


def takes_tree(told, count: int) -> bool:
    """Whether a scene of so many particles has a tree, by the table of a case."""
    return told.method == TREE or (told.method == AUTO and count > MOST)


def is_whole(motion) -> bool:
    """Whether forces move particles with such a motion (psph.physics.motion) as a whole."""
    return is_rigid(motion) and goes_free(motion)


def has_own_steps(motion) -> bool:
    """Whether forces move them, and neither the step of the engine nor a pose does."""
    return goes_free(motion) and not is_free(motion) and not is_rigid(motion)


@register_jitable
def softened(r, reach):
    """g in 1/m³ and f in 1/m at the distance r, m, of a mass whose kernel reaches so far, H.

    With u = r/H below 1 g = (14 − 84u² + 140u³ − 90u⁴ + 21u⁵)/H³, f = (3 − 7u² + 21u⁴ − 28u⁵ + 15u⁶ − 3u⁷)/H;
    beyond 1/r³ and 1/r, which are the same at u = 1.
    """
    newton = 1.0 / max(r, reach)
    u = r * newton
    u2 = u * u
    g = 14.0 + u2 * (-84.0 + u * (140.0 + u * (-90.0 + 21.0 * u)))
    f = 3.0 + u2 * (-7.0 + u2 * (21.0 + u * (-28.0 + u * (15.0 - 3.0 * u))))
    return newton * newton * newton * g, newton * f


@register_jitable
def softened_by_both(r, one, other):
    """g and f of a pair whose kernels reach ``one`` and ``other``, m: the mean of both."""
    g, f = softened(r, one)
    g_other, f_other = softened(r, other)
    return 0.5 * (g + g_other), 0.5 * (f + f_other)


@register_jitable
def growing_depth(u):
    """−H² ∂f/∂H at r = u H, 1: 3 − 21u² + 105u⁴ − 168u⁵ + 105u⁶ − 24u⁷, 0 from u = 1 on."""
    u = min(u, 1.0)
    u2 = u * u
    return 3.0 + u2 * (-21.0 + u2 * (105.0 + u * (-168.0 + u * (105.0 - 24.0 * u))))
