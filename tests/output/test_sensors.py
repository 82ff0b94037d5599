"""Sensors: the mean of a field over the points of an area."""

import numpy as np
import pytest
from drafts import TANK, draft, refusal
from gauging import started

from psph.output.probes import FieldProbe, sensor
from psph.runs.record import probes_of

ON_THE_WALL = """
[probes.wide]
position = [1.0, 0.25]
extent = [0.0, 0.3]
[probes.over_the_surface]
position = [1.0, 0.6]
extent = [0.0, 0.6]
fields = ["pressure", "density"]
[probes.dry]
position = [1.0, 1.5]
extent = [0.0, 0.1]
"""


def test_a_sensor_has_points_a_spacing_apart_at_most_and_even_around_its_middle():
    assert sensor((1.0, 2.0), (0.0, 0.0), 0.1).tolist() == [[1.0, 2.0]]
    line = sensor((1.0, 2.0), (0.0, 0.3), 0.1)
    assert line == pytest.approx(np.array([[1.0, 1.9], [1.0, 2.0], [1.0, 2.1]]))
    plate = sensor((0.0, 0.0, 5.0), (0.25, 0.0, 0.1), 0.1)
    assert plate.shape == (3, 3) and np.ptp(plate[:, 0]) == pytest.approx(0.5 / 3)
    assert plate.mean(axis=0) == pytest.approx([0.0, 0.0, 5.0])


def test_a_sensor_tells_the_mean_over_its_area(tmp_path):
    simulation, scene = started(draft(tmp_path, TANK + ON_THE_WALL))
    simulation.settle_pressure()
    probes = probes_of(scene.case)
    wide, over, dry = (probe.sample(simulation) for probe in probes)
    points = [FieldProbe("", np.array([1.0, y]), ("pressure",)) for y in (0.15, 0.25, 0.35)]
    each = [point.sample(simulation)[0] for point in points]
    assert np.ptp(each) > 1000.0
    assert wide == pytest.approx(np.mean(each), rel=1e-12)
    assert wide == pytest.approx(1000.0 * 9.8 * 0.25, rel=0.02)
    # Half of it is above the water: it bears nothing there, and the density is that of the wet part.
    heights = 0.3 + 0.6 * (np.arange(6) + 0.5) / 6
    told = [FieldProbe("", np.array([1.0, y]), ("pressure", "density")).sample(simulation) for y in heights]
    told = np.array(told)
    assert np.isnan(told[-1, 1]) and told[-1, 0] == 0.0 and np.isfinite(told[0]).all()
    assert over[0] == pytest.approx(told[:, 0].mean(), rel=1e-12)
    assert over[1] == pytest.approx(np.nanmean(told, axis=0)[1], rel=1e-12)
    assert dry.tolist() == [0.0] and [probe.dry for probe in probes] == [0, 0, 1]


def test_an_extent_that_is_none_is_refused(tmp_path):
    for keys in ("position = [0.5, 0.1]\nextent = [0.0, -0.1]", 'front = "x"\nextent = [0.0, 0.1]'):
        found = refusal(tmp_path, TANK + f"[probes.P]\n{keys}\n")
        assert any("probes.P.extent" in line and "give lengths of 0 or more" in line for line in found)
