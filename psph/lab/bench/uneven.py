"""Particles in nests of ever finer squares or cubes: what a search by levels of cells costs, and a k-d tree.

``python -m psph.lab.bench.uneven`` prints a table, and one of the ghosts between two ranks.  Times are those
of this process's processor, so that they
mean something on a machine that others use.
"""

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from psph.engine.jit import uncounted
from psph.fields import LISTED_POSITION, POSITION, view_of
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.reductions import alone
from psph.particles import levels, neighbours
from psph.particles.level_candidates import box_around, gather
from psph.particles.level_grids import Slab, grids_of
from psph.particles.level_ranges import candidates, extent, of_level
from psph.particles.levels import middle_of
from psph.particles.neighbours import empty
from psph.particles.sizes import GROWTH, Sizes
from psph.particles.store import Store

SIZES = Sizes(2.0, 0.15, "smoothing_length", "listed_length")
"""As ideal gases have them."""

SMOOTHING = 1.4
"""h over spacing, of ideal gases too."""

SIDE = {2: 96, 3: 24}
"""Particles along an edge of a nest."""

ALIKE = {2: 192, 3: 40}
"""Particles along the edge of one of one size: about as many as in a nest at 10 : 1."""

RATIOS = (1, 2, 10, 100)
"""The largest over the smallest size."""

MANY = 4096
"""Groups of candidates of a cell, at the most."""

REPEATS = 5
"""Searches of which the quickest counts."""


class Cost(NamedTuple):
    """What a search takes: ``candidates`` for each entry of a list, and nanoseconds an entry of ``levels``
    and of the ``tree``, which looks as far as a particle reaches itself."""

    candidates: float
    levels: float
    tree: float


