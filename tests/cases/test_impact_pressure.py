"""Pressures on a wall that a dam break meets, against those of Lobovsky and others (2014)."""

import numpy as np
import pytest
from cases.measures import CASES, finished

from psph.case import load
from psph.lab.study.experiment import read_experiment

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

CLOCK, RHO_G_H = 0.17487, 2943.0
"""√(H/g), s, and ρgH, Pa."""

BANDS = {"P1": (2.56, 4.46), "P2": (1.82, 2.16)}
"""Peaks over ρgH of 95 % of a hundred runs."""


def told(folder, *sets):
    """Times over √(H/g), and over ρgH the pressures of P1 and P2, and of S2, the force on the area of P2."""
    run = finished("impact_pressure", folder, *sets)
    tables = {n: run.measured(f"{n}.pressure") for n in ("P1", "P2", "S2")}
    read = {n: np.nan_to_num(table[f"{n}.pressure"]) / RHO_G_H for n, table in tables.items()}
    return tables["P2"]["time"] / CLOCK, read


def peak(time, pressure):
    """The highest mean over 7 ms from 2.3 to 3."""
    return max(pressure[np.abs(time - t) < 0.02].mean() for t in np.arange(2.3, 3.0, 0.01))


def test_arrival_and_peak_of_the_probe(tmp_path):
    """Of three starts, since single peaks scatter by a third.  Measured: the wall is met at 2.45, and P2 peaks at
    1.96.  The mean of the fluid that there is peaks at 1.4 times as much (docs/limits.md)."""
    probes = []
    for jitter in (0.01, 0.02, 0.03):
        time, pressure = told(tmp_path / f"{jitter}", f"fluids.water.jitter={jitter}")
        assert time[np.argmax(pressure["P2"] > 0.1)] == pytest.approx(2.45, abs=0.05)
        probes.append(peak(time, pressure["P2"]))
    assert 1.3 < np.mean(probes) / 1.96 < 2.5


@pytest.mark.xfail(strict=True, reason="2.4 on the mean of three starts (docs/limits.md)")
def test_the_force_on_the_sensor_peaks_within_the_band(tmp_path):
    """The control: the mean of the fluid before it, nearly twice as high."""
    peaks = []
    for jitter in (0.01, 0.02, 0.03):
        time, pressure = told(tmp_path / f"{jitter}", f"fluids.water.jitter={jitter}")
        peaks.append([peak(time, pressure[n]) for n in ("P2", "S2")])
    probe, sensor = np.mean(peaks, axis=0)
    assert BANDS["P2"][0] < sensor < BANDS["P2"][1] and sensor < 0.7 * probe


@pytest.mark.parametrize("name", ["P2", "S2"])
@pytest.mark.xfail(strict=True, reason="a quarter and a fifth too high after the impact (docs/limits.md)")
def test_what_follows_the_impact(tmp_path, name):
    """Of the probe, and the force on the same area; with mirrors 40 % too high."""
    time, pressure = told(tmp_path / "run", "fluids.water.jitter=0.01")
    late = (time > 2.8) & (time < 7.0)
    ran, measured = read_experiment(load(f"{CASES}/impact_pressure.toml"), "lobovsky_p2")
    median = np.interp(time[late], ran / CLOCK, measured / RHO_G_H).mean()
    assert pressure[name][late].mean() == pytest.approx(median, rel=0.1)


def test_mirrors_meet_the_measured_peaks(tmp_path):
    """By the median of five starts, of which one may be far off (3.3 ρgH at P2).  And are too high in what follows:
    0.96 of ρgH for 0.68 on the mean."""
    peaks, means = {name: [] for name in BANDS}, []
    for seed in range(5):
        sets = ("walls.tank.condition=mirror", "fluids.water.jitter=0.01", f"fluids.water.seed={seed}")
        time, pressure = told(tmp_path / f"run-{seed}", *sets)
        for name, found in peaks.items():
            found.append(peak(time, pressure[name]))
        means.append(pressure["P2"][(time > 2.8) & (time < 7.0)].mean())
    for name, (least, most) in BANDS.items():
        assert least < np.median(peaks[name]) < most, (name, peaks[name])
    assert 0.68 < np.median(means) < 1.1
