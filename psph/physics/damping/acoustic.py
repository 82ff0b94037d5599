"""A bulk viscosity: sound fades, and a flow that keeps its volume does not feel it."""

from typing import Annotated, Any, NamedTuple

from pydantic import Field

from psph.engine.jit import call_by_type
from psph.fields import Field as Declared
from psph.fields import Same
from psph.moments import fastest_wave
from psph.physics.facts import Facts
from psph.physics.fluid.pressure import is_corrected
from psph.physics.fluid.several import Facing, facing_of, in_volumes, several, shares
from psph.vectors import add, dot, scale, times

STABLE = 0.6
"""(1 + α) (hK)² cΔt/h stays below, K the fastest wave of the kernel on its lattice (psph.moments), 1/m; hK is
1.1 for Wendland C2.  The rate of compression is that of the pass before; with α = 0.3 and 0.5 h/c a tank of
water gains energy, with 0.3 at 0.4 and 1.0 at 0.25 it does not."""


class AcousticDamper(NamedTuple):
    """A pressure that opposes the rate of compression: it damps sound and impacts, and not shear.

    q_i = α h c dρ_i/dt, of a fluid and with the dρ/dt of :class:`Continuity
    <psph.physics.fluid.continuity.Continuity>` alone in the pass before, acts as a pressure beside p:
    a_i = −Σ_j m_j (q_i/ρ_i² + q_j/ρ_j²) ∇W_ij, with corrected gradients in both where the pressure has
    them.  It takes Σ_i m_i α h c (dρ_i/dt)²/ρ_i² from the motion.  It does not see the shortest waves, whose
    divergence a sum over neighbours misses.  Sun, Pilloton, Antuono & Colagrossi (2023), J. Comput.
    Phys. 483, 112056.  It conserves momentum, and angular momentum too without corrected gradients.
    """

    conserves = ("momentum", "angular momentum")
    brakes = True

    alpha: Annotated[float, Field(ge=0, description="coefficient α", json_schema_extra={"unit": "1"})] = 0.3

    writes = Declared("compression", "Pa", "pressure against the rate of compression", image=Same)
    lagged = True

    def in_scene(self, scene: Facts):
        """With corrected gradients, and for several fluids, the form that has them."""
        if several(scene):
            return VolumeDamper(self.alpha, facing_of(scene), ByL() if is_corrected(scene) else AsTheyAre())
        return CorrectedDamper(self.alpha) if is_corrected(scene) else self

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add a neighbour's share of dρ_i/dt."""
        return total + pair.u_dot_x * pair.m_dw_r

    def finish_value(self, total, i, kernel):
        """q_i, Pa."""
        return self.alpha * i.smoothing_length * i.sound_speed * total * i.is_fluid

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        return -(i.compression * v_i * v_i + j.compression * v_j * v_j) * pair.m_dw_r

    def longest_step(self, scene):
        """Δt ≤ 0.6/((1 + α) h K² c), s: see STABLE."""
        wave = fastest_wave(scene.kernel, scene.spacing, scene.dimensions)
        return STABLE / ((1.0 + self.alpha) * scene.smoothing_length * wave**2 * scene.sound_speed)


class CorrectedDamper(NamedTuple):
    """A pressure against the rate of compression, with corrected gradients.

    As :class:`AcousticDamper`: dρ_i/dt takes L_i, and a_i = −Σ_j m_j (q_i L_i/ρ_i² + q_j L_j/ρ_j²) ∇W_ij, as
    the pressure itself under :class:`psph.physics.fluid.correction.GradientCorrection`, so that the work
    of q is that of compression.  It conserves momentum.
    """

    conserves = ("momentum",)
    brakes = True

    alpha: float

    writes = AcousticDamper.writes
    lagged = True

    start = AcousticDamper.start
    finish_value = AcousticDamper.finish_value
    longest_step = AcousticDamper.longest_step

    def gather(self, total, i, j, pair):
        """Add a neighbour's share of dρ_i/dt."""
        corrected = pair.u_dot_x + dot(pair.u_ij, times(i.gradient_correction, pair.x_ij))
        return total + corrected * pair.m_dw_r

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        q_i, q_j = i.compression * v_i * v_i, j.compression * v_j * v_j
        both = add(scale(i.gradient_correction, q_i), scale(j.gradient_correction, q_j))
        whole = add(scale(pair.x_ij, q_i + q_j), times(both, pair.x_ij))
        return scale(whole, -pair.m_dw_r)


class AsTheyAre(NamedTuple):
    """Gradients without a correction."""

    def turned(self, i, x):
        """x, m."""
        return x


class ByL(NamedTuple):
    """Corrected gradients."""

    def turned(self, i, x):
        """L_i x, m."""
        return add(x, times(i.gradient_correction, x))


turned = call_by_type("turned")
"""(gradients, i, x) → what stands for x in the gradient of the kernel that i takes, m."""


class VolumeDamper(NamedTuple):
    """A pressure against the rate of compression, in fluids of several densities.

    As :class:`AcousticDamper`, with dρ_i/dt = ρ_i Σ_j V_j θ_ij u_ij·L_i∇W_ij and
    a_i = −1/ρ_i Σ_j V_j (θ_ij q_i L_i + θ_ji q_j L_j) ∇W_ij (psph.physics.fluid.several); ``gradients`` say
    whether there is an L.  It conserves momentum.
    """

    conserves = ("momentum",)
    brakes = True

    alpha: float
    facing: Facing
    gradients: Any

    writes = AcousticDamper.writes
    lagged = True

    start = AcousticDamper.start
    finish_value = AcousticDamper.finish_value
    longest_step = AcousticDamper.longest_step

    def gather(self, total, i, j, pair):
        """Add a neighbour's share of dρ_i/dt."""
        share = shares(self.facing, i, j)[0] * (j.specific_volume / i.specific_volume)
        return total + dot(pair.u_ij, turned(self.gradients, i, pair.x_ij)) * (share * pair.m_dw_r)

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        theta_ij, theta_ji = shares(self.facing, i, j)
        own = scale(turned(self.gradients, i, pair.x_ij), theta_ij * i.compression)
        other = scale(turned(self.gradients, j, pair.x_ij), theta_ji * j.compression)
        return scale(add(own, other), -in_volumes(i, j, pair))
