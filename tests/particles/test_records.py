"""What a record holds of a particle, and what comes out of it."""

import numba
import numpy as np
import pytest
from stores import store_of

from psph.composition.pair import FOLDED, fetch
from psph.composition.space import Metres, fixed_point
from psph.engine.simd import spread, total, width_of
from psph.particles.records import Records, record_width, recorded

HELD = ("position", "predicted_velocity", "pressure", "specific_volume", "is_fluid")
SPACES = {"double": Metres((None, None)), "mixed": fixed_point(0.1, (None, None))}


@numba.njit
def sums(view, records, lists):
    """Σ 1/ρ, the number of fluid particles and their Σ p over the listed particles."""
    volume, fluids, pressure = spread(0.0, records), spread(0.0, records), spread(0.0, records)
    for n in range(np.uint64(0), np.uint64(len(lists)), width_of(records)):
        j = fetch(view, records, lists, n)
        volume = volume + j.specific_volume
        fluids = fluids + j.is_fluid
        pressure = pressure + j.pressure * j.is_fluid
    return total(volume), total(fluids), total(pressure)


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
def test_a_wall_is_told_by_a_sign_and_takes_no_place(space):
    rng = np.random.default_rng(5)
    store, n = store_of(2, HELD), 16
    block = rng.uniform(0.5, 2.0, (7, n)).astype(np.float32).astype(float)
    fluid = block[-1] = rng.integers(0, 2, n)
    store.append(np.arange(n), 1 - fluid.astype(np.uint8), block)
    store.reorder(np.arange(n), 0, 0)
    records = Records(store, HELD, space)
    records.make_room()
    records.fill(0, store.total)
    assert records.width == record_width(6) == record_width(sum(len(store.rows[f]) for f in recorded(HELD)))
    assert records.view().is_fluid is FOLDED
    found = sums(records.view(), records.table, np.arange(n, dtype=np.uint32))
    volume, pressure = block[store.rows["specific_volume"].start], block[store.rows["pressure"].start]
    assert found == pytest.approx((volume.sum(), fluid.sum(), (pressure * fluid).sum()), rel=1e-6)
    j = fetch(records.view(), records.table, np.arange(n), int(np.argmin(fluid)))
    assert j.is_fluid == 0.0 and j.specific_volume > 0.0


def test_without_walls_the_records_are_as_they_stand():
    names = HELD[:-1]
    store = store_of(2, names, {"is_fluid": 1.0})
    store.append(np.arange(3), np.zeros(3, np.uint8), np.full((6, 3), 2.0))
    store.reorder(np.arange(3), 0, 0)
    records = Records(store, names, SPACES["double"])
    records.make_room()
    records.fill(0, store.total)
    assert records.view().is_fluid == 1.0 and (records.table[:3, :6] == 2.0).all()


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
def test_a_fluid_of_negative_density_is_no_wall(space):
    """A run that goes on in spite of its guards may have one."""
    store, n = store_of(2, HELD), 16
    fluid = np.arange(n) % 2
    block = np.full((7, n), 2.0)
    block[-1] = fluid
    block[store.rows["specific_volume"].start, :4] = -2.0
    store.append(np.arange(n), 1 - fluid.astype(np.uint8), block)
    store.reorder(np.arange(n), 0, 0)
    records = Records(store, HELD, space)
    records.make_room()
    records.fill(0, n)
    for k in range(n):
        j = fetch(records.view(), records.table, np.arange(n), k)
        assert j.is_fluid == fluid[k] and j.specific_volume == 2.0


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize(
    "seldom", [(), ("pressure",), ("pressure", "specific_volume"), ("predicted_velocity", "pressure")]
)
def test_what_is_written_seldom_is_left_as_it_is(space, seldom):
    """From three to six numbers are copied again, over more particles than a block has."""
    rng, (store, n) = np.random.default_rng(7), (store_of(2, HELD), 150)
    block = rng.uniform(0.5, 2.0, (7, n))
    block[-1] = fluid = rng.integers(0, 2, n)
    store.append(np.arange(n), 1 - fluid.astype(np.uint8), block)
    store.reorder(np.arange(n), 0, 0)
    records, whole = (Records(store, HELD, space, {}, names) for names in (seldom, ()))
    for one in (records, whole):
        one.make_room()
    records.fill(0, n)
    first = records.table.copy()
    records.settle()
    store.data[:-1, :n] *= 1.5
    records.fill(3, n)
    whole.fill(3, n)
    kept = [name in seldom for name in records._names for _ in store.rows[name]]
    assert (records.table[:3] == first[:3]).all()
    for f, as_it_was in enumerate(kept):
        assert (records.table[3:n, f] == (first if as_it_was else whole.table)[3:n, f]).all()
    assert (first[3:n, :6] != whole.table[3:n, :6]).all()
