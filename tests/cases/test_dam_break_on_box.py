"""A dam break onto a box against the experiment of Kleefsman and others (2005)."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from jobs import mpirun

from psph.case import load
from psph.lab.study.experiment import read_experiment
from psph.output.reader import Run

BOX = Path(CASES) / "dam_break_on_box.toml"

BEGIN, END = 0.40, 0.60
"""Seconds around the impact."""


JITTERS = (0.01, 0.02, 0.03)
"""Other starts, in spacings: what a splash does depends on the last place of its numbers."""


def pressure_at_p1(folder, *sets):
    """Times, s, and the pressure at P1, Pa, of a run."""
    told = [word for one in sets for word in ("--set", one)]
    job = mpirun(2, ["-m", "psph", BOX, "--out", folder, *told], timeout=800)
    assert job.returncode == 0, job.stderr
    table = Run(folder).probes()
    return table["time"], np.nan_to_num(table["P1.pressure"])


@pytest.mark.long
@pytest.mark.timeout(1500)
def test_arrival_of_the_front_at_the_box(tmp_path):
    """Measured: 0.415 s; with 0.02 m 0.420 s, with 0.04 m, whose lowest row of water is as high as P1, 0.442 s."""
    time, pressure = pressure_at_p1(
        tmp_path / "run", "space.spacing=0.02", "time.end=0.44", "output.probes=0.001"
    )
    assert time[np.argmax(pressure > 500.0)] == pytest.approx(0.415, abs=0.02)


@pytest.fixture(name="box", scope="module")
def box_fixture(tmp_path_factory):
    """The folder of a run to 1.8 s, and the measured pressure at P1 over time."""
    folder = tmp_path_factory.mktemp("box") / "run"
    pressure_at_p1(folder)
    return folder, read_experiment(load(BOX), "kleefsman_p1")


def late_mean(folder, column):
    """The mean of a measured column behind the impact, Pa."""
    table = Run(folder).measured(column)
    late = (table["time"] > END) & (table["time"] < 1.8)
    return np.nan_to_num(table[column])[late].mean()


HIGH = pytest.mark.xfail(strict=True, reason="the probe, a mean of the fluid that there is, is 21 % high")


@pytest.mark.long
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("column", ["S1.pressure", pytest.param("P1.pressure", marks=HIGH)])
def test_plateau_of_the_pressure_on_the_box(box, column):
    """Measured: 3,190 Pa; the force over the area of the sensor, S1, is 3,560 here, the probe P1 3,850."""
    folder, (time, pressure) = box
    measured = np.interp(np.linspace(END, 1.8, 400), time, pressure).mean()
    assert late_mean(folder, column) == pytest.approx(measured, rel=0.2)


@pytest.mark.long
@pytest.mark.timeout(1500)
def test_peak_of_the_pressure_on_the_box(box):
    """The highest mean of 20 ms is 1.2 to 1.6 times the measured peak (docs/limits.md): it is bounded from below
    too, so that who mends it sees it here."""
    folder, (_, measured) = box
    table = Run(folder).probes()
    time, pressure = table["time"], np.nan_to_num(table["P1.pressure"])
    peak = max(pressure[(time >= t) & (time < t + 0.02)].mean() for t in np.arange(BEGIN, END, 0.002))
    assert 1.2 < peak / measured.max() < 2.0


@pytest.mark.long
@pytest.mark.timeout(1500)
def test_impulse_of_the_pressure_on_the_box(tmp_path):
    """On average over four starts; measured 1,359 Pa s.  Here 0.97 of it, 0.84 to 1.03; without ``wall_approach``
    1.17."""
    measured_times, measured = read_experiment(load(BOX), "kleefsman_p1")
    told = np.interp(np.linspace(BEGIN, END, 400), measured_times, measured)
    means = []
    for jitter in ((), *((f"fluids.water.jitter={size}",) for size in JITTERS)):
        sets = (*jitter, f"time.end={END}", "output.probes=0.001")
        time, pressure = pressure_at_p1(tmp_path / f"{len(means)}", *sets)
        means.append(pressure[(time >= BEGIN) & (time <= END)].mean())
    assert np.mean(means) == pytest.approx(told.mean(), rel=0.15)


@pytest.mark.long
@pytest.mark.timeout(1500)
def test_heights_of_the_water_follow_the_measured_ones(tmp_path):
    """rms of the difference over that of the signal, to 6 s: 0.24 and 0.11; bounded by 0.35."""
    job = mpirun(2, ["-m", "psph", BOX, "--out", tmp_path / "run", "--set", "time.end=6.0"], timeout=1400)
    assert job.returncode == 0, job.stderr
    run, case = Run(tmp_path / "run"), load(BOX)
    for name in ("kleefsman_h2", "kleefsman_h4"):
        column = case.experiments[name].probe
        table = run.measured(column)
        time, height = read_experiment(case, name)
        time, height = time[time < 6.0], height[time < 6.0]
        apart = np.interp(time, table["time"], table[column]) - height
        assert np.sqrt((apart**2).mean() / (height**2).mean()) < 0.35
