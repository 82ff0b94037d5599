"""Discrete forms of the acceleration −∇p/ρ, and a pressure that all particles share."""

from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from psph.acts import MATTER
from psph.fields import Field as Declared
from psph.fields import Same
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.parting import Hold, Holding, felt, hold_of
from psph.physics.fluid.several import (
    CorrectedVolumeBackground,
    VolumeBackground,
    VolumePressure,
    facing_of,
    several,
)
from psph.smoothing import KERNELS, weight
from psph.theory.stability import parts
from psph.vectors import add, scale, times, zero_like

NOT_A_PRESSURE = 1e30
"""Stands for a neighbour outside the support in a minimum over pressures, Pa."""


AUTO = "auto"
"""A background pressure that follows from the scene."""

MARGIN = 1.4
"""Such a pressure over what the scene is known to need."""

BORNE = 0.1
"""The same over ρ₀c² of the softest of several fluids, at most: at 1.0 its particles lose their order."""


EDGE = 0.9
"""Kernel sum below which a particle is at a surface: the last row of a square lattice has 0.73 to
0.88, one inside 0.91 or more, even in a lattice jittered by 10 %, over the kernels and h/dx in use."""


class SymmetricPressure(NamedTuple):
    """Pressure gradient, symmetric in the pair: conserves momentum exactly.

    a_i = −Σ_j m_j (p_i/ρ_i² + p_j/ρ_j²) ∇W_ij.  SSPH paper, eq. (6); Monaghan (1992), eq. (3.3).
    ``walls`` say what stands for p beside them (psph.physics.fluid.parting).
    """

    conserves = ("momentum", "angular momentum")

    walls: Hold = Holding()

    def in_scene(self, scene: Facts):
        """The form that knows whether walls hold the fluid, and whether there are several."""
        walls = hold_of(scene)
        return VolumePressure(walls, facing_of(scene)) if several(scene) else SymmetricPressure(walls)

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        own, other = felt(self.walls, i, j)
        return -(own + other) * pair.m_dw_r

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


UNEQUAL = {
    one: f'the stress of {one} is symmetric in a pair; use "symmetric"' for one in MATTER if one.stressed
}
"""Beside what forms that are not symmetric in a pair do not work."""


class MinimumPressure(NamedTuple):
    """Pressure gradient relative to the smallest neighbour pressure (p⁻): pairs only repel.

    a_i = −Σ_j m_j/(ρ_i ρ_j) (p_j − p_i⁻) ∇W_ij, p_i⁻ = min_j p_j over every neighbour, ghosts and
    walls included.  SSPH paper, eq. (15).  One pass: the sum is taken relative to p_i, and
    (p_i − p_i⁻) Σ_j m_j/ρ_j ∇W_ij, known when the minimum is, follows at the end.
    Conserves neither momentum nor energy; unstable with a free surface.
    """

    refuses = UNEQUAL

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the part relative to p_i, 1/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        return (i.pressure - j.pressure) * v_i * (v_j * pair.m_dw_r)

    def start(self, i):
        """Smallest pressure so far, and Σ_j m_j/ρ_j ∇W_ij."""
        return NOT_A_PRESSURE, zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take neighbour j into both."""
        inside = where(pair.m_dw_r < 0.0, j.pressure, NOT_A_PRESSURE)
        gradient = scale(pair.x_ij, j.specific_volume * pair.m_dw_r)
        return min(total[0], inside), add(total[1], gradient)

    def join(self, a, b):
        """Both over two sets of neighbours."""
        return min(a[0], b[0]), add(a[1], b[1])

    def finish_acceleration(self, total, i):
        """−(p_i − p_i⁻)/ρ_i Σ_j m_j/ρ_j ∇W_ij, m/s²."""
        return scale(total[1], (total[0] - i.pressure) * i.specific_volume)

    @staticmethod
    def conflicts(physics, kernel):
        """Where the kernel rises with the distance, pairs would attract."""
        if not getattr(KERNELS[kernel], "repels", True):
            yield (
                "needs a kernel whose pairs only repel, and pairs attract in a part of the kernel "
                f"{kernel}; choose another kernel"
            )

    @staticmethod
    def warns(scene: Facts):
        """A free surface flies apart."""
        if scene.has_free_surface:
            yield (
                '"minimum" is unstable at a free surface, where it only pushes '
                'outward, and the fluid has one; use "symmetric", or enclose the fluid'
            )

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


class DifferencePressure(NamedTuple):
    """Pressure gradient from differences: exact for a constant, whatever the order of particles.

    a_i = −Σ_j m_j/(ρ_i ρ_j) (p_j − p_i) ∇W_ij.  Monaghan (1992), Annu. Rev. Astron. Astrophys. 30,
    543.  The symmetric form errs by 2p/ρ Σ_j m_j/ρ_j ∇W_ij, which a finer spacing does not cure;
    this one does not hold particles apart, so shift them.  Conserves neither momentum nor energy
    exactly.
    """

    refuses = UNEQUAL

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        return (i.pressure - j.pressure) * v_i * (v_j * pair.m_dw_r)

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


class TensileControl(NamedTuple):
    """Pressure gradient that pulls no pair together inside a fluid under tension.

    a_i = −Σ_j m_j/(ρ_i ρ_j) (p_j + s p_i) ∇W_ij, s = −1 where p_i < 0 inside the fluid, else 1.  The
    tensile instability control of Sun, Colagrossi, Marrone, Antuono & Zhang (2018), Comput. Phys.
    Commun. 224, 63.  Inside is where the kernel sum of the pass before, the particle
    included, is at least 0.9; they tell a surface, and what is near it, by the eigenvalues of a
    matrix, and shift particles besides.  Momentum is conserved where s = 1 alone.
    """

    refuses = UNEQUAL

    writes = Declared("inside", "1", "1 inside the fluid, 0 at a free surface", image=Same)
    lagged = True

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add W_ij m_j/ρ_j."""
        return total + j.mass * j.specific_volume * pair.w

    def finish_value(self, total, i, kernel):
        """1 inside the fluid, 0 at a surface."""
        own = weight(kernel, 0.0) * i.mass * i.specific_volume
        return where(total + own < EDGE, 0.0, 1.0)

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        sign = where(i.pressure < 0.0, 1.0 - 2.0 * i.inside, 1.0)
        both = (sign * i.pressure + j.pressure) * i.specific_volume
        return -both * (j.specific_volume * pair.m_dw_r)

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


