"""Joints and lines of bodies over the seam of a period, and joints far from the origin."""

import numpy as np
import pytest
from drafts import draft
from dry import Dry

PAIR = """
time.end = 1.0
physics = {{ gravity = [0.0, -9.81], sound_speed = 100.0 }}
space = {{ dimensions = 2, spacing = 0.05, periodic = ["x"], lower = [{low}, -2.0], upper = [{up}, 4.0] }}
[fluids.drop]
shape.box = {{ lower = [{low}, 3.0], upper = [{drop}, 3.2] }}
[bodies.left]
shape.box = {{ lower = [{left}, 0.0], upper = [{middle}, 0.2] }}
density = 500.0
[bodies.right]
shape.box = {{ lower = [{other}, 0.0], upper = [{right}, 0.2] }}
density = 500.0
"""
HINGES = """
[joints.wall]
of = ["left"]
hinge.at = [{left}, 0.1]
[joints.elbow]
of = ["right", "left"]
hinge.at = [{middle}, 0.1]
"""
ROD = """
[joints.rod]
of = ["right", "left"]
rod = {{ at = [{end}, 0.1], anchor = [{begin}, 0.1] }}
"""
SPRING = """
[bodies.left.lines.spring]
at = [{begin}, 0.1]
anchor = [{end}, 0.15]
to = "right"
stiffness = 1000.0
length = 0.1
"""


def dry(folder, text, left, low=0.0):
    """Two boxes of 0.4 m side by side, from ``left`` on, in a period of 2 m from ``low`` on; the right one is
    drawn in it, and what joins them beside the left one."""
    other = left + 0.4 if left + 0.8 <= low + 2.0 else low
    places = {"left": left, "middle": left + 0.4, "other": other, "right": other + 0.4}
    places |= {"begin": left + 0.3, "end": left + 0.5, "low": low, "up": low + 2.0, "drop": low + 0.2}
    return Dry(draft(folder, text.format(**{name: round(x, 6) for name, x in places.items()})), 1e-3)


@pytest.mark.parametrize("joined", (HINGES, HINGES.split("[joints.elbow]")[0] + ROD, SPRING))
def test_over_a_seam_bodies_move_as_away_from_it(tmp_path, joined):
    one, other = (dry(tmp_path, PAIR + joined, left).to(0.2) for left in (0.6, 1.6))
    assert np.abs(one.spin).max() > 0.1
    assert other.spin == pytest.approx(one.spin, abs=1e-9)
    assert other.ahead == pytest.approx(one.ahead, abs=1e-9)


@pytest.mark.parametrize("far", (100.0, 1e5))
def test_far_from_the_origin_joints_hold_as_near_it(tmp_path, far):
    """To what places are rounded to."""
    one, other = (dry(tmp_path, PAIR + HINGES, low + 0.6, low).to(0.2) for low in (0.0, far))
    assert other.spin == pytest.approx(one.spin, abs=1e-8 * far)
