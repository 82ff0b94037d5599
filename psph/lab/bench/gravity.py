"""Clouds under their own gravity: what the sum over a tree costs, and its errors against all pairs.

``python -m psph.lab.bench.gravity`` prints a table, ``python -m psph.lab.bench.gravity 1000000`` that of so
many particles.  Times are those of this process's processor; run it with ``NUMBA_NUM_THREADS=1`` for those of
one core.
"""

import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from psph.simulation.direct_sum import DirectSum
from psph.simulation.masses import ID, MASS, OLD, PLACE, WHOLE, WIDTH, Pulled
from psph.simulation.tree_sum import TreeSum

ACCURACY = 0.003
"""The default of physics.self_gravity.accuracy."""

REACH = 0.07
"""The support of the softening, m."""

PARTICLES = 100_000

SAMPLE = 1_000
"""Particles at most whose pull by all pairs is found; the time of all follows."""

REPEATS = 3
"""Sums of which the quickest counts."""


def rows_of(place: np.ndarray, mass=None) -> np.ndarray:
    """Rows as ranks exchange them, of particles at ``place`` (n, 3), m, together 1 kg unless said."""
    rows = np.zeros((len(place), WIDTH))
    rows[:, ID], rows[:, PLACE] = np.arange(len(place)), place
    rows[:, MASS] = 1.0 / max(len(place), 1) if mass is None else mass
    return rows


def pulls(one, rows: np.ndarray, columns: np.ndarray | None = None) -> np.ndarray:
    """Pull (3, n), m/s², and half of the potential (n,) by a sum, of some ``columns`` or of all; NaN
    elsewhere."""
    columns = np.arange(len(rows)) if columns is None else columns
    found, whole = np.full((4, len(rows)), np.nan), np.zeros((3, len(rows)))
    places = tuple(np.ascontiguousarray(rows[:, PLACE].T))
    both = tuple(whole) if rows[:, WHOLE].any() else None
    one.renew(rows, Pulled(columns, rows[columns, ID], places, tuple(found[:3]), both, found[3]))
    found[:3] += whole
    return found


def by_tree(rows, reach, accuracy=ACCURACY, columns=None) -> tuple[np.ndarray, TreeSum]:
    """By a tree that knows the pulls of a step before, and that tree."""
    tree = TreeSum(1.0, reach, accuracy)
    rows[:, OLD] = 0.0
    rows[:, OLD] = np.sqrt((pulls(tree, rows)[:3] ** 2).sum(axis=0))
    return pulls(tree, rows, columns), tree


def directions(n: int, rng) -> np.ndarray:
    """Unit vectors (n, 3), any alike."""
    x = rng.normal(size=(n, 3))
    return x / np.linalg.norm(x, axis=1)[:, None]


def plummer(n: int, rng) -> np.ndarray:
    """ρ ~ (1 + r²)^(−5/2)."""
    return directions(n, rng) / np.sqrt(rng.uniform(0.0, 0.999, n) ** (-2 / 3) - 1.0)[:, None]


def even(n: int, rng) -> np.ndarray:
    """A ball of one density."""
    return directions(n, rng) * rng.random(n)[:, None] ** (1 / 3)


def evrard(n: int, rng) -> np.ndarray:
    """ρ ~ 1/r."""
    return directions(n, rng) * rng.random(n)[:, None] ** (1 / 2)


CLOUDS = {"Plummer's sphere": plummer, "even ball": even, "ρ ~ 1/r (Evrard)": evrard}


def errors(found: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """|δa|/|a| of each particle."""
    return np.linalg.norm(found[:3] - exact[:3], axis=0) / np.linalg.norm(exact[:3], axis=0)


class TreeCost(NamedTuple):
    """What a tree takes: its errors |δa|/|a| as ``rms``, of 99 in a hundred (``most``) and the ``largest``,
    the ``net`` pull over the mean one, seconds of ``all_pairs`` and of the ``tree``, and ``seen``, pairs and
    cells over all pairs."""

    rms: float
    most: float
    largest: float
    net: float
    all_pairs: float
    tree: float
    seen: float


def tree_cost(cloud: Callable[[int, np.random.Generator], np.ndarray], n: int, repeats: int) -> TreeCost:
    """That of a cloud of so many particles."""
    rng = np.random.default_rng(1)
    rows = rows_of(cloud(n, rng))
    some = np.sort(rng.choice(n, min(SAMPLE, n), replace=False))
    direct = DirectSum(1.0, REACH)
    exact = pulls(direct, rows, some)
    found, tree = by_tree(rows, REACH)
    off = errors(found[:, some], exact[:, some])
    net = np.linalg.norm(found[:3].mean(axis=1)) / np.linalg.norm(found[:3], axis=0).mean()
    return TreeCost(
        float(np.sqrt((off**2).mean())),
        float(np.quantile(off, 0.99)),
        float(off.max()),
        float(net),
        quickest_of(repeats, lambda: pulls(direct, rows, some)) * n / len(some),
        quickest_of(repeats, lambda: pulls(tree, rows)),
        (tree.pairs + tree.cells) / n**2,
    )


def quickest_of(repeats: int, work: Callable[[], object]) -> float:
    """Seconds of this process, the least of some ``repeats``."""
    times = []
    for _ in range(repeats):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


def table_of_trees(n: int = PARTICLES, repeats: int = REPEATS) -> str:
    """All costs as lines of Markdown."""
    lines = [
        f"| {n:,} particles | rms | 99 % | largest | net pull over mean | all pairs | tree |",
        "|---|" + "---|" * 6,
    ]
    for name, cloud in CLOUDS.items():
        one = tree_cost(cloud, n, repeats)
        off = f"{one.rms:.1e} | {one.most:.1e} | {one.largest:.1e} | {one.net:.1e}"
        lines.append(f"| {name} | {off} | {one.all_pairs:.3g} | {one.tree:.2g} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table_of_trees(int(sys.argv[1]) if len(sys.argv) > 1 else PARTICLES))