class BackgroundPressure(NamedTuple):
    """A constant pressure pushes particles apart: it keeps a closed fluid from tearing.

    a_i = −p_b Σ_j m_j (1/ρ_i² + 1/ρ_j²) ∇W_ij: the symmetric form of p + p_b, while p itself, as
    given and as saved, stays free of p_b.  Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214.
    Σ_j ∇W_ij/ρ_j would vanish for particles in perfect order; where it does not, p_b restores order
    at the price of noise.  It conserves momentum and, being constant, energy.  A free surface would
    fly apart.  "auto" is 1.4 times what the start lacks to p = 0, or what its fastest flow can make it
    lack, ρ₀v²/2; with corrected gradients, which hold the tension of a flow, what the start lacks
    everywhere; and nothing where there is a free surface.
    """

    conserves = ("momentum", "angular momentum")

    pressure: Annotated[
        Annotated[float, Field(ge=0)] | Literal["auto"],
        Field(
            description='p_b, at least as large as the strongest tension, or "auto"',
            json_schema_extra={"unit": "Pa"},
        ),
    ]

    def in_scene(self, scene: Facts):
        """With "auto", what the scene needs, or None; with corrected gradients, the form that has them."""
        needed = self._needed(scene) if self.pressure == AUTO else self.pressure
        if needed is None:
            return None
        if several(scene):
            corrected = is_corrected(scene)
            return (
                CorrectedVolumeBackground(needed, facing_of(scene)) if corrected else VolumeBackground(needed)
            )
        return CorrectedBackground(needed) if is_corrected(scene) else BackgroundPressure(needed)

    def _needed(self, scene: Facts) -> float | None:
        """What the start and its flow may lack, Pa, or None."""
        if scene.has_free_surface:
            return None
        dip = 0.5 * max(m.density for m in scene.species) * scene.starting_speed**2
        lacking = scene.standing_tension if is_corrected(scene) else max(-scene.lowest_pressure, dip)
        if lacking <= 0.0:
            return None
        softest = min(one.density * one.sound_speed**2 for one in scene.species)
        return min(MARGIN * lacking, BORNE * softest) if several(scene) else MARGIN * lacking

    def why_absent(self, scene: Facts):
        """Why "auto" gives none."""
        if scene.has_free_surface:
            return "the fluid has a free surface, which it would blow apart"
        if is_corrected(scene):
            return "corrected gradients hold what its flow pulls, and the start lacks no more"
        return "no pressure is negative at the start, and nothing moves"

    @staticmethod
    def warns(scene: Facts):
        """A free surface flies apart where the case gives the pressure itself."""
        if scene.physics.background_pressure.pressure != AUTO and scene.has_free_surface:
            yield "blows a free surface apart, and the fluid has one; leave it out, or enclose the fluid"

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        return -self.pressure * (v_i * v_i + v_j * v_j) * pair.m_dw_r

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearBackground(self.pressure)


def is_corrected(scene: Facts) -> bool:
    """Whether the symmetric pressure gradient takes corrected gradients."""
    physics = scene.physics
    return physics.gradient_correction is not None and physics.pressure_gradient == "symmetric"


class CorrectedBackground(NamedTuple):
    """A constant pressure pushes particles apart, with corrected gradients.

    a_i = −p_b Σ_j m_j (L_i/ρ_i² + L_j/ρ_j²) ∇W_ij, as the pressure itself has them under
    :class:`psph.physics.fluid.correction.GradientCorrection`: were p corrected and p_b not, disorder
    would feel −p(L − 1), and a fluid under tension would tear in spite of p_b.  It conserves momentum.
    """

    conserves = ("momentum",)

    pressure: float

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        both = add(scale(i.gradient_correction, v_i * v_i), scale(j.gradient_correction, v_j * v_j))
        whole = add(scale(pair.x_ij, v_i * v_i + v_j * v_j), times(both, pair.x_ij))
        return scale(whole, -self.pressure * pair.m_dw_r)

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearBackground(self.pressure)
