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
def test_arrival_and_plateau_of_the_pressure_on_the_box(tmp_path):
    """Measured: 0.415 s and 2,978 Pa; here 0.434 s and 3,300 Pa.  The peak is several times too high (docs/limits.md),
    so that it is bounded from below too: who mends it shall see it here."""
    time, pressure = pressure_at_p1(tmp_path / "run")
    measured_times, measured = read_experiment(load(BOX), "kleefsman_p1")
    arrival = time[np.argmax(pressure > 500.0)]
    assert arrival == pytest.approx(0.415, abs=0.02)
    late = (time > END) & (time < 1.8)
    plateau = np.interp(np.linspace(END, 1.8, 400), measured_times, measured).mean()
    assert pressure[late].mean() == pytest.approx(plateau, rel=0.2)
    peak = max(pressure[(time >= t) & (time < t + 0.02)].mean() for t in np.arange(BEGIN, END, 0.002))
    assert 1.5 < peak / measured.max() < 4.0


@pytest.mark.long
@pytest.mark.timeout(1500)
@pytest.mark.xfail(strict=True, reason="17 % too large in steps of two passes, 11 % in one (docs/limits.md)")
def test_impulse_of_the_pressure_on_the_box(tmp_path):
    """On average over four starts; measured 1,359 Pa s."""
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
