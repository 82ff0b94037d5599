"""Cells, columns, lists and ids past 2^31: on sparse files, since the memory for them is not here."""

from functools import partial

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI
from stores import store_of

from psph.parallel.halo import _slice_type
from psph.particles import neighbours
from psph.particles.cells import make_grid, number_cells, planes_of, sort_by_cell
from psph.particles.store import MOST, TooManyParticles, check_room, permute

COLUMNS = 3 * 2**30
"""So far the particles of a small rank are shifted: past 2^31, short of 2^32."""

ENTRIES = 2**32 + 8
"""So far its lists are."""


def sparse(folder, shape, dtype):
    """An array of zeros in a file that takes no room on the disk."""
    path = folder / "sparse"
    array = np.asarray(np.memmap(path, dtype, "w+", shape=shape))
    path.unlink()  # it lives as long as the array
    return array


def shifted(folder, array, by):
    """The same numbers, ``by`` columns further."""
    far = sparse(folder, (*array.shape[:-1], by + array.shape[-1]), array.dtype)
    far[..., by:] = array
    return far


def small(folder):
    """A simulation of 50 particles, open on all sides."""
    return start(draft(folder, TEXT))


TEXT = """
space = { dimensions = 2, spacing = 0.1, smoothing = 1.3 }
time.end = 2.0
physics.sound_speed = 10.0
physics.artificial_viscosity = 0.1
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
jitter = 0.2
pressure = 1000.0
"""


@pytest.fixture
def near_and_far(tmp_path):
    """Twins: one in the first columns, one with columns past 2^31 and lists past 2^32."""
    near, far = small(tmp_path), small(tmp_path)
    store, domain = far.store, far.domain
    store.hold(*(shifted(tmp_path, a, COLUMNS) for a in (store.data, store.id, store.group)))
    store.low += COLUMNS
    for records in far.engine.records:
        table = records.table
        records.table = sparse(tmp_path, (COLUMNS + len(table), table.shape[1]), table.dtype)
        records.table[COLUMNS:] = table
        # The columns before these were never ghosts.
        records.fill = partial(_from_there_on, records.fill)
    domain.starts = domain.starts + COLUMNS
    domain.lists = domain.lists._replace(
        begin=domain.lists.begin + np.uint64(ENTRIES),
        lists=shifted(tmp_path, domain.lists.lists + np.uint32(COLUMNS), ENTRIES),
    )
    far.engine.neighbourhood.fit()
    return near, far


def _from_there_on(fill, first, last):
    fill(max(first, COLUMNS), max(last, COLUMNS))


def test_a_step_is_the_same_past_2_31(near_and_far):
    near, far = near_and_far
    for simulation in (near, far):
        rebuilds = simulation.domain.rebuilds
        simulation.step()
        assert simulation.domain.rebuilds == rebuilds
    assert far.store.low > 2**31 and far.dt == near.dt
    for name in ("id", "position", "velocity", "density", "acceleration", "density_rate"):
        assert np.array_equal(far.store.owned_rows(name), near.store.owned_rows(name))
    assert near.store.owned_rows("acceleration").any()


def test_lists_name_columns_past_2_31(near_and_far):
    near, far = near_and_far
    domain = far.domain
    lists = neighbours.build(
        neighbours.empty(0, 0),
        far.store,
        domain.grid,
        domain.starts,
        domain.planes,
        domain.reach,
        domain.periods,
        domain.lanes,
        None if domain.sought is None else far.store[domain.sought],
        neighbours.fill_lists,
    )
    used = int(near.domain.lists.begin[near.store.owned - 1])
    expected = near.domain.lists.lists[:used].astype(np.int64) + COLUMNS
    assert used > 0 and np.array_equal(lists.lists[:used], expected)


def test_sorting_moves_columns_past_2_31(near_and_far):
    near, far = near_and_far
    order = np.arange(near.store.owned, dtype=np.uint32)[::-1].copy()
    for simulation, shift in ((near, 0), (far, COLUMNS)):
        permute(simulation.store.data, order + np.uint32(shift), shift, np.empty(len(order)))
    assert np.array_equal(far.store.owned_rows("position"), near.store.owned_rows("position"))


def test_messages_reach_past_2_31(near_and_far):
    near, far = near_and_far
    data, rows = far.store.data, [0, len(far.store.data) - 1]
    away, here = _slice_type(data, rows, COLUMNS, 8), _slice_type(data, rows, COLUMNS + 8, 8)
    assert away.Get_true_extent()[0] == 8 * COLUMNS
    MPI.COMM_SELF.Sendrecv([data, 1, away], 0, recvbuf=[data, 1, here], source=0)
    for row in rows:
        assert np.array_equal(data[row, COLUMNS + 8 : COLUMNS + 16], near.store.data[row, :8])


def test_cells_are_numbered_past_2_31():
    """5,000 planes of 2,000 rows of 4,000 columns."""
    grid = make_grid(0, 1.0, (0.0,) * 3, (5000.0, 2000.0, 1000.0), (None,) * 3)
    assert grid.counts == (5000, 2000, 4000) and np.prod(grid.counts) > 2**35
    x = np.array([0.5, 4999.5, 2500.5]), np.array([0.5, 1999.5, 3.5]), np.array([0.1, 999.9, 0.3])
    cells = np.empty(3, np.int64)
    number_cells(x, 0, 3, grid.lower, grid.inverse, grid.along_axes, cells)
    assert cells.tolist() == [0, 5000 * 2000 * 4000 - 1, (2500 * 2000 + 3) * 4000 + 1]
    assert planes_of(cells, grid).tolist() == [0, 4999, 2500]


def test_sorting_into_cells_past_2_31_by_ids_past_2_31(tmp_path):
    base = 2**33
    cells = base + np.array([2, 0, 2, 1, 2])
    ids = shifted(tmp_path, np.array([2**40 + 3, 2**40, 2**31, 2**33, 2**40 + 2]), COLUMNS)
    starts, order = np.empty(4, np.int64), np.empty(5, np.int64)
    sort_by_cell(cells, ids, COLUMNS, base, starts, order)
    assert starts.tolist() == [0, 1, 2, 5]
    assert (order - COLUMNS).tolist() == [1, 3, 2, 4, 0]


def test_a_rank_that_cannot_hold_its_share_is_refused_before_any_work():
    store = store_of(3, ("position",))
    with pytest.raises(TooManyParticles, match="4,294,967,233 particles and ghosts on one rank"):
        store.reserve(MOST + 1)
    assert store.capacity < 100
    check_room(MOST, 1)
    with pytest.raises(TooManyParticles, match="use 3 ranks or more") as refused:
        check_room(2 * MOST + 1, 2)
    assert "\n" not in str(refused.value)
