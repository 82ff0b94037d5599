"""The verb ``stability --elastic``: waves of an elastic lattice in each description of it."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from psph.lab.battery.tables import table
from psph.lab.maps.tables import write
from psph.theory.stability.elastic import ElasticMatter, TotalLagrangian, UpdatedLagrangian
from psph.theory.stability.growth import Growth
from psph.theory.stability.zigzags import Description, elastic_growth, fastest, limp_waves, zigzag

CSV, PAGE, FOLDER = "elastic.csv", "elastic.md", Path("elastic")
UNIT = "c_l/h"
"""Of rates of growth."""

POISSON = 0.4
"""Of the tables."""

DESCRIPTIONS: Mapping[str, Description] = {
    "total, no control": TotalLagrangian(0.0),
    "total, α = 0.1": TotalLagrangian(0.1),
    "total, α = 1.5": TotalLagrangian(),
    "updated": UpdatedLagrangian(),
    "updated, uncorrected": UpdatedLagrangian(corrected=False),
    "updated, ε = 0.1": UpdatedLagrangian(0.1),
    "updated, ε = 0.3": UpdatedLagrangian(0.3),
    "updated, ε = 1": UpdatedLagrangian(1.0),
}
"""With ε, the artificial stress of Gray, Monaghan & Swift (2001), n = 4."""

STATES: Mapping[str, tuple[float, float]] = {
    "1 % longer both ways": (1.01, 1.01),
    "5 % longer both ways": (1.05, 1.05),
    "5 % longer one way": (1.05, 1.0 - 0.05 * POISSON / (1.0 - POISSON)),
    "5 % shorter both ways": (0.95, 0.95),
}
"""Stretches of a square lattice; "one way" nothing pulls across, in plane strain."""


class ElasticRow(NamedTuple):
    """A description of elastic matter: its ``limp`` waves (n, 2) in π/dx, ω h/c_l of its softest ``zigzag``
    and of its ``fastest`` wave, all at rest, and the growth in each of ``STATES``, rates in ``UNIT``."""

    description: str
    limp: np.ndarray
    zigzag: float
    fastest: float
    growths: tuple[Growth, ...]

    @property
    def limp_waves(self) -> str:
        """Those waves in words; nothing where there are none."""
        return ", ".join("(" + " ".join(f"{k:.3g}" for k in wave) + ")" for wave in self.limp)


def elastic(comm, out: Path | None) -> None:
    """Compute and print the table, on rank 0."""
    if comm.rank == 0:
        rows = list(survey())
        text, folder = markdown(rows), out or FOLDER
        print(text)
        write(folder / CSV, as_csv(rows))
        write(folder / PAGE, text)
        print(f"wrote {folder}: {CSV}, {PAGE}")


def matter(poisson: float, **more) -> ElasticMatter:
    """Elastic matter on a square lattice in units of c_l, its density and dx."""
    part = poisson / (1.0 - poisson)
    return ElasticMatter(part, 0.5 * (1.0 - part), **{"stretches": (1.0, 1.0), **more})


def survey() -> Iterator[ElasticRow]:
    """Each description, at rest and stretched."""
    for name, of in DESCRIPTIONS.items():
        rest = matter(POISSON)
        found = (elastic_growth(of, matter(POISSON, stretches=s)) for s in STATES.values())
        yield ElasticRow(
            name,
            limp_waves(of, rest),
            zigzag(of, rest),
            fastest(of, rest),
            tuple(one._replace(rate=one.rate * rest.smoothing) for one in found),
        )


def markdown(rows: Sequence[ElasticRow]) -> str:
    """The table and what its columns mean."""
    return "\n".join(_markdown(rows)) + "\n"


def _markdown(rows: Sequence[ElasticRow]) -> Iterator[str]:
    yield from table(["description", "limp", "zigzag", "fastest", *STATES], [_cells(row) for row in rows])
    yield ""
    yield (
        f"Square lattice, Wendland C2, h/dx √2, ν {POISSON:g}, plane strain. *limp*: waves without stiffness "
        "at rest, their k in π/dx; *zigzag*: ω h/c_l of the softest wave at the corners of the Brillouin "
        "zone, at rest; *fastest*: ω h/c_l, which limits the time step; then the fastest growth in "
        f"{UNIT} of a lattice that is stretched evenly, · where nothing grows."
    )


def _cells(row: ElasticRow) -> list[str]:
    rates = ["·" if one.stable else f"{one.rate:.2g}" for one in row.growths]
    return [
        row.description,
        row.limp_waves or "–",
        f"{round(row.zigzag, 9):.2g}",
        f"{row.fastest:.3g}",
        *rates,
    ]


def as_csv(rows: Sequence[ElasticRow]) -> str:
    """Every growth with all its digits and its wave vector, rad/dx."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    names = ["description", "state", "growth_rate", "stable", "wave_x", "wave_y", "limp", "zigzag", "fastest"]
    writer.writerow(names)
    for row in rows:
        rest = [row.limp_waves, row.zigzag, row.fastest]
        for state, one in zip(STATES, row.growths):
            writer.writerow([row.description, state, one.rate, one.stable, *one.wave_vector.tolist(), *rest])
    return out.getvalue()
