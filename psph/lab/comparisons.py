"""What ``stability`` compares beside maps and the battery: a catalogue, filled by hand."""

from importlib import import_module
from pathlib import Path
from typing import NamedTuple


class Offer(NamedTuple):
    """A comparison: what ``--help`` says of it, its module and name, and those that run ``then`` too."""

    says: str
    of: str
    then: tuple[str, ...] = ()

    def run(self, comm, out: Path | None) -> None:
        """Into the folder ``out``; collective.  Imported here, since most commands have no use for it."""
        module, _, name = self.of.partition(":")
        getattr(import_module(module), name)(comm, out)


OFFERED = {
    "remedies": Offer(
        "run each remedy alone in cases in which plain SPH fails instead, then what --solids runs",
        "psph.lab.battery.remedies:remedies",
        ("solids",),
    ),
    "walls": Offer(
        "run hard cases with walls of every condition instead", "psph.lab.battery.wall_kinds:walls"
    ),
    "solids": Offer(
        "run elastic solids in total and updated Lagrangian SPH instead",
        "psph.lab.battery.solid_kinds:solids",
    ),
    "gases": Offer(
        "run ideal gases with and without viscosity of shocks and conduction of heat instead",
        "psph.lab.battery.gas_kinds:gases",
    ),
    "elastic": Offer(
        "waves of an elastic lattice in total and updated Lagrangian SPH instead",
        "psph.lab.maps.elastic:elastic",
    ),
}
"""By the option of ``stability`` that asks for it."""


def run(name: str, comm, out: Path | None) -> None:
    """Run the comparison of this ``name`` into the folder ``out``; collective."""
    OFFERED[name].run(comm, out)
    for other in OFFERED[name].then:
        OFFERED[other].run(comm, (out or Path(name)) / other)
