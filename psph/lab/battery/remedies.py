"""Remedies: single additions to plain SPH, and the trials in which plain SPH fails."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from psph.lab.battery import command
from psph.lab.battery.comparison import Comparison, judging
from psph.lab.battery.trials import QUICK, Trial

PLAIN = "scheme=sph"


class Remedy(NamedTuple):
    """Keys of a case; ``in_patch``: the same where there is a free surface, with other values; ``without``:
    keys that it takes out; ``use``: the file of run/remedies that brings it."""

    sets: tuple[str, ...]
    in_patch: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    use: str = ""

    @property
    def name(self) -> str:
        """The keys as a user writes them."""
        keys = ", ".join(f"{key} = {value}" for key, value in map(_written, self.sets))
        others = ", ".join(value for _, value in map(_written, self.in_patch))
        return f"{keys}, in the patch {others}" if others else keys

    def changes(self, sets: tuple[str, ...]) -> tuple[str, ...]:
        """All that it changes in a case beside these keys."""
        return (*([f'use=["{self.use}"]'] if self.use else []), *sets, *self.without)


def _written(one: str) -> tuple[str, str]:
    """Key and value as in a case file; a key of ``physics`` without that."""
    key, _, value = one.removeprefix("physics.").partition("=")
    return key, value if value[0].isdigit() else f'"{value}"'


REMEDIES = (
    Remedy((PLAIN,)),
    Remedy(("space.kernel=quadratic",), use="kernels.py"),
    Remedy(("space.kernel=spiky",), use="kernels.py"),
    Remedy(("space.kernel=hyperbolic",)),
    Remedy(("physics.artificial_stress=0.2",)),
    Remedy(("physics.artificial_stress=0.2", "physics.artificial_viscosity=0.05")),
    Remedy(("physics.pressure_gradient=tensile_control",)),
    Remedy(("physics.pressure_gradient=tensile_control", "physics.particle_shifting=0.1")),
    Remedy(("physics.pressure_gradient=minimum",)),
    Remedy(("physics.pressure_gradient=difference",)),
    Remedy(("physics.pressure_gradient=stress_points",), use="stress_points.py"),
    Remedy(("physics.pressure_gradient=stress_points", "space.smoothing=1.7"), use="stress_points.py"),
    Remedy(("physics.xsph=0.5",), use="transport.py"),
    Remedy(("physics.transport_velocity=1.0",), use="transport.py"),
    Remedy(("physics.generalised_transport_velocity=1.0",), use="transport.py"),
    Remedy(("physics.riemann_dissipation=3.0",), use="riemann_dissipation.py"),
    Remedy(("physics.conservative_smoothing=0.1",), use="conservative_smoothing.py"),
    Remedy(("physics.particle_shifting=0.1",)),
    Remedy(("physics.position_shift=0.1",)),
    Remedy(("physics.pair_potential=0.008",), use="pair_potential.py"),
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
    inside = {one.name: one.changes(one.sets) for one in remedies}
    surface = {one.name: one.changes(one.in_patch or one.sets) for one in remedies}
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


def remedies(comm, out: Path | None) -> None:
    """Run each of psph's own into the folder ``out``; collective."""
    command.compare(comm, comparison(), out)
