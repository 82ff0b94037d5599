"""A square set off in a box at Re 100 against the finite differences of SPHERIC test 6."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES, finished
from cases.square_by_differences import drag as by_differences
from cases.square_by_differences import speed
from jobs import mpirun
from long import LONG

from psph.case import load
from psph.lab.study.beside import beside
from psph.lab.study.experiment import read_experiment

CASE = Path(CASES) / "moving_square.toml"


def drag(run):
    """Times, s, and drag coefficients 2F/(ρU²L) of a run."""
    table = run.gauges()["square"]
    return table["time"], -2.0 * table["square.force_x"]


def test_a_square_that_is_set_off_feels_the_water_that_goes_with_it(tmp_path):
    """15 particles a side and half the speed of sound."""
    coarse = ("space.spacing=0.0666666666666667", "physics.sound_speed=25.0", "time.end=0.72")
    time, found = drag(finished("moving_square", tmp_path / "run", *coarse))
    told_at, force = read_experiment(load(CASE), "start")
    told = np.interp(time, told_at, -2.0 * force)
    assert found.max() == pytest.approx(told.max(), rel=0.2)
    assert time[np.argmax(found)] == pytest.approx(told_at[np.argmax(-force)], abs=0.06)
    assert np.sqrt(((found - told) ** 2).mean() / (told**2).mean()) < 0.25


def test_finite_differences_begin_with_the_water_that_goes_with_the_square():
    """Before there is friction the drag is that of an added mass of 1.33, 2.66 times the acceleration."""
    time, pressure, _ = by_differences(15, 0.3).T
    early = (time > 0.15) & (time < 0.25)
    gained = (speed(0.25) - speed(0.15)) / 0.1
    assert pressure[early].mean() / gained == pytest.approx(2.66, rel=0.05)


@LONG
@pytest.mark.timeout(900)
def test_finite_differences_carried_on_to_fine_grids_lie_above_the_reference():
    """Measured, mean from t = 1 to 3: 2.039, 2.083, 2.112 with 15, 30, 60 cells a side; the reference has 2.014.

    Carried on to first order from 15 and 30 that is 2.127, 5.6 % more than the reference; psph has 6 % more.
    """
    at = np.linspace(1.0, 3.0, 401)
    rough, fine = (
        np.interp(at, rows[:, 0], rows[:, 1:].sum(axis=1)).mean()
        for rows in (by_differences(cells, 3.05) for cells in (15, 30))
    )
    told_at, force = read_experiment(load(CASE), "drag")
    told = np.interp(at, told_at, -2.0 * force).mean()
    assert told == pytest.approx(2.014, rel=0.005)
    assert told < rough < fine
    assert (2.0 * fine - rough) / told == pytest.approx(1.056, abs=0.015)


@LONG
@pytest.mark.timeout(1800)
def test_the_drag_under_way_is_that_of_finite_differences(tmp_path):
    """30 particles a side, to t = 3: 7.5 % apart from t = 1 on, rms over that of the signal, 12 % before."""
    job = mpirun(2, ["-m", "psph", CASE, "--out", tmp_path / "run", "--set", "time.end=3.0"], timeout=1700)
    assert job.returncode == 0, job.stderr
    errors = {one.name: one.error for one in beside(tmp_path / "run")}
    assert errors["drag"] < 0.1 and errors["start"] < 0.15
