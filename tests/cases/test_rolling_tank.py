"""Sloshing in a rolling tank: what is given, and when the water comes."""

import math

import numpy as np
import pytest
from cases.measures import by_id, finished
from long import LONG

PERIOD = 1.63115


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
    late = probes["time"] > 2.0 * PERIOD
    time, pressure = probes["time"][late], np.nan_to_num(probes["left.pressure"][late])
    strengths = []
    for period in np.linspace(0.8, 1.2, 81) * PERIOD:
        turn = 2.0 * np.pi * time / period
        strengths.append((np.hypot(pressure @ np.sin(turn), pressure @ np.cos(turn)), period))
    assert max(strengths)[1] == pytest.approx(PERIOD, rel=0.05)
    assert pressure.max() > 2.0 * 9810.0 * 0.043  # twice what rests over the probe: bores hit the wall
