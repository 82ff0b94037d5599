"""A blast in an ideal gas, for psph and the codes beside it: the same particles, paces by processor time."""

import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np

from psph.lab.bench import GAS
from psph.lab.bench.measure import LAYOUTS, WARM_UP
from psph.lab.errors import PeersError
from psph.lab.peers.benchmarks import CODE
from psph.parallel.reductions import alone
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan

GAS_HEAD = (
    CODE,
    "M particle-steps/s of the processor",
    "neighbours",
    "CPU s, own steps",
    "what it is",
    "version, day",
)
"""The first row of its table."""

DIMENSIONS, PARTICLES, NEIGHBOURS = 3, 48**3, 64
"""The blast: how many particles there are, and how many others are within the support of each."""

SHORT = WARM_UP
"""Steps of the shorter run, before which no clock counts: compiling, the first lists, the first sizes."""

LONG = SHORT + 60
"""Steps of the longer run; what it takes more than the shorter one is that of the steps in between."""

END = 0.04
"""Until when particles take steps of their own, s."""


class GasStart(NamedTuple):
    """Particles of one mass in the unit cube around 0, at rest: ``position`` (n, 3) m, ``heat`` (n,) J/kg."""

    position: np.ndarray
    heat: np.ndarray
    support: float
    """How far the kernel reaches at the start, m."""


class GasPace(NamedTuple):
    """What a code took: ``updates`` of a particle in CPU ``seconds``, with ``neighbours`` in words, and the
    CPU seconds until ``END`` with steps of each particle's ``own``."""

    updates: int
    seconds: float
    neighbours: str
    own: float


class GasCode(Protocol):
    """psph, or one beside it, that can compute a gas."""

    name: str
    objections: dict[str, str]
    """By the name of a benchmark: what its author would say of the comparison."""
    scheme: str
    """What it runs here, and in which precision."""

    def prepare(self) -> str:
        """Build it where that is missing; its version.  PeersError: one line why not."""

    def pace(self, start: GasStart, folder: Path) -> GasPace:
        """Its pace from ``SHORT`` to ``LONG`` steps and until ``END``, run in an empty folder."""


def blast(particles: int = PARTICLES):
    """The problem of psph's own bench with about so many particles, as one of its ``LAYOUTS``."""
    return LAYOUTS[GAS](DIMENSIONS, NEIGHBOURS, particles)


def start(particles: int = PARTICLES) -> GasStart:
    """Its particles as psph begins with them."""
    scene = Scene(blast(particles).case())
    store = create_particles(scene, make_plan(scene), alone())
    heat, position = store.owned_rows("thermal_energy"), store.owned_rows("position")
    return GasStart(position.copy(), heat.copy(), scene.support)


def between(
    name: str, short: tuple[int, float], long: tuple[int, float], neighbours: str, own: float
) -> GasPace:
    """The pace from the (updates, CPU seconds) of two runs.  PeersError: the longer took no longer."""
    updates, seconds = long[0] - short[0], long[1] - short[1]
    if updates <= 0 or seconds <= 0.0:
        raise PeersError(
            f"{name}: {LONG} steps took {seconds:.2f} s more than {SHORT}, with {updates} more updates of a "
            "particle; let the machine come to rest and run it again"
        )
    return GasPace(updates, seconds, neighbours, own)


def check_end(name: str, time: float, folder: Path) -> None:
    """PeersError: a run with steps of their own ended before ``END``."""
    if time < 0.99 * END:
        raise PeersError(f"{name}: ended at {time:g} s, not at {END:g}; see its output in {folder}")


def rate(paces: Sequence[GasPace]) -> str:
    """Million particle-steps a second, the median of the turns, and their range: ``0.72 (0.70–0.74)``."""
    rates = [pace.updates / pace.seconds / 1e6 for pace in paces]
    middle = f"{statistics.median(rates):.2g}"
    return middle if len(rates) == 1 else f"{middle} ({min(rates):.2g}–{max(rates):.2g})"
