"""Which walls are wet: fluid makes them so within its reach, and leaves them so up to its end."""

import numpy as np
import pytest

from psph.particles.neighbours import Neighbours
from psph.particles.wetting import (
    DryRows,
    find_beside_fluid,
    find_felt,
    find_resting,
    find_undecided,
    mark_wet,
)

SUPPORT, SKIN, PERIOD = 1.0, 0.2, 10.0


def lists_of(*names):
    """Rows of one neighbour each."""
    count = len(names)
    return Neighbours(
        np.arange(count, dtype=np.uint64), np.ones(count, np.uint32), np.array(names, np.uint32)
    )


def a_pair(distance, before, other_is_fluid, first=9.5, served=True, bearing=True):
    """A wall, wet or not before, and a neighbour at a distance across the end of a period: places, then what
    the loops read after them."""
    x = np.array([first, (first + distance) % PERIOD])
    is_fluid, wet = np.array([0.0, other_is_fluid]), np.array([before, 1.0])
    serves = np.array([[False] * 3, [False, bearing and served, bearing]])
    return (x,), np.array([1, 0], np.uint8), serves, is_fluid, wet


def wet_at(distance, before, other_is_fluid=1.0, rests=True, **more):
    """Whether a wall is wet with a neighbour at a distance, if it was before; if not, its row may be empty."""
    position, group, bears, is_fluid, wet = a_pair(distance, before, other_is_fluid, **more)
    both, lists = np.array([0, 1], np.uint64), lists_of(1, 0)
    rows = DryRows(lists.lengths.copy(), np.array([rests, False]))
    mark_wet(0, 2, both, 0, lists, rows, SUPPORT, (PERIOD,), position, group, bears, is_fluid, wet)
    assert wet[1] == other_is_fluid  # fluid counts as wet, a wall beside a wall does not
    assert lists.lengths.tolist() == [wet[0] > 0.0 if rests else 1, 1]
    return wet[0]


@pytest.mark.parametrize(("distance", "was_dry", "was_wet"), [(0.94, 1, 1), (0.96, 0, 1), (1.01, 0, 0)])
def test_a_wall_stays_what_it_was_at_the_edge_of_the_support(distance, was_dry, was_wet):
    assert wet_at(distance, 0.0) == was_dry and wet_at(distance, 1.0) == was_wet
    assert wet_at(distance, 1.0, rests=False) == was_wet


def undecided_at(distance, before, other_is_fluid=1.0, **more):
    """Whether each of the pair may change while the lists last."""
    found = np.zeros(2, bool)
    reach, rest = SUPPORT - SKIN, a_pair(distance, before, other_is_fluid, **more)
    find_undecided(0, 2, 0, lists_of(1, 0), reach, (PERIOD,), *rest, found)
    return found.tolist()


@pytest.mark.parametrize(("distance", "was_dry", "was_wet"), [(0.79, True, False), (0.81, True, True)])
def test_what_a_skin_cannot_change_is_decided(distance, was_dry, was_wet):
    """Nor is the fluid itself ever in doubt."""
    assert undecided_at(distance, 0.0) == [was_dry, False]
    assert undecided_at(distance, 1.0) == [was_wet, False]


def test_a_dry_wall_without_fluid_in_its_list_is_decided():
    """One that is still wet there becomes dry."""
    assert undecided_at(0.5, 0.0, other_is_fluid=0.0)[0] is False
    assert undecided_at(0.5, 1.0, other_is_fluid=0.0)[0] is True
    assert undecided_at(0.9, 0.0, bearing=False) == [False, False]


@pytest.mark.parametrize(
    ("distance", "was_dry", "was_half"), [(0.94, 0.5, 0.5), (0.96, 0, 0.5), (1.01, 0, 0)]
)
def test_a_fluid_that_a_wall_does_not_serve_makes_it_half_wet(distance, was_dry, was_half):
    """One that was wet before is so too; sums go on where fluid is in reach."""
    assert wet_at(distance, 0.0, served=False) == was_dry
    assert wet_at(distance, 0.5, served=False) == wet_at(distance, 1.0, served=False) == was_half


def test_a_wall_that_is_half_wet_waits_for_a_fluid_that_it_serves():
    """Near one it does not stay what it is; without one in its list it is decided, as the wet one is not."""
    assert undecided_at(0.7, 0.5)[0] and undecided_at(0.7, 1.0, served=False)[0]
    assert not undecided_at(0.7, 0.5, served=False)[0] and undecided_at(0.9, 0.5, served=False)[0]


def test_another_wall_makes_no_wall_wet():
    assert wet_at(0.5, 1.0, other_is_fluid=0.0) == 0.0


def test_fluid_does_not_wet_a_wall_that_bears_nothing():
    assert wet_at(0.5, 1.0, bearing=False) == 0.0


def test_walls_rest_and_what_moves_freely_does_not():
    found, groups = np.zeros(3, bool), np.array([1, 0, 1], np.uint8)
    find_resting(0, 3, 0, lists_of(1, 2, 0), groups, np.uint8(1), found)
    assert found.tolist() == [True, False, True]


@pytest.mark.parametrize(("loaded", "says"), [(True, [True, False, False]), (False, [False] * 3)])
def test_of_walls_whose_load_is_asked_for_those_that_list_fluid_are_found(loaded, says):
    """Three particles, each beside the next one; the second is fluid."""
    found, groups = np.zeros(3, bool), np.array([1, 0, 1], np.uint8)
    is_fluid, asked = np.array([0.0, 1.0, 0.0]), np.array([False, loaded])
    find_beside_fluid(0, 3, 0, lists_of(1, 2, 0), asked, groups, is_fluid, found)
    assert found.tolist() == says


@pytest.mark.parametrize(
    ("distance", "is_fluid", "felt"), [(0.99, 1.0, True), (1.01, 1.0, False), (0.9, 0.0, False)]
)
def test_a_wall_feels_fluid_within_the_support_alone(distance, is_fluid, felt):
    position, *_ = a_pair(distance, 0.0, is_fluid)
    lists, walls, found = lists_of(1, 0), np.array([0], np.uint64), np.zeros(1, bool)
    find_felt(
        0, 1, walls, 0, lists, lists.lengths, SUPPORT, (PERIOD,), position, np.array([0.0, is_fluid]), found
    )
    assert found.tolist() == [felt]
