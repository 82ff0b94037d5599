"""What a rank holds and sends of a scene, bytes, before a run takes any."""

import math

from psph.kinds import count_of, kinds_in
from psph.parallel.domain import CELLS_A_PARTICLE
from psph.particles.cells import make_grid
from psph.particles.records import record_width, recorded
from psph.particles.store import SPARE
from psph.scene.sites import sites_within
from psph.simulation.plan import Plan

NUMBER, IDENTITY, ROW, SORTING, ENTRY, CELL = 8, 9, 12, 24, 4, 24
"""Bytes of a number; of a particle's id and kind; of the position of its list; of the arrays that a
rebuild sorts with; of a neighbour in a list; and of a cell of the grid during a rebuild."""


def slab_planes(scene) -> int:
    """Planes of cells along the slab axis: the most ranks that the scene can use."""
    return _grid(scene).counts[0]


def bytes_per_particle(scene, plan: Plan) -> tuple[float, float]:
    """Memory of a particle: its fields with the arrays to sort them, and its neighbour list, bytes."""
    own = NUMBER * _rows(scene, plan, plan.arrays) + IDENTITY
    widths = (record_width(_rows(scene, plan, recorded(p.neighbour_fields))) for p in plan.passes)
    record = sum(widths) * plan.space.record_type.itemsize
    own += own / SPARE + record + SORTING + CELL * _cells_per_particle(scene)
    entries = sites_within(scene, _listed(scene)) + (plan.space.lanes - 1) / 2 if plan.passes else 0.0
    listed = (ENTRY * entries + ROW) * (1.0 + 1.0 / SPARE)
    return own, listed + sum(kind.bytes_of_particle(plan) for kind in plan.matter)


def bytes_of_rank(scene, plan: Plan, ranks: int) -> float:
    """Memory of the particles, ghosts and lists of one of so many ranks, bytes."""
    own, listed = bytes_per_particle(scene, plan)
    share = count_of(scene) / ranks
    return own * (share + _neighbours(scene, ranks) * ghosts_a_side(scene)) + listed * share


def bytes_per_refresh(scene, plan: Plan, ranks: int) -> tuple[int, float]:
    """Messages of a halo refresh: bytes per ghost, and bytes that a rank sends in all."""
    each = NUMBER * _rows(scene, plan, plan.refreshed)
    return each, each * _neighbours(scene, ranks) * ghosts_a_side(scene)


def _rows(scene, plan: Plan, names: tuple[str, ...]) -> int:
    """Numbers that these fields take."""
    return sum(plan.fields[name].width(scene.dimensions) for name in names)


def _neighbours(scene, ranks: int) -> int:
    """Ranks, or sides, that a rank exchanges ghosts with."""
    return 2 if scene.layout.periods[scene.layout.axis] is not None else min(ranks - 1, 2)


def ghosts_a_side(scene) -> float:
    """Particles of an average plane of cells: a rank holds one plane from each side."""
    return count_of(scene) / slab_planes(scene)


def _cells_per_particle(scene) -> float:
    """The most that the grid may come to have, when particles leave an open domain."""
    grid = _grid(scene)
    closed = all(period is not None for period in scene.layout.periods)
    return max(math.prod(grid.counts) / count_of(scene), 0.0 if closed else CELLS_A_PARTICLE)


def _grid(scene):
    """The grid over the scene at its start."""
    return make_grid(
        scene.layout.axis, _cutoff(scene), scene.layout.lower, scene.layout.upper, scene.layout.periods
    )


def _cutoff(scene) -> float:
    """How far lists may reach, m."""
    return _farthest(scene) or scene.layout.reach.cutoff


def _listed(scene) -> float:
    """How far lists reach at the start, m."""
    reach = scene.layout.reach
    return _farthest(scene) or reach.support + reach.first


def _farthest(scene) -> float:
    """How far the largest particle looks at the start, m, where sizes differ, else 0."""
    return max((kind.farthest for kind in kinds_in(scene)), default=0.0)
