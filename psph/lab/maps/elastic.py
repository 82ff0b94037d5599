"""The verb ``stability --elastic``: waves of an elastic lattice in each description of it."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from psph.lab.battery.tables import table
from psph.lab.maps.tables import write
from psph.theory.stability.elastic import Matter, TotalLagrangian, UpdatedLagrangian
from psph.theory.stability.zigzags import Description, elastic_growth, fastest, limp_waves, zigzag

PAGE, FOLDER = "elastic.md", Path("elastic")

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


def elastic(comm, out: Path | None) -> None:
    """Compute and print the table, on rank 0."""
    if comm.rank == 0:
        rows = list(_rows())
        text, folder = "\n".join(_markdown(rows)) + "\n", out or FOLDER
        print(text)
        write(folder / PAGE, text)
        print(f"wrote {folder / PAGE}")


def matter(poisson: float, **more) -> Matter:
    """Elastic matter on a square lattice in units of c_l, its density and dx."""
    part = poisson / (1.0 - poisson)
    return Matter(part, 0.5 * (1.0 - part), **{"stretches": (1.0, 1.0), **more})


def _rows() -> Iterator[list[str]]:
    yield ["description", "limp", "zigzag", "fastest", *STATES]
    for name, of in DESCRIPTIONS.items():
        rest = matter(POISSON)
        rates = (elastic_growth(of, matter(POISSON, stretches=s)) for s in STATES.values())
        yield [
            name,
            ", ".join(_word(wave) for wave in limp_waves(of, rest)) or "–",
            f"{round(zigzag(of, rest), 9):.2g}",
            f"{fastest(of, rest):.3g}",
            *("·" if one.stable else f"{one.rate * rest.smoothing:.2g}" for one in rates),
        ]


def _word(wave: np.ndarray) -> str:
    """A wave vector in π/dx."""
    return "(" + " ".join(f"{k:.3g}" for k in wave) + ")"


def _markdown(rows: list[list[str]]) -> Iterator[str]:
    head, *body = rows
    yield from table(head, body)
    yield ""
    yield (
        f"Square lattice, Wendland C2, h/dx √2, ν {POISSON:g}, plane strain. *limp*: waves without stiffness "
        "at rest, their k in π/dx; *zigzag*: ω h/c_l of the softest wave at the corners of the Brillouin "
        "zone, at rest; *fastest*: ω h/c_l, which limits the time step; then the fastest growth in c_l/h of "
        "a lattice that is stretched evenly, · where nothing grows."
    )
