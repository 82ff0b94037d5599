"""Charts of gauges, with measured curves beside them."""

import shutil
import subprocess
import sys

import numpy as np
import pytest
from drafts import TANK
from mpi4py import MPI

from psph.case import load
from psph.lab.study.beside import beside
from psph.output.gauges.units import quantity_of, unit_of
from psph.output.pictures import charts
from psph.output.pictures.plot import plot
from psph.output.reader import Run
from psph.runs.start import run

GAUGED = (
    TANK
    + """
[gauges.tank.force]
on = ["tank"]
[gauges.wire.level]
foot = [0.5, 0.0]
top = [0.5, 0.7]
[experiments.wire]
file = "wire.csv"
time = "t"
value = "h"
value_unit = 0.01
probe = "wire.level"
[output]
frames = 0.01
probes = 0.002
"""
)


@pytest.fixture(scope="module")
def gauged(tmp_path_factory):
    """The folder of a short run with two gauges and a measured level, 25 % lower, its file beside the case."""
    folder = tmp_path_factory.mktemp("gauged")
    (folder / "case.toml").write_text(GAUGED)
    (folder / "wire.csv").write_text("# in cm\nt,h\n0.0,40.0\n0.01,40.0\n5.0,12.0\n")
    run(load(folder / "case.toml", ["time.end=0.02"]), folder / "run", MPI.COMM_SELF, say=lambda *line: None)
    return folder / "run"


def test_each_gauge_has_its_chart_and_the_experiment_beside_it(gauged):
    column = charts.gauge_charts(Run(gauged), 2)
    assert [chart.title for chart in column["wire"]] == ["level", "wetted"]
    assert [(c.title, c.unit, list(c.curves)) for c in column["tank"]] == [
        ("force", "N/m", ["x", "y"]),
        ("moment", "N m/m", ["z"]),
    ]
    [one] = beside(gauged)
    level, wetted = charts.with_measured(column["wire"], "wire", [one])
    assert not wetted.measured and np.array_equal(level.measured["wire, measured"], [[0.0, 0.01], [0.4, 0.4]])
    assert one.error == pytest.approx(0.25, abs=0.02)
    assert "wire.level beside wire: 2" in one.in_words() and "% apart" in one.in_words()


def test_pictures_of_gauges_are_drawn_and_removed_with_the_others(gauged, tmp_path):
    folder = shutil.copytree(gauged, tmp_path / "run")
    made = plot(folder, times=[0.0], experiments=beside(folder))
    assert {"gauge-tank.png", "gauge-wire.png"} <= {path.name for path in made}


def test_the_command_says_how_far_apart_they_are(gauged):
    job = subprocess.run(
        [sys.executable, "-m", "psph", "plot", gauged, "--times", "0"],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert job.returncode == 0, job.stderr
    assert "wire.level beside wire: 2" in job.stdout and "gauge-wire.png" in job.stdout


def test_an_experiment_that_is_gone_is_left_out(gauged, tmp_path):
    folder = shutil.copytree(gauged, tmp_path / "run")
    (folder / "wire.csv").unlink()
    assert beside(folder) == []


@pytest.mark.parametrize(
    ("column", "quantity", "unit"),
    [
        ("box.centre_x", ("centre", "x"), "m"),
        ("box.tension_left_line", ("tension", "left_line"), "N/m"),
        ("sluice.mass_flow", ("mass_flow", ""), "kg/(m s)"),
        ("sluice.flow", ("flow", ""), "m²/s"),
        ("in.pressure", ("pressure", ""), "Pa"),
        ("box.spin_z", ("spin", "z"), "rad/s"),
        ("slope.run_up", ("run_up", ""), "m"),
        ("slope.height", ("height", ""), "m"),
        ("box.reaction_y", ("reaction", "y"), "N/m"),
        ("box.reaction_moment_z", ("reaction_moment", "z"), "N m/m"),
    ],
)
def test_columns_have_quantities_and_units(column, quantity, unit):
    assert quantity_of(column) == quantity and unit_of(quantity[0], 2) == unit
