"""Streams through open ends that are turned, moved or told in other units do the same."""

import numpy as np
import pytest
from invariances.running import begun
from invariances.scenes import DX
from invariances.streams import STREAMS
from invariances.transforms import TURNS_OF_A_SCENE, Shift, Units
from long import long_but_for
from scipy.spatial import cKDTree

STEPS = 120
FAR = (64.0, -32.0)
UNITS = Units(length=4.0, mass=8.0, time=2.0)


def stands(tables, folder):
    """Places, velocities, pressures and densities at the end, and how many have passed each end: some are
    born and die, so that ids tell nothing."""
    simulation = begun(tables, folder)
    for _ in range(STEPS):
        simulation.step()
    names = ("position", "velocity", "pressure", "density")
    books = [state.books for state in simulation.engine.of("ends").states]
    return *map(simulation.store.owned_rows, names), [(one.number_in, one.number_out) for one in books]


def alike(one, other, places, velocities, bound):
    """Whether one is the other, where its particles come to lie at ``places`` (n, dim), m, with
    ``velocities``, in spacings and parts of the largest."""
    apart, rows = cKDTree(other[0]).query(places)
    assert one[-1] == other[-1] and any(one[-1][0])
    assert len(set(rows.tolist())) == len(one[0]) == len(other[0])
    assert apart.max() < bound * DX
    for mine, theirs in ((velocities, other[1]), *zip(one[2:4], other[2:4])):
        assert abs(mine - theirs[rows]).max() < bound * abs(theirs).max()


@pytest.mark.parametrize("turn", TURNS_OF_A_SCENE)
@pytest.mark.parametrize("name", long_but_for(("open flow",), STREAMS))
def test_a_stream_that_is_turned_does_the_same(tmp_path, name, turn):
    turned = TURNS_OF_A_SCENE[turn]
    one, other = stands(STREAMS[name], tmp_path), stands(turned.of(STREAMS[name]), tmp_path)
    alike(one, other, turned.points(one[0]), turned.directions(one[1]), 1e-9)


@pytest.mark.parametrize("name", long_but_for(("open flow",), STREAMS))
def test_a_stream_that_is_moved_does_the_same(tmp_path, name):
    one, other = stands(STREAMS[name], tmp_path), stands(Shift(FAR).of(STREAMS[name]), tmp_path)
    alike(one, other, one[0] + np.array(FAR), one[1], 1e-9)


@pytest.mark.parametrize("name", long_but_for(("open flow",), STREAMS))
def test_a_stream_in_other_units_has_the_same_bits(tmp_path, name):
    one, other = stands(STREAMS[name], tmp_path), stands(UNITS.of(STREAMS[name]), tmp_path)
    for mine, theirs, unit in zip(one[:2], other[:2], ("m", "m/s")):
        np.testing.assert_array_equal(mine * UNITS.factor(unit), theirs)
