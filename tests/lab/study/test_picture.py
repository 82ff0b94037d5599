"""The diagram of a study: its axes can be read."""

import pytest
from matplotlib.ticker import LogLocator

from psph.lab.study.picture import _numbers


def shown(locator, low, high):
    """The numbers of an axis that are in view."""
    return [number for number in locator.tick_values(low, high) if low <= number <= high]


@pytest.mark.parametrize(("low", "high"), [(0.59, 1.11), (1.6, 1.81), (2.1, 4.9), (0.6, 8.0), (0.9, 1e4)])
def test_an_axis_has_numbers_enough_to_be_read(low, high):
    assert 2 <= len(shown(_numbers(low, high), low, high)) <= 13


def test_the_control_one_number_is_no_scale():
    assert len(shown(LogLocator(subs=(1.0, 2.0, 5.0)), 0.59, 1.11)) == 1
