"""Elastic solids against theory: beams at rest and swinging, a plate that spins, each with what fails."""

import numpy as np
import pytest
from cases.measures import by_id, finished, window
from long import LONG, tell
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

TIP = "tip.displacement_{}"


def table_of(case, name, folder, *overrides):
    """A gauge of a run."""
    return finished(f"solids/{case}", folder, *overrides).gauges()[name]


def table(case, folder, *overrides):
    """The tip's gauge of a run."""
    return table_of(case, "tip", folder, *overrides)


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


def rings(folder, *overrides):
    """The run, and the places and velocities of the left ring and of the right one mirrored, in the same order."""
    run = finished("solids/rings", folder, *overrides)
    start, end = by_id(run.frame(0)), by_id(run.frame(-1))
    sides = []
    for group, sign in ((0, [1.0, 1.0]), (1, [-1.0, 1.0])):
        own = start["group"] == group
        order = np.lexsort(np.round(start["position"][own] * sign, 6).T)
        sides.append([end[name][own][order] * sign for name in ("position", "velocity")])
    return run, *sides


def pieces(position, reach):
    """How many clusters the particles make whose distances are below ``reach`` m."""
    near = cKDTree(position).sparse_distance_matrix(cKDTree(position), reach)
    return connected_components(near)[0]


def test_rings_bounce_and_part_in_one_piece_each(tmp_path):
    """With half of the case's particles across."""
    run, (x, v), (x_m, v_m) = rings(tmp_path, "space.spacing=0.002")
    log = run.log()
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert np.abs(energy / energy[0] - 1.0).max() < 2e-3 and log["stored_energy"].max() > 0.8 * energy[0]
    size = np.sqrt(2.0 * energy[0] * 0.002**2 * 1200.0 * 2 * len(x))
    assert max(np.abs(log[f"momentum_{axis}"]).max() for axis in "xy") < 1e-13 * size
    assert np.abs(x - x_m).max() < 0.1 * 0.002 and v[:, 0].mean() == pytest.approx(v_m[:, 0].mean(), rel=1e-9)
    assert -13.0 < v[:, 0].mean() < -10.0 and x[:, 0].max() < -0.002  # they have parted
    assert pieces(run.frame(-1)["position"], 1.7 * 0.002) == 2


def swing_of_two():
    """Sag in m, and time of contact in s, of a cylinder and a beam that swing as one (Cox 1849)."""
    young, poisson, density, length, height, radius, speed = 2.1e11, 0.3, 7850.0, 1.0, 0.04, 0.2, 2.0
    bent = 192.0 * young / (1.0 - poisson**2) * height**3 / 12.0 / length**3
    sheared = 4.0 * 5.0 / 6.0 * young / (2.0 + 2.0 * poisson) * height / length
    beam, cylinder = density * height * length, density * np.pi * radius**2
    moved = cylinder + 13.0 / 35.0 * beam
    stiff = 1.0 / (1.0 / bent + 1.0 / sheared)
    frequency, rest = np.sqrt(stiff / moved), 9.81 * cylinder / stiff
    swing = speed * cylinder / moved / frequency
    return rest + np.hypot(rest, swing), (np.pi + 2.0 * np.arctan(rest / swing)) / frequency


@LONG
def test_a_cylinder_that_falls_on_a_beam_sags_and_leaves_it_as_theory_has_it(tmp_path):
    """With half of the case's particles across; with all the sag is right to 0.5 %.  A beam half as stiff would sag
    by 1.4 times as much."""
    run = finished("solids/cylinder_on_beam", tmp_path, "space.spacing=0.01")
    sag, time = swing_of_two()
    middle, cylinder = run.gauges()["middle"], run.gauges()["cylinder"]
    pressed = cylinder["cylinder.force_y"] > 0.0
    found = -middle["middle.displacement_y"].min(), cylinder["time"][pressed].max()
    tell(f"cylinder on a beam: sag {found[0] / sag:.3f}, time {found[1] / time:.3f} of theory")
    assert found[0] == pytest.approx(sag, rel=0.04)
    assert found[1] == pytest.approx(time, rel=0.06)
    assert run.log()["stored_energy"].max() > 0.5 * 0.5 * 986.0 * 2.0**2


