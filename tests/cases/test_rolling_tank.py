"""Sloshing in a rolling tank: what is given, and when the water comes."""

import math

import numpy as np
import pytest
from cases.measures import by_id, finished
from long import LONG

PERIOD = 1.63115

RESTING = 1000.0 * 9.81 * (0.093 - 0.05)
"""Pressure at the probe before the tank rolls, Pa."""


@LONG
def test_the_tank_rolls_as_told_and_the_water_comes_once_a_period(tmp_path):
    found = finished("rolling_tank", tmp_path / "run")
    first = by_id(found.frame(0))
    wall = first["kind"] == 1
    x, y = first["position"][wall][:, :2].T
    for n in range(len(found.times)):
        time = float(found.times[n])
        if time > PERIOD:
            angle = math.radians(4.0) * math.sin(2.0 * math.pi * time / PERIOD)
            told = np.column_stack(
                [x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)]
            )
            assert by_id(found.frame(n))["position"][wall][:, :2] == pytest.approx(told, abs=1e-6)
    probes = found.probes()
    time, pressure = probes["time"], np.nan_to_num(probes["left.pressure"])
    arrivals, dry = [], False
    for t, p in zip(time, pressure):
        dry = dry or (t > PERIOD and p < 0.25 * RESTING)
        late = not arrivals or t > arrivals[-1] + 0.75 * PERIOD  # the same bore splashes
        if dry and late and p > RESTING:
            arrivals, dry = [*arrivals, t], False
    assert len(arrivals) == 3
    assert np.diff(arrivals) == pytest.approx(PERIOD, rel=0.02)
    assert pressure.max() > 3.0 * RESTING  # it hits the wall
