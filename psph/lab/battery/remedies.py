"""Remedies: single additions to plain SPH, and the trials in which plain SPH fails."""

from collections.abc import Sequence
from typing import NamedTuple

from psph.lab.battery.comparison import Comparison, judging
from psph.lab.battery.trials import QUICK, Trial

PLAIN = "scheme=sph"


class Remedy(NamedTuple):
    """Keys of a case; ``in_patch``: the same where there is a free surface, with other values; ``without``:
    keys that it takes out."""

    sets: tuple[str, ...]
    in_patch: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The keys as a user writes them."""
        keys = ", ".join(f"{key} = {value}" for key, value in map(_written, self.sets))
        others = ", ".join(value for _, value in map(_written, self.in_patch))
        return f"{keys}, in the patch {others}" if others else keys


def _written(one: str) -> tuple[str, str]:
    """Key and value as in a case file; a key of ``physics`` without that."""
    key, _, value = one.removeprefix("physics.").partition("=")
    return key, value if value[0].isdigit() else f'"{value}"'


REMEDIES = (
    Remedy((PLAIN,)),
    Remedy(("space.kernel=quadratic",)),
    Remedy(("space.kernel=spiky",)),
    Remedy(("space.kernel=hyperbolic",)),
    Remedy(("physics.artificial_stress=0.2",)),
    Remedy(("physics.artificial_stress=0.2", "physics.artificial_viscosity=0.05")),
    Remedy(("physics.pressure_gradient=tensile_control",)),
    Remedy(("physics.pressure_gradient=tensile_control", "physics.particle_shifting=0.1")),
    Remedy(("physics.pressure_gradient=minimum",)),
    Remedy(("physics.pressure_gradient=difference",)),
    Remedy(("physics.pressure_gradient=stress_points",)),
    Remedy(("physics.pressure_gradient=stress_points", "space.smoothing=1.7")),
    Remedy(("physics.xsph=0.5",)),
    Remedy(("physics.transport_velocity=1.0",)),
    Remedy(("physics.generalised_transport_velocity=1.0",)),
    Remedy(("physics.riemann_dissipation=3.0",)),
    Remedy(("physics.conservative_smoothing=0.1",)),
    Remedy(("physics.particle_shifting=0.1",)),
    Remedy(("physics.position_shift=0.1",)),
    Remedy(("physics.pair_potential=0.008",)),
    Remedy(("physics.gradient_correction=0.7",)),
    Remedy(("physics.background_pressure=3000",), ("physics.background_pressure=20",)),
    Remedy(("scheme=stable",), without=("physics.density_diffusion=off", "physics.pair_damping=off")),
)
"""Plain SPH first, the default scheme last."""

BESIDES = ("physics.density_diffusion=0.1", "physics.pair_damping=0.02")
"""Damping of noise in disordered trials; the default scheme has its own."""

KICKED, JITTERED, PATCH, *_ = QUICK

SHOWN = {
    "4.2": ("growth", "speed", "late_speed"),
    "4.2, jitter": ("speed", "late_speed"),
    "patch": ("kinetic", "angular", "pieces", "near_5"),
}
"""Trials and the measures shown of each, the main one first."""


def comparison(remedies: Sequence[Remedy] = REMEDIES) -> Comparison:
    """Each remedy alone, side by side."""
    return Comparison("remedies", "remedy", trials(remedies), SHOWN)


def trials(remedies: Sequence[Remedy] = REMEDIES) -> tuple[Trial, ...]:
    """Three of the quick battery with its bounds, each under every remedy."""
    inside = {one.name: one.sets + one.without for one in remedies}
    surface = {one.name: (one.in_patch or one.sets) + one.without for one in remedies}
    return (
        _judging("4.2", KICKED, 0.1, inside)._replace(speed=1.0, holds=JITTERED.holds),
        _judging("4.2, jitter", JITTERED, 1.0, inside, *BESIDES),
        _judging("patch", PATCH, 2.0, surface, *BESIDES),
    )


def _judging(
    name: str, trial: Trial, end: float, changes: dict[str, tuple[str, ...]], *besides: str
) -> Trial:
    sets = (*trial.sets, PLAIN, *besides)
    return judging(trial, name, changes, shown=SHOWN[name][0], end=end, sets=sets)
