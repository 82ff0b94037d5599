"""The benchmarks: what each table of the page shows, and who judges."""

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from psph.lab.peers import judge
from psph.lab.peers.records import Outcome

CODE, LAST = "code", ("CPU s: run", "whole", "version, day")
"""What every table of runs begins and ends with."""


class Benchmark(NamedTuple):
    """A flow: the heads of what its judge says, and the judge.

    ``axis`` names the error of the picture, the rms of ``numbers`` of the row times ``scale``, in %;
    ``quick``: whether ``--quick`` runs it.
    """

    heads: tuple[str, ...]
    judge: Callable[[Outcome], tuple[str, ...]]
    axis: str
    numbers: tuple[tuple[int, int], ...]
    """Cells of the row, and which of the numbers in each."""
    scale: float = 1.0
    quick: bool = False

    @property
    def head(self) -> tuple[str, ...]:
        """The first row of its table."""
        return (CODE, *self.heads, *LAST)

    @property
    def blown(self) -> tuple[str, ...]:
        """The cells of a run that blew up, without its version."""
        return ("blew up", *("–" for _ in (*self.heads[1:], *LAST[:-1])))

    def error(self, cells: Sequence[str]) -> float | None:
        """What the picture shows of a row; None: the row lacks it."""
        found = [numbers(cells[cell])[which : which + 1] for cell, which in self.numbers]
        if not all(found):
            return None
        return self.scale * math.sqrt(sum(value**2 for [value] in found) / len(found))


def numbers(cell: str) -> list[float]:
    """The numbers in a cell."""
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", cell)]


BENCHMARKS = {
    "taylor_green": Benchmark(
        ("L2, %", "L∞, %"),
        judge.taylor_green,
        "Taylor–Green vortices: error of the velocity (L2, %)",
        ((0, 0),),
        quick=True,
    ),
    "cavity": Benchmark(
        ("t = 5: u / v", "t = 10", "from Ghia"),
        judge.cavity,
        "cavity: error of u and v at t = 10 (rms, % of the lid)",
        ((1, 0), (1, 1)),
        100.0,
    ),
    "tank": Benchmark(
        ("p, %: rms / max", "level fitted", "speed, mm/s"),
        judge.tank,
        "still tank: error of the pressure (rms, % of ρgH)",
        ((0, 0),),
        quick=True,
    ),
    "box": Benchmark(
        ("H2, %", "H4, %", "arrival, s", "P1, kPa"),
        judge.box,
        "dam break onto a box: error of the heights (rms, %)",
        ((0, 0), (1, 0)),
    ),
}
"""By the name of the markers on the page."""

PACE = "pace"
PACE_HEAD = ("problem", "particles", "psph / LAMMPS", "version, day")
"""The table beside LAMMPS has another form."""
