"""Elastic solids against theory: beams at rest and swinging, a plate that spins, each with what fails."""

import numpy as np
import pytest
from cases.measures import finished, window
from long import LONG, tell

TIP = "tip.displacement_{}"


def table(case, folder, *overrides):
    """The tip's gauge of a run."""
    return finished(f"solids/{case}", folder, *overrides).gauges()["tip"]


def cycle(gauge, begin):
    """Mean, half the range and frequency (Hz) of the tip's displacement across, over whole cycles."""
    time, y = gauge["time"], gauge[TIP.format("y")]
    time, y = time[time >= begin], y[time >= begin]
    middle = 0.5 * (y.max() + y.min())
    up = np.flatnonzero((y[:-1] < middle) & (y[1:] >= middle))
    at = time[up] + (middle - y[up]) / (y[up + 1] - y[up]) * (time[up + 1] - time[up])
    return middle, 0.5 * (y.max() - y.min()), (len(at) - 1) / (at[-1] - at[0])


def test_a_spinning_plate_keeps_energy_and_angular_momentum(tmp_path):
    run = finished("solids/spinning_plate", tmp_path, "time.end=0.25")
    log = run.log()
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert log["stored_energy"].max() > 0.002 * energy[0]  # it does breathe
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-3
    assert log["kinetic_energy"].min() > 0.98 * energy[0] and log["kinetic_energy"][-1] > 0.98 * energy[0]
    x, v = run.frame(-1)["position"], run.frame(-1)["velocity"]
    x_0, v_0 = run.frame(0)["position"], run.frame(0)["velocity"]
    spin, spin_0 = ((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() for a, b in ((x, v), (x_0, v_0)))
    assert spin == pytest.approx(spin_0, rel=1e-12)
    assert np.abs(v.sum(axis=0)).max() < 1e-12 * np.abs(v).sum()


@LONG
@pytest.mark.parametrize("spacing", (0.005, 0.0025))
def test_an_oscillating_plate_has_the_period_of_a_beam_and_keeps_its_swing(spacing, tmp_path):
    """With four and with eight particles across."""
    gauge = table("oscillating_plate", tmp_path, f"space.spacing={spacing}")
    _, swing, frequency = cycle(gauge, 0.0)
    tell(f"oscillating plate, spacing {spacing} m: period {1.0 / frequency:.4f} s")
    assert 1.0 / frequency == pytest.approx(0.2565, rel=0.02)
    late = window(gauge, TIP.format("y"), 2.4, 2.7)  # the last of ten periods
    assert late.max() - late.min() > 0.9 * 2.0 * swing


@LONG
def test_weak_hourglass_control_leaves_a_thin_plate_too_soft(tmp_path):
    """The control: fits on one side only lose stiffness at the faces, which α = 1.5 makes up for."""
    gauge = table("oscillating_plate", tmp_path, "space.spacing=0.005", "solids.plate.hourglass=0.1")
    assert 1.0 / cycle(gauge, 0.0)[2] > 1.2 * 0.2565


@LONG
def test_a_cantilever_bends_as_the_elastica_does(tmp_path):
    gauge = table("cantilever", tmp_path)
    u, w = (-window(gauge, TIP.format(axis), 1.53, 2.04).mean() / 0.2 for axis in "xy")
    tell(f"cantilever, P L²/E'I = 1: w/L {w:.4f}, u/L {u:.4f}")
    assert w == pytest.approx(0.30172, rel=0.02) and u == pytest.approx(0.05643, rel=0.04)


@LONG
def test_csm1_comes_to_rest_where_finite_elements_do(tmp_path):
    gauge = table("csm1", tmp_path)
    x, y = (1e3 * window(gauge, TIP.format(axis), 1.86, 2.79).mean() for axis in "xy")
    tell(f"CSM1: {x:.3f}, {y:.2f} mm")
    assert y == pytest.approx(-66.10, rel=0.03) and x == pytest.approx(-7.187, rel=0.06)


@LONG
def test_csm3_swings_as_finite_elements_do(tmp_path):
    middle, half, frequency = cycle(table("csm3", tmp_path), 0.0)
    tell(f"CSM3: {1e3 * middle:.2f} ± {1e3 * half:.2f} mm, {frequency:.4f} Hz")
    assert 1e3 * half == pytest.approx(65.16, rel=0.03) and 1e3 * middle == pytest.approx(-63.61, rel=0.03)
    assert frequency == pytest.approx(1.0995, rel=0.02)
