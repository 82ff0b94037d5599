"""The benchmarks: what each table of the page shows, and who judges."""

from collections.abc import Callable
from typing import NamedTuple

from psph.lab.peers import judge
from psph.lab.peers.records import Outcome

CODE, LAST = "code", ("CPU s: run", "whole", "version, day")
"""What every table of runs begins and ends with."""


class Benchmark(NamedTuple):
    """A flow: the heads of what its judge says, the judge, and whether ``--quick`` runs it."""

    heads: tuple[str, ...]
    judge: Callable[[Outcome], tuple[str, ...]]
    quick: bool = False

    @property
    def head(self) -> tuple[str, ...]:
        """The first row of its table."""
        return (CODE, *self.heads, *LAST)


BENCHMARKS = {
    "taylor_green": Benchmark(("L2, %", "L∞, %"), judge.taylor_green, quick=True),
    "cavity": Benchmark(("t = 5: u / v", "t = 10", "from Ghia"), judge.cavity),
    "tank": Benchmark(("p, %: rms / max", "level fitted", "speed, mm/s"), judge.tank, quick=True),
    "box": Benchmark(("H2, %", "H4, %", "arrival, s", "P1, kPa"), judge.box),
}
"""By the name of the markers on the page."""

PACE = "pace"
PACE_HEAD = ("problem", "particles", "psph / LAMMPS", "version, day")
"""The table beside LAMMPS has another form."""
