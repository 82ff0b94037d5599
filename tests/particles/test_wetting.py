"""Which walls are wet: fluid makes them so within its reach, and leaves them so a little farther out."""

import numpy as np
import pytest

from psph.particles.neighbours import Neighbours
from psph.particles.wetting import mark_wet, rest_dry

SUPPORT, CUTOFF, PERIOD = 1.0, 1.2, 10.0


def wet_at(distance, before, other_is_fluid=1.0, first=9.5, bearing=True):
    """Whether a wall is wet with a neighbour at a distance, across the end of a period, if it was before."""
    x = np.array([first, (first + distance) % PERIOD])
    is_fluid, wet = np.array([0.0, other_is_fluid]), np.array([before, 1.0])
    lists = Neighbours(np.array([0, 1], np.uint64), np.array([1, 1], np.uint32), np.array([1, 0], np.uint32))
    group, bears = np.array([1, 0], np.uint8), np.array([True, bearing])
    mark_wet(0, 2, 0, lists, SUPPORT, CUTOFF, (PERIOD,), (x,), group, bears, is_fluid, wet)
    assert wet[1] == other_is_fluid  # fluid counts as wet, a wall beside a wall does not
    return wet[0]


@pytest.mark.parametrize(("distance", "was_dry", "was_wet"), [(0.9, 1, 1), (1.1, 0, 1), (1.3, 0, 0)])
def test_a_wall_stays_what_it_was_between_support_and_cutoff(distance, was_dry, was_wet):
    assert wet_at(distance, 0.0) == was_dry and wet_at(distance, 1.0) == was_wet


def test_another_wall_makes_no_wall_wet():
    assert wet_at(0.5, 1.0, other_is_fluid=0.0) == 0.0


def test_fluid_does_not_wet_a_wall_that_bears_nothing():
    assert wet_at(0.5, 1.0, bearing=False) == 0.0


def lengths_after(wet, is_fluid, group, bearing=True, solid_of=(0, 1), mirrored=False):
    """The lengths of the rows of three particles, each beside the next one, once dry walls rest."""
    lists = Neighbours(np.arange(3, dtype=np.uint64), np.ones(3, np.uint32), np.array([1, 2, 0], np.uint32))
    bears, groups = np.array([True] + [bearing] * (len(solid_of) - 1)), np.array(group, np.uint8)
    solids = np.array(solid_of, float)[groups]
    rest_dry(0, 3, 0, lists, np.array(is_fluid), np.array(wet), groups, bears, solids, np.uint8(1), mirrored)
    return lists.lengths.tolist()


def test_a_dry_wall_without_fluid_in_its_list_rests():
    """The first has a wall beside it, the second a fluid, out of reach but listed."""
    assert lengths_after(wet=[0.0, 0.0, 1.0], is_fluid=[0.0, 0.0, 1.0], group=[1, 1, 0]) == [0, 1, 1]


def test_what_is_wet_or_moves_freely_does_not_rest():
    assert lengths_after(wet=[1.0, 0.0, 1.0], is_fluid=[0.0, 0.0, 0.0], group=[1, 1, 1]) == [1, 0, 1]
    assert lengths_after(wet=[0.0, 0.0, 0.0], is_fluid=[0.0, 0.0, 0.0], group=[0, 0, 1]) == [1, 1, 0]


def test_a_wall_that_bears_nothing_rests_beside_the_fluid():
    """The second has a fluid in its list."""
    assert lengths_after(wet=[0.0, 0.0, 1.0], is_fluid=[0.0, 0.0, 1.0], group=[1, 1, 0], bearing=False) == [
        0,
        0,
        1,
    ]


def test_a_body_that_may_touch_another_solid_does_not_rest():
    """The first is of a body beside a wall, the second of the wall beside another body, the third of that body."""
    dry = {"wet": [0.0] * 3, "is_fluid": [0.0] * 3, "solid_of": (0, 1, 2, 3)}
    assert lengths_after(group=[2, 1, 3], **dry) == [1, 0, 1]
    assert lengths_after(group=[2, 2, 2], **dry) == [0, 0, 0]


def test_a_body_that_may_touch_its_own_image_does_not_rest():
    """The first two are of a body, the third of a wall."""
    dry = {"wet": [0.0] * 3, "is_fluid": [0.0] * 3, "solid_of": (0, 1, 2), "group": [2, 2, 1]}
    assert lengths_after(mirrored=True, **dry) == [1, 1, 0]