def test_without_contact_rings_run_through_each_other(tmp_path):
    _, (x, v), _ = rings(tmp_path, "space.spacing=0.002", "physics.contact=off")
    assert v[:, 0] == pytest.approx(13.97) and x[:, 0].min() > 0.0


def strip(folder, *overrides):
    """Energy over that at the start, and the pieces and the frame at 7 ms, of the notched strip."""
    run = finished("solids/notched_strip", folder, "time.end=0.007", *overrides)
    log = run.log()
    gained = max(np.ptp(log[f"momentum_{axis}"]) for axis in "xy")
    assert gained < 1e-13 * log["kinetic_energy"][0]
    energy = log["kinetic_energy"] + log["stored_energy"]
    return energy / energy[0], pieces(run.frame(-1)["position"], 1.5 * 0.01), run.frame(-1)


def test_a_strip_breaks_in_two_at_its_notch_and_only_loses_energy(tmp_path):
    energy, count, frame = strip(tmp_path)
    assert count == 2 and np.diff(energy).max() < 5e-3 and 0.5 < energy[-1] < 0.85
    torn = frame["damage"] > 0.05
    assert 0 < torn.sum() < 0.2 * len(torn) and np.abs(frame["position"][torn, 0]).max() < 0.1


def test_without_a_critical_stretch_the_strip_holds_and_keeps_its_energy(tmp_path):
    energy, count, frame = strip(tmp_path, "solids.strip.critical_stretch=off")
    assert count == 1 and np.abs(energy - 1.0).max() < 2e-3 and "damage" not in frame


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
def test_a_shaken_plate_swings_as_a_beam_does(tmp_path):
    """Where the clamp swings by 1 mm at half of the plate's first frequency."""
    gauge = table("shaken_plate", tmp_path)
    swing = np.ptp(window(gauge, TIP.format("y"), 1.5, 2.0)) / 0.002
    stiff = 1.9984e6 / (1.0 - 0.3975**2) * 0.02**3 / 12.0
    b = (1000.0 * 0.02 * (4.0 * np.pi) ** 2 / stiff) ** 0.25
    c, s, ch, sh = (f(0.2 * b) for f in (np.cos, np.sin, np.cosh, np.sinh))
    # w = A cos + B sin + (1 - A) cosh - B sinh, with no moment and no shear at the free end
    a, d = np.linalg.solve([[c + ch, s + sh], [s - sh, -c - ch]], [ch, -sh])
    theory = a * c + d * s + (1.0 - a) * ch - d * sh
    tell(f"shaken plate: the tip swings by {swing:.3f} mm, a thin beam's by {theory:.3f} mm")
    assert swing == pytest.approx(theory, rel=0.03)


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


@LONG
def test_water_lets_a_plate_sag_as_its_weight_says(tmp_path):
    """And stays: tests/simulation/test_immersion.py has the plate that does not."""
    gauge = table_of("water_on_plate", "middle", tmp_path)
    sag, late = (window(gauge, "middle.displacement_y", begin, 0.2) for begin in (0.05, 0.15))
    tell(f"water on a plate: {sag.mean():.3g} m, swings of {late.std():.1g} m at its end")
    assert sag.mean() == pytest.approx(-6.86e-5, rel=0.1) and late.std() < 2e-6


MEASURED = {
    "x": np.array(
        [
            (0.0024, 0.0436, 0.0835, 0.1213, 0.1616, 0.2031, 0.24, 0.2792, 0.3218, 0.361),
            (-0.29, 12.89, 33.87, 43.84, 46.02, 44.0, 42.79, 40.57, 39.74, 36.93),
        ]
    ),
    "y": np.array(
        [
            (0.0012, 0.042, 0.0828, 0.1224, 0.1633, 0.2017, 0.2437, 0.2822, 0.323, 0.3615),
            (-0.34, 0.58, 9.58, 14.87, 17.05, 16.46, 13.84, 12.74, 11.89, 10.87),
        ]
    ),
}
"""s and mm: the free end of the gate in the experiment of Antoci, Gallati & Sibilla (2007), as digitised in
data/fsi/ref_data of a fork of Project Chrono."""


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """The way of the outer corner of the gate out and up."""
    return table("gate", tmp_path_factory.mktemp("gate"))