def nests(dimensions: int, ratio: float, side: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Places (dim, n), m, and spacings (n,), m: in the middle half of a box of 1 m is one twice as fine, and
    so on up to the ``ratio``, the last as fine as that asks for; in disorder."""
    rng = np.random.default_rng(seed)
    places, spacings, size, left = [], [], 1.0, float(ratio)
    while True:
        finer = min(2.0, left)
        site = (np.arange(side) + 0.5) / side - 0.5
        x = np.stack(np.meshgrid(*[site] * dimensions, indexing="ij")).reshape(dimensions, -1)
        if finer > 1.0:
            x = x[:, np.abs(x).max(axis=0) > 0.5 / finer]
        places.append(size * (x + rng.uniform(-0.3, 0.3, x.shape) / side))
        spacings.append(np.full(x.shape[1], size / side))
        if finer == 1.0:
            return np.concatenate(places, axis=1), np.concatenate(spacings)
        size, left = size / finer, left / finer


@uncounted
def count_candidates(grids, ranges, corners, near):
    """How many particles all particles of the grids look at, fillings of registers counted."""
    count, level, (low, high) = 0, 0, (corners[0], corners[1])
    for cell in range(len(grids.keys)):
        while cell >= grids.base[level + 1]:
            level += 1
        members = grids.starts[cell], grids.starts[cell + 1]
        reach = extent(grids, *members, low, high)
        many, _ = candidates(grids, low, high, reach, (0, len(grids.reach)), ranges)
        narrower = middle_of(grids, level, cell, low, high, reach, corners[2])
        box = box_around(low, high, corners[2], grids.origin, grids.periods)
        own = of_level(grids, level, ranges, many)
        found = gather(grids, ranges, many, own, members, box, reach * reach, narrower, near)
        count += (members[1] - members[0]) * found.end
    return count


def cost(dimensions: int, ratio: float, side: int, repeats: int = REPEATS) -> Cost:
    """That of nests with so many particles along an edge."""
    x, spacing = nests(dimensions, ratio, side)
    length, n = SMOOTHING * spacing, x.shape[1]
    reach = SIZES.reach(length)
    slab = Slab(0, -0.5, 0.5, 0, n, 0, (None,) * dimensions, (-0.5,) * dimensions, float(reach.max()))
    rows, room = tuple(x), empty(0, 0)

    def by_levels():
        nonlocal room
        looks = np.ones(len(length), np.bool_)
        room, _ = levels.list_by_levels(room, rows, length, looks, SIZES, slab, 1)

    by_levels()  # compiled, and with room
    entries = int(room.lengths[:n].sum())
    tree = quickest(repeats, lambda: cKDTree(x.T).query_ball_point(x.T, reach, return_sorted=False))
    grids = grids_of(list(rows), reach, slab)
    return Cost(
        count_candidates(grids, *levels.work_room(MANY, dimensions)) / entries,
        quickest(repeats, by_levels) / entries,
        tree / int((cKDTree(x.T).query_ball_point(x.T, reach, return_length=True) - 1).sum()),
    )


def alike(dimensions: int, side: int, repeats: int = REPEATS) -> float:
    """Nanoseconds an entry of the lists of particles of one size, as fluids make them, that reach as far."""
    x, spacing = nests(dimensions, 1.0, side)
    reach, n = float(SIZES.reach(SMOOTHING * spacing[0])), x.shape[1]
    store = Store(dimensions, [POSITION, LISTED_POSITION], {}, view_of(()))
    store.append(np.arange(n), np.zeros(n, np.uint8), np.concatenate([x, x]))
    ends = (-0.5,) * dimensions, (0.5,) * dimensions, (None,) * dimensions
    domain = Domain(alone(), store, Extent(0, *ends), reach, Travels((), ("position",)), 1)
    domain.rebuild()
    found = domain.grid, domain.starts, domain.planes, reach, domain.periods
    told = domain.lists, store, *found, 1, None, neighbours.fill_lists
    entries = int(domain.lists.lengths[:n].sum())
    return quickest(repeats, lambda: neighbours.build(*told)) / entries


class Ghosts(NamedTuple):
    """Particles that one of two ranks needs of the other, cut at 0 along x: of ``planes`` as wide as the
    largest particle reaches; of ``thin`` ones as wide as the smallest reaches, of which each knows its
    largest reach; and those in ``reach`` of any particle on the other side."""

    planes: int
    thin: int
    reach: int


def ghosts(x: np.ndarray, reach: np.ndarray) -> Ghosts:
    """Those of the upper half of particles at ``x`` (dim, n), m, from −0.5 to 0.5 m, that list others up to
    their ``reach`` (n,), m."""
    below = x[0] < 0.0
    side = 0.5 / max(1, int(0.5 / reach.max()))
    width = 0.5 / int(0.5 / reach.min())
    plane = np.floor(np.abs(x[0]) / width).astype(np.int64)
    farthest = np.zeros((2, plane.max() + 1))
    np.maximum.at(farthest, (below.astype(np.int64), plane), reach)
    away = width * np.arange(plane.max() + 1)
    looks = (farthest[0] - away)[farthest[0] > 0.0].max()  # how far beyond 0 those above look
    needed = np.flatnonzero(away < np.where(farthest[1] > 0.0, np.maximum(farthest[1], looks), 0.0))
    last = needed.max(initial=-1)
    return Ghosts(
        int((below & (x[0] >= -side)).sum()),
        int((below & (plane <= last)).sum()),
        int(_in_reach(x, reach, below).sum()),
    )


def _in_reach(x: np.ndarray, reach: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Who of those ``below`` is in reach of one above, or has one in reach (below,)."""
    own, others = x[:, below].T, x[:, ~below].T
    seen = np.zeros(len(own), np.bool_)
    for found in cKDTree(own).query_ball_point(others, reach[~below]):
        seen[found] = True
    return seen | (cKDTree(others).query_ball_point(own, reach[below], return_length=True) > 0)


def layers(dimensions: int, ratio: int, side: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Places (dim, n), m, and spacings (n,), m: coarse particles below 0.25 m along x, finer ones above."""
    rng = np.random.default_rng(seed)
    places, spacings = [], []
    for low, high, many in ((-0.5, 0.25, side), (0.25, 0.5, ratio * side)):
        site = (np.arange(many) + 0.5) / many - 0.5
        x = np.stack(np.meshgrid(*[site] * dimensions, indexing="ij")).reshape(dimensions, -1)
        x = x[:, (x[0] >= low) & (x[0] < high)]
        places.append(x + rng.uniform(-0.3, 0.3, x.shape) / many)
        spacings.append(np.full(x.shape[1], 1.0 / many))
    return np.concatenate(places, axis=1), np.concatenate(spacings)


def ghost_table() -> str:
    """Ghosts between two ranks as lines of Markdown."""
    lines = ["| | planes as wide as the largest reach | thin planes | in reach |", "|---|---|---|---|"]
    for name, laid, where in (
        ("nest, 10 : 1, cut in its middle", nests(3, 10.0, SIDE[3]), 0.0),
        ("layers, 4 : 1, cut where it is coarse", layers(3, 4, SIDE[3]), 0.0),
        ("the same, cut where it is fine", layers(3, 4, SIDE[3]), 0.35),
    ):
        x, spacing = laid
        moved = np.array([x[0] - where, *x[1:]])
        found = ghosts(
            moved[:, np.abs(moved[0]) < 0.5], SIZES.reach(SMOOTHING * spacing)[np.abs(moved[0]) < 0.5]
        )
        lines.append(f"| {name} | {found.planes:,} | {found.thin:,} | {found.reach:,} |")
    return "\n".join(lines)


def quickest(repeats: int, work: Callable[[], object]) -> float:
    """Nanoseconds of this thread, the least of some ``repeats``."""
    times = []
    for _ in range(repeats):
        begun = time.thread_time()
        work()
        times.append(time.thread_time() - begun)
    return 1e9 * min(times)


def table(repeats: int = REPEATS) -> str:
    """All costs as lines of Markdown."""
    lines = [
        f"| | {' | '.join(map(str, RATIOS))} |",
        "|---|" + "---|" * len(RATIOS),
    ]
    for dimensions, side in SIDE.items():
        costs = [cost(dimensions, ratio, side, repeats) for ratio in RATIOS]
        for name, of in (
            ("candidates for each entry of a list", [f"{one.candidates:.1f}" for one in costs]),
            ("levels, ns an entry", [f"{one.levels:.1f}" for one in costs]),
            ("k-d tree of scipy, ns an entry", [f"{one.tree:.0f}" for one in costs]),
        ):
            lines.append(f"| {dimensions}D: {name} | {' | '.join(of)} |")
        one_size = [f"{alike(dimensions, ALIKE[dimensions], repeats):.1f}", *["–"] * (len(RATIOS) - 1)]
        lines.append(f"| {dimensions}D: one size, as fluids list it, ns an entry | {' | '.join(one_size)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(f"lists reach {GROWTH + SIZES.skin:g} times the support\n\n{table()}\n\n{ghost_table()}")
