"""Rows of who is close to a particle of a gas, and how long the lists serve of which these are part."""

import numpy as np
import pytest
from gauging import start
from physics.test_gas import cloud

from psph.case import load
from psph.simulation.gas import Gases, find_sizes
from psph.simulation.near_rows import NEARER

MIRRORED = (
    "space.lower=[0.0, 0.0]",
    "space.upper=[1.6, 1.0]",
    'space.symmetry=["x.lower", "x.upper", "y.lower", "y.upper"]',
)


def rows(lists, count):
    return [
        set(lists.lists[int(b) : int(b) + int(n)].tolist())
        for b, n in zip(lists.begin[:count], lists.lengths)
    ]


def in_reach(simulation):
    """Whom each particle is to meet: all within the larger support of both."""
    store = simulation.store
    assert store.low == 0 and store.high == 0
    x, h = store.shown("position"), store.shown("smoothing_length")
    apart = np.linalg.norm(x[:, None] - x, axis=2)
    near = apart < 2.0 * np.maximum(h[:, None], h)
    np.fill_diagonal(near, False)
    return [set(np.flatnonzero(row).tolist()) for row in near]


def walked(simulation):
    """The rows that forces go through."""
    lists, _ = simulation.neighbourhood.of(simulation.plan.passes[0])
    return rows(lists, simulation.store.owned)


def lacking(simulation):
    """How many neighbours the rows lack, and how long they are over what has to be there."""
    found, asked = walked(simulation), in_reach(simulation)
    lacks = sum(len(need - have) for need, have in zip(asked, found))
    return lacks, sum(map(len, found)) / sum(map(len, asked))


def change(simulation, **numbers):
    """Other numbers in what is asked of the iteration."""
    gases = simulation.engine.of(Gases.name)
    gases._asked = gases._asked._replace(**numbers)


def test_rows_hold_all_in_reach_and_few_more(tmp_path):
    """Beside them lists hold half as many more, by which forces go where an h has grown by 5 % in a step; rows
    too short lack neighbours."""
    simulation = cloud(tmp_path, "time.cfl=0.1")
    longer = []
    for _ in range(8):
        simulation.step()
        lacks, times = lacking(simulation)
        assert lacks == 0
        longer.append(times)
    assert min(longer) < 1.2 and max(longer) < 1.8
    listed = sum(map(len, rows(simulation.domain.lists, simulation.store.owned)))
    assert listed > 1.3 * sum(map(len, in_reach(simulation)))
    change(simulation, support=1.6)
    find_sizes(simulation)
    gases = simulation.engine.of(Gases.name)
    simulation.neighbourhood.meet(gases._nearer)
    assert lacking(simulation)[0] > 0


def forces(simulation):
    """Accelerations and rates of heat by the rows that are met now."""
    simulation.listed = False
    simulation.engine.sum(simulation.is_due, 0.0, 0.0, ghosts_are_fresh=True)
    store = simulation.store
    return np.array([*store.shown("acceleration").T, store.shown("thermal_energy_rate")])


@pytest.mark.parametrize("sets", [(), MIRRORED], ids=["open", "mirrors"])
def test_forces_are_those_by_whole_lists(tmp_path, sets):
    simulation = cloud(tmp_path, *sets)
    for _ in range(5):
        simulation.step()
    by_rows = forces(simulation)
    simulation.neighbourhood.fit()
    by_lists = forces(simulation)
    assert np.abs(by_rows - by_lists).max() < 1e-12 * np.abs(by_lists).max()
    simulation.neighbourhood._lists.lengths[:] //= 2
    assert np.abs(forces(simulation) - by_lists).max() > 0.01 * np.abs(by_lists).max()


