"""Soils against what the theory of plasticity and mechanics say of them, and the controls."""

import math

import numpy as np
import pytest
from cases.measures import finished
from numpy.polynomial import polynomial

pytestmark = pytest.mark.timeout(900)

G, MU = 9.81, math.sin(math.radians(30.0))
"""Gravity, and what sand of 30° without dilatancy bears on a plane of slip over its pressure."""


def sliding(tmp_path, angle, *sets):
    """How fast a layer on a slope of this angle gains speed after its first quarter, m/s²; and its last speed."""
    theta = math.radians(angle)
    pull = f"physics.gravity=[{G * math.sin(theta)!r}, {-G * math.cos(theta)!r}]"
    run = finished("soils/infinite_slope", tmp_path / f"{angle}", pull, "output.log=0.005", *sets)
    time, momentum = run.log["time"], run.log["momentum_x"]
    speed = momentum / (1800.0 * 0.1 * 0.08)
    late = time > 0.25 * time[-1]
    return polynomial.polyfit(time[late], speed[late], 1)[1], speed[-1]


def test_a_layer_of_sand_rests_on_a_slope_below_its_friction_and_slides_above_it(tmp_path):
    gain, speed = sliding(tmp_path, 24.0)
    assert abs(gain) < 0.003 * G and abs(speed) < 0.02
    theta = math.radians(35.0)
    gain, _ = sliding(tmp_path, 35.0)
    assert gain == pytest.approx(G * (math.sin(theta) - MU * math.cos(theta)), rel=0.03)


def front(run, frame=-1, part=0.98):
    """The place that this part of the sand has not passed, m."""
    found = run.frame(frame)
    return float(np.quantile(found["position"][found["kind"] == 0][:, 0], part))