def wide_of(gauge, axis):
    """rms of the difference from the experiment, over the rms of that."""
    time, way = MEASURED[axis]
    return np.sqrt(
        np.mean((1e3 * np.interp(time, gauge["time"], gauge[TIP.format(axis)]) - way) ** 2) / np.mean(way**2)
    )


@LONG
def test_a_gate_of_rubber_opens_as_far_as_in_the_experiment(opened):
    out, up = (1e3 * opened[TIP.format(axis)].max() for axis in "xy")
    tell(f"gate: {out:.1f} mm out, {up:.1f} mm up")
    assert out == pytest.approx(46.02, rel=0.15) and up == pytest.approx(17.05, rel=0.15)


@LONG
def test_a_gate_of_rubber_begins_to_open_as_potential_flow_and_a_beam_do(opened):
    """18.7 mm after 43.6 ms: three modes of a clamped beam of E/(1 − ν²) before water that fills a box, without
    gravity at its surface, and hardly moves; by finite differences of 1 mm.  In the experiment 12.9 mm."""
    way = 1e3 * np.interp(0.0436, opened["time"], opened[TIP.format("x")])
    tell(f"gate: {way:.1f} mm after 43.6 ms")
    assert way == pytest.approx(18.74, rel=0.05)


@LONG
@pytest.mark.xfail(reason="it is let go at once, and E 7.8 MPa is too stiff: docs/solids.md", strict=True)
@pytest.mark.parametrize("axis", "xy")
def test_a_gate_of_rubber_follows_the_experiment(axis, opened):
    tell(f"gate: rms of {axis} {100.0 * wide_of(opened, axis):.0f} % of the experiment's")
    assert wide_of(opened, axis) < 0.15


@LONG
def test_a_dam_break_bends_a_soft_plate(tmp_path):
    gauge = table("dam_break_on_plate", tmp_path, "time.end=0.32", "space.spacing=0.003")
    tip, time = 1e3 * gauge[TIP.format("x")], gauge["time"]
    tell(f"dam break on a plate: {tip.max():.1f} mm at {time[tip.argmax()]:.3f} s")
    assert tip.max() == pytest.approx(47.5, rel=0.2)
    assert 0.2 < time[tip.argmax()] < 0.3


def pierced(folder, *overrides):
    """The log, the mean speed of the ball at 16 and 24 μs, m/s, and the last frame, by id."""
    run = finished("solids/ball_through_plate", folder, "time.end=24e-6", "output.frames=8e-6", *overrides)
    speeds = [frame["velocity"][frame["group"] == 0, 0].mean() for frame in map(run.frame, (-2, -1))]
    return run.log(), speeds, by_id(run.frame(-1)), by_id(run.frame(0))


def test_a_ball_pierces_a_plate_and_flies_on(tmp_path):
    log, (before, after), end, start = pierced(tmp_path)
    tell(f"ball through a plate: {after:.0f} m/s left of 800 m/s")
    assert np.ptp(log["momentum_x"]) < 1e-13 * log["momentum_x"][0]
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert np.diff(energy).max() < 5e-3 * energy[0] and 0.6 * energy[0] < energy[-1] < energy[0]
    assert after == pytest.approx(before, rel=0.015) and 600.0 < after < 720.0
    ball, far = end["group"] == 0, np.abs(start["position"][:, 1]) > 0.01
    assert (end["damage"][far] == 0.0).all() and not end["damage"][ball].any()
    assert end["position"][ball, 0].min() > end["position"][~ball & far, 0].max()  # it is behind the plate
    hole = ~ball & (end["damage"] < 0.5) & (np.abs(end["position"][:, 0] - 0.002) < 0.004)
    assert np.abs(end["position"][hole, 1]).min() > 0.003


def test_a_plate_that_does_not_crack_holds_the_ball(tmp_path):
    log, (before, after), end, _ = pierced(tmp_path, "solids.plate.critical_stretch=off")
    ball = end["group"] == 0
    assert after < 0.9 * before and end["position"][~ball, 0].max() > end["position"][ball, 0].max()
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert np.diff(energy).max() < 1e-3 * energy[0]