def test_who_grows_much_in_a_step_is_met_by_all_of_the_list(tmp_path):
    """The rows of others may lack it: forces go through the lists, and lengths are the same."""
    simulation = cloud(tmp_path)
    simulation.step()
    [right] = [np.array(simulation.store.shown("smoothing_length"), copy=True)]
    lists = simulation.domain.lists
    find_sizes(simulation)
    assert simulation.neighbourhood._lists is not lists
    simulation.store["inverse_length"][simulation.store.owned // 2] *= NEARER + 0.03
    find_sizes(simulation)
    assert simulation.domain.lists is lists and simulation.neighbourhood._lists is lists
    assert simulation.store.shown("smoothing_length") == pytest.approx(right, rel=1e-6)
    assert lacking(simulation)[0] == 0


BOX = """
scheme = "gas"

[space]
dimensions = 2
spacing = 0.05
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [4.0, 1.0]

[time]
end = 1.0

[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }
density = 1.0
pressure = 1.0
jitter = 0.2
"""


@pytest.mark.parametrize(("waves", "holds"), [(1, True), (8, False)])
def test_lists_serve_while_neighbours_go_together(tmp_path, waves, holds):
    """Particles stray by 0.2 of their support, one way here and the other there: far more than their own ways
    may be for lists to reach, and those of neighbours differ by little where the wave is long."""
    (tmp_path / "box.toml").write_text(BOX)
    simulation = start(load(tmp_path / "box.toml"))
    store, straying = simulation.store, simulation.neighbourhood.skin
    way = 0.2 * 2.0 * 1.4 * 0.05
    store["position"][0][store.inner] += way * np.sin(
        2.0 * np.pi * waves * store["position"][0][store.inner] / 4.0
    )
    assert straying.reach() == holds
    straying._together = False
    assert not straying.reach()  # by the way of each alone
    if holds:
        straying._together = True
        straying.reach()
        simulation.listed = True
        find_sizes(simulation)
        assert lacking_in_periods(simulation) == 0


@pytest.mark.parametrize(("beyond", "holds"), [(0.0, True), (0.02, True), (0.05, False)])
def test_lists_serve_beside_mirrors(tmp_path, beyond, holds):
    """All go on by much in the middle and nobody at the mirrors, but one that crosses a mirror, by a part of its
    support: images of those across from there come nearer than they stood."""
    mirrored = BOX.replace('periodic = ["x", "y"]', 'periodic = ["y"]\nsymmetry = ["x.lower", "x.upper"]')
    (tmp_path / "box.toml").write_text(mirrored)
    simulation = start(load(tmp_path / "box.toml"))
    store, straying = simulation.store, simulation.neighbourhood.skin
    support = 2.0 * 1.4 * 0.05
    x = store["position"][0][store.inner]
    x += 0.2 * support * np.sin(np.pi * x / 4.0)
    nearest = np.argmin(x)
    x[nearest] = -beyond * support if beyond else x[nearest]
    assert straying.reach() == holds
    if holds:
        simulation.listed = True
        find_sizes(simulation)
        assert lacking_images(simulation) == 0


def lacking_images(simulation):
    """How many pairs of a particle and another's image in the mirror at x = 0 are in reach but not in the lists."""
    store, lists = simulation.store, simulation.domain.lists
    x, h = store.shown("position"), store.shown("smoothing_length")
    apart = x[:, None] - x * [-1.0, 1.0]
    apart[:, :, 1] -= np.rint(apart[:, :, 1])
    near = (apart**2).sum(axis=2) < (2.0 * np.maximum(h[:, None], h)) ** 2
    np.fill_diagonal(near, False)
    assert near.sum() > 100
    for k in range(store.owned):
        begin = int(lists.begin[k])
        near[k, lists.lists[begin : begin + int(lists.lengths[k])].astype(int) - store.low] = False
    return int(near.sum())


def lacking_in_periods(simulation):
    """How many pairs in reach the lists lack, of particles and the nearest images of others."""
    store = simulation.store
    x, h, number = store.shown("position"), store.shown("smoothing_length"), store.id
    apart = x[:, None] - x
    for d, period in enumerate((4.0, 1.0)):
        apart[..., d] -= period * np.rint(apart[..., d] / period)
    near = (apart**2).sum(axis=2) < (2.0 * np.maximum(h[:, None], h)) ** 2
    np.fill_diagonal(near, False)
    ids = ids_of_columns(simulation)
    own = number[store.inner]
    found = [{int(ids[j]) for j in row} for row in rows(simulation.domain.lists, store.owned)]
    return sum(len({int(own[j]) for j in np.flatnonzero(line)} - have) for line, have in zip(near, found))


def ids_of_columns(simulation):
    """The numbers of all columns, ghosts too."""
    store = simulation.store
    ids = store.id[: store.total].copy()
    simulation.domain.halo.carry(ids)
    return ids
