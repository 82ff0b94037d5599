"""How the thermal energy of an ideal gas changes: by work, in shocks, and by conduction."""

from typing import Any, NamedTuple

from psph.acts import IDEAL_GASES
from psph.physics.facts import Facts
from psph.physics.gas.conduction import conduction, conduction_in
from psph.physics.gas.pressure import both_slopes, even_slopes, slopes_in
from psph.physics.gas.shocks import share, shock_pressure, switches
from psph.physics.gas.state import HEAT


class GasHeat(NamedTuple):
    """The heat of an ideal gas: what pressure and viscosity take from motion, and what is conducted.

    u̇_i = Σ_j m_j u_ij·[p_i/ρ_i² f_ij ∇W(h_i) + ½ ν_ij ∇W̄] and conduction
    (:class:`psph.physics.gas.conduction.HeatConduction`): Σ m (v²/2 + u) stays.  Springel & Hernquist (2002),
    MNRAS 333, 649; Price (2012), J. Comput. Phys. 231, 759.
    """

    acts = (IDEAL_GASES,)

    alpha: float = 0.0
    beta: float = 0.0
    spread: Any = None
    form: Any = None

    writes = HEAT

    def in_scene(self, scene: Facts):
        """With the viscosity and the conduction of the scene, and slopes by its masses."""
        viscosity = scene.physics.shock_viscosity
        return (SwitchedHeat if switches(viscosity) else GasHeat)(
            viscosity.alpha if viscosity else 0.0,
            viscosity.beta if viscosity else 0.0,
            conduction_in(scene),
            slopes_in(scene),
        )

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add one neighbour's share of u̇_i, W/kg."""
        slope, _ = both_slopes(self.form, i, j, pair)
        own, other = even_slopes(self.form.kernel, i, j, pair)
        work = i.pressure * i.specific_volume * i.specific_volume * slope
        rubbed = 0.25 * shock_pressure(self.alpha, self.beta, i, j, pair) * (own + other)
        spread = conduction(self.spread, own, other, i, j, pair)
        return total + (work + rubbed) * pair.u_dot_x + spread

    def finish_value(self, total, i, kernel):
        """u̇_i, W/kg."""
        return total


class SwitchedHeat(NamedTuple):
    """The heat of an ideal gas, with little friction where nothing shocks: of a pair by both its shares."""

    alpha: float
    beta: float
    spread: Any
    form: Any

    writes = HEAT
    start, finish_value = GasHeat.start, GasHeat.finish_value

    def gather(self, total, i, j, pair):
        """Add one neighbour's share of u̇_i, W/kg."""
        slope, _ = both_slopes(self.form, i, j, pair)
        own, other = even_slopes(self.form.kernel, i, j, pair)
        work = i.pressure * i.specific_volume * i.specific_volume * slope
        nu = share(i, j) * shock_pressure(self.alpha, self.beta, i, j, pair)
        spread = conduction(self.spread, own, other, i, j, pair)
        return total + (work + 0.25 * nu * (own + other)) * pair.u_dot_x + spread