def shock(folder, *overrides):
    """Speed of the shock in the resting plate, in its reference, m/s; speed and −σ_xx behind it; the log."""
    run = finished("solids/plate_impact", folder, "time.end=1.7e-6", *overrides)
    start = by_id(run.frame(0))
    x, resting = start["position"][:, 0], start["group"] == 1
    places = []
    for number, time in enumerate(run.times):
        frame = by_id(run.frame(number))
        columns = np.unique(np.round(x[resting], 7))
        speed = np.array([frame["velocity"][np.abs(x - column) < 1e-6, 0].mean() for column in columns])
        if time > 0.75e-6:
            last = np.flatnonzero(speed > 250.0)[-1]
            part = (speed[last] - 250.0) / (speed[last] - speed[last + 1])
            places.append((time, columns[last] + part * (columns[last + 1] - columns[last])))
    behind = resting & (x > 0.002) & (x < places[-1][1] - 0.001)
    return (
        np.polyfit(*np.transpose(places), 1)[0],
        frame["velocity"][behind, 0].mean(),
        -frame["stress"][behind, 0].mean(),
        run.log(),
    )


def test_a_shock_in_copper_runs_as_its_hugoniot_curve_says(tmp_path):
    speed, behind, pressure, log = shock(tmp_path)
    tell(f"shock in copper: {speed:.0f} m/s, behind it {behind:.1f} m/s and {1e-9 * pressure:.2f} GPa")
    assert speed == pytest.approx(4684.5, rel=0.01) and behind == pytest.approx(500.0, rel=0.01)
    assert pressure == pytest.approx(20.92e9 + 0.06e9, rel=0.01)  # with two thirds of the yield stress
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert np.abs(energy / energy[0] - 1.0).max() < 5e-4


def test_a_linear_pressure_lets_the_shock_run_too_slowly(tmp_path):
    off = ("solids.flyer.mie_gruneisen=off", "solids.target.mie_gruneisen=off")
    speed, _, _, log = shock(tmp_path, *off)
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert speed < 0.9 * 4684.5 and energy[-1] < 0.995 * energy[0]


def bar(folder, *overrides):
    """Length of the Taylor bar, radius of its foot, the middle of its particles, m, and its run."""
    run = finished("solids/taylor_bar", folder, *overrides)
    x = run.frame(-1)["position"]
    return x[:, 2].max() + 2e-4, np.hypot(x[:, 0], x[:, 1]).max() + 2e-4, x.mean(axis=0), run


def test_a_metal_bar_is_pressed_flat_by_a_wall_and_an_elastic_one_springs_back(tmp_path):
    coarse = ("space.spacing=0.0008", "time.end=40e-6")
    (tmp_path / "metal").mkdir()
    length, foot, middle, run = bar(tmp_path / "metal", *coarse)
    start, end = run.frame(0), run.frame(-1)
    assert length < 0.027 and foot > 0.0045 and np.abs(middle[:2]).max() < 1e-9
    assert 0.5 < end["plastic_strain"].max() < 3.0 and end["position"][:, 2].min() > 0.0
    log = run.log()
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert (np.diff(energy) < 1e-3 * energy[0]).all() and energy[-1] < 0.3 * energy[0]
    assert start["plastic_strain"].max() == 0.0
    (tmp_path / "elastic").mkdir()
    off = ("solids.bar.yield_stress=off", "solids.bar.hardening=off", "solids.bar.law=neo-hookean")
    length, _, _, run = bar(tmp_path / "elastic", *coarse, *off)
    log = run.log()
    energy = log["kinetic_energy"] + log["stored_energy"]
    assert length > 0.031 and energy[-1] > 0.97 * energy[0]


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """Length and foot of the Taylor bar at the spacing of its case, m."""
    length, foot, _, _ = bar(tmp_path_factory.mktemp("bar"))
    tell(f"Taylor bar: length {1e3 * length:.2f} mm, foot {1e3 * foot:.2f} mm")
    return length, foot


@LONG
def test_a_taylor_bar_keeps_the_length_that_codes_find(pressed):
    assert 21.3e-3 < pressed[0] < 21.7e-3


@LONG
@pytest.mark.xfail(
    reason="the elastic control of zigzags holds the foot together: docs/solids.md", strict=True
)
def test_the_foot_of_a_taylor_bar_spreads_as_codes_find(pressed):
    assert 6.9e-3 < pressed[1] < 7.3e-3
