"""Ideal gases, with and without what broadens shocks and contacts, in the same trials."""

from pathlib import Path

from psph.lab.battery import command
from psph.lab.battery.comparison import Comparison
from psph.lab.battery.trials import Bound, Trial

SHOWN = {
    "blast": ("gas_energy", "closest", "steps"),
    "tube": ("pressure_error", "density_error", "velocity_error", "gas_energy"),
    "void": ("coldest", "gas_energy"),
    "vortex": ("kinetic", "gas_energy"),
}
"""Trials and the measures shown of each, the main one first."""

EVERYWHERE = "physics.shock_viscosity={least=1.0}"
"""Whatever the case has: viscosity is the same for all."""

WAYS = {
    "gas": (EVERYWHERE,),
    "gas, a switch": ("physics.shock_viscosity={least=0.0}",),
    "gas, no viscosity": ("physics.shock_viscosity=off",),
    "gas, no conduction": (EVERYWHERE, "physics.heat_conduction=off"),
    "gas, long steps": (EVERYWHERE, "time.cfl=0.5"),
}
"""What is changed in the scheme ``gas``."""

LINE = "ideal_gases.gas."
"""The gas of the tube, of which others are made."""


def _judging(name: str, case: str, end: float, *sets: str, holds, goals=()) -> Trial:
    """A trial in which a run continues in spite of its guards."""
    return Trial(
        name,
        f"../gas/{case}",
        SHOWN[name][0],
        1.0,
        end,
        end,
        (*sets, "guards.on_trouble=warn"),
        holds=holds,
        goals=goals,
        schemes=tuple(WAYS),
        changes=WAYS,
    )


TRIALS = (
    _judging("blast", "sedov", 0.1, holds=(Bound("gas_energy", most=0.01), Bound("closest", least=0.3))),
    _judging(
        "tube",
        "shock_tube",
        0.012,
        f'{LINE}density="1 + 0 * x"',
        f'{LINE}pressure="1000 if x < 0 else 0.01"',
        "exact.shock_tube.left_pressure=1000.0",
        "exact.shock_tube.right_pressure=0.01",
        "exact.shock_tube.right_density=1.0",
        "space.spacing=0.0025",
        holds=(Bound("gas_energy", most=0.01),),
    ),
    _judging(
        "void",
        "shock_tube",
        0.1,
        f'{LINE}density="1 + 0 * x"',
        f'{LINE}pressure="0.4"',
        f'{LINE}velocity=["-2 if x < 0 else 2"]',
        holds=(Bound("gas_energy", most=0.01), Bound("coldest", least=0.01)),
    ),
    _judging("vortex", "gresho", 1.3, holds=(Bound("kinetic", 0.6, 1.0),)),
)

GASES = Comparison("gases", "scheme", TRIALS, SHOWN)


def gases(comm, out: Path | None) -> None:
    """Run them into the folder ``out``; collective."""
    command.compare(comm, GASES, out)
