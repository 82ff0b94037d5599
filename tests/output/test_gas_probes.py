"""Probes in ideal gases, whose particles have each a weight of their own size; during a run, and after it."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.lab.measure.gauging import readings
from psph.output.probes import FieldProbe
from psph.output.reader import Run
from psph.runs.start import run

FAN = """
scheme = "gas"
space = { dimensions = 2, spacing = 0.05, lower = [0.0, 0.0], upper = [2.0, 1.0], symmetry = ["y.lower", "y.upper"] }
time.end = 0.4
output = { frames = 0.2, probes = 0.2, log = 0.2 }
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
density = "0.5 + x"
pressure = "1 + x + 0.5 * y"
[walls.ends]
condition = "mirror"
shape.difference.from.box = { lower = [-0.1, 0.0], upper = [2.1, 1.0] }
shape.difference.minus = [{ box = { lower = [0.0, -1.0], upper = [2.0, 2.0] } }]
[probes.inside]
position = [0.4, 0.2]
[gauges.inside.point]
position = [0.4, 0.2]
[gauges.edge.point]
position = [0.0, 0.0]
"""


def test_a_probe_reads_fields_among_unlike_sizes(tmp_path):
    """Densities from 0.5 to 2.5."""
    simulation = start(draft(tmp_path, FAN))
    simulation.settle_pressure()
    probe = FieldProbe("", np.array([1.2, 0.45]), ("pressure", "density"))
    pressure, density = probe.sample(simulation)
    assert pressure == pytest.approx(1.0 + 1.2 + 0.225, rel=0.01)
    assert density == pytest.approx(1.7, rel=0.03)


def test_beside_mirrors_images_count(tmp_path):
    """In a corner the velocity across both is 0, and the pressure that of the nearest."""
    simulation = start(draft(tmp_path, FAN))
    for _ in range(5):
        simulation.step()
    simulation.settle_pressure()
    corner = FieldProbe("", np.zeros(2), ("pressure", "velocity"))
    pressure, *velocity = corner.sample(simulation)
    assert velocity == pytest.approx([0.0, 0.0], abs=1e-12)
    assert pressure == pytest.approx(1.05, rel=0.05)


def test_what_is_measured_after_the_run_is_what_was_measured(tmp_path):
    """To the bit; a probe and a gauge of a point are one."""
    folder = tmp_path / "out"
    run(draft(tmp_path, FAN), folder, MPI.COMM_SELF, say=lambda *_: None)
    during = Run(folder).table("gauge-inside.csv")
    assert np.array_equal(during["inside.pressure"], Run(folder).probes()["inside.pressure"])
    assert np.ptp(during["inside.pressure"]) > 0.01
    after = readings(folder).tables
    for name in ("inside", "edge"):
        table = Run(folder).table(f"gauge-{name}.csv")
        assert {*table} == {*after[name]} and len(table["time"]) == 3
        assert all(np.array_equal(table[column], after[name][column]) for column in table)
