"""Soils against what the theory of plasticity and mechanics say of them, and the controls."""

import math

import numpy as np
import pytest
from cases.cone_by_characteristics import bearing
from cases.measures import by_id, finished, roughness, window
from long import LONG, tell
from numpy.polynomial import polynomial

from psph.case import soils
from psph.physics.stress.invariants import j2
from psph.physics.stress.strength import NO_STRESS, MohrCoulomb
from psph.vectors import scale

pytestmark = pytest.mark.timeout(900)

G, MU = 9.81, math.sin(math.radians(30.0))
"""Gravity, and what sand of 30° without dilatancy bears on a plane of slip over its pressure."""


def sliding(tmp_path, angle, *sets):
    """How fast a layer on a slope of this angle gains speed after its first quarter, m/s²; and its last speed."""
    theta = math.radians(angle)
    pull = f"physics.gravity=[{G * math.sin(theta)!r}, {-G * math.cos(theta)!r}]"
    run = finished(
        "soils/infinite_slope", tmp_path / f"{angle}", pull, "output.log=0.005", "time.end=0.3", *sets
    )
    log = run.log()
    time, momentum = log["time"], log["momentum_x"]
    speed = momentum / (1800.0 * 0.1 * 0.08)
    late = time > 0.25 * time[-1]
    return polynomial.polyfit(time[late], speed[late], 1)[1], speed[-1]


def test_a_layer_of_sand_rests_on_a_slope_below_its_friction_and_slides_above_it(tmp_path):
    gain, speed = sliding(tmp_path, 24.0)
    assert abs(gain) < 0.003 * G and abs(speed) < 0.02
    theta = math.radians(35.0)
    gain, _ = sliding(tmp_path, 35.0)
    assert gain == pytest.approx(G * (math.sin(theta) - MU * math.cos(theta)), rel=0.03)


def sand(run, field, frame=-1):
    """A field of the soil in a frame."""
    found = run.frame(frame)
    return found[field][found["kind"] == 0]


@pytest.fixture(scope="module", params=(0.005, 0.0025))
def column(request, tmp_path_factory):
    """The spacing of a column of sand that has fallen, m, and its finished run."""
    keys = (f"space.spacing={request.param}", "output.frames=0.1")
    return request.param, finished("soils/column_collapse", tmp_path_factory.mktemp("column"), *keys)


def front_of(run):
    """Where 98 % of the sand end, m."""
    return np.quantile(sand(run, "position")[:, 0], 0.98)


@LONG
def test_a_column_runs_out_as_in_experiments_whatever_the_spacing(column):
    """Measured: 1.25 and 1.10 times its height."""
    _, run = column
    assert (front_of(run) - 0.1) / 0.1 == pytest.approx(1.2, rel=0.15)
    assert sand(run, "position")[:, 1].max() > 0.085  # the top by the wall stays


@LONG
def test_the_heap_of_a_column_rests(column):
    """Single particles before the front find no friction and glide on."""
    _, run = column
    behind = sand(run, "position")[:, 0] < front_of(run)
    assert np.sqrt((sand(run, "velocity")[behind] ** 2).sum(axis=1).mean()) < 0.005


@pytest.fixture(scope="module")
def round_column(tmp_path_factory):
    """The finished run of sand that was a round column, 0.1 m wide and high."""
    return finished("soils/round_column", tmp_path_factory.mktemp("round"), "output.frames=0.1")


@LONG
@pytest.mark.xfail(strict=True, reason="0.96, a quarter too near: docs/soils.md")
def test_a_round_column_runs_out_as_in_experiments(round_column):
    """1.24 times its height, Lube and others (2004): 98 % of the sand."""
    x = sand(round_column, "position")
    out = (np.quantile(np.hypot(x[:, 0], x[:, 1]), 0.98) - 0.1) / 0.1
    tell(f"round column: run-out {out:.2f}")
    assert out == pytest.approx(1.24, rel=0.15)


@LONG
def test_the_heap_of_a_round_column_rests(round_column):
    """The heap, thicker than half a row, stops at 0.9 times its height, too near: docs/soils.md."""
    x, v = sand(round_column, "position"), sand(round_column, "velocity")
    radius = np.hypot(x[:, 0], x[:, 1])
    rings = np.arange(0.0, 0.4, 0.01)
    thick = np.histogram(radius, [*rings, 0.4])[0] * 0.01**3 / (np.pi * ((rings + 0.01) ** 2 - rings**2))
    foot = rings[thick > 0.005].max() + 0.01
    tell(f"round column: run-out of the heap {foot / 0.1 - 1.0:.2f}, top {x[:, 2].max():.3f} m")
    assert 0.75 < foot / 0.1 - 1.0 < 1.24
    assert np.sqrt((v[radius < np.quantile(radius, 0.8)] ** 2).sum(axis=1).mean()) < 0.02
    assert np.abs(x[:, :2].mean(axis=0)).max() < 1e-3  # round still
    around = radius[np.abs(np.arctan2(x[:, 1], x[:, 0]) % (np.pi / 4.0) - np.pi / 8.0) < np.pi / 16.0]
    assert np.quantile(around, 0.98) == pytest.approx(np.quantile(radius, 0.98), rel=0.05)


@LONG
def test_a_slope_stands_below_its_factor_of_safety_and_slides_above_it(tmp_path):
    """1.4 by finite elements (Griffiths & Lane 1999)."""
    moved = {}
    for factor in (1.3, 1.6):
        reduced = f"soils.bank.strength_reduction={factor}"
        run = finished("soils/slope", tmp_path / f"{factor}", reduced, "output.frames=0.5")
        moved[factor] = np.linalg.norm(
            by_id(run.frame(-1))["position"] - by_id(run.frame(0))["position"], axis=1
        ).max()
    assert moved[1.3] < 0.06 < 0.2 < moved[1.6]


@LONG
def test_a_cut_stands_at_four_fifths_of_its_height_and_slides_at_six_fifths(tmp_path):
    strain = {}
    for part, cohesion in ((0.8, 3939.0), (1.2, 2626.0)):  # 4c/γ tan(45° + φ/2) over the height
        sets = (f"soils.bank.cohesion={cohesion}", "output.frames=0.5")
        run = finished("soils/vertical_cut", tmp_path / f"{part}", *sets)
        strain[part] = [sand(run, "plastic_strain", frame).max() for frame in (1, -1)]
    grown = {part: late - early for part, (early, late) in strain.items()}
    assert strain[0.8][1] < 0.04 and grown[0.8] < 0.05 * grown[1.2]  # it stands, but for creep at its foot
    assert strain[1.2][1] > max(0.3, 1.2 * strain[1.2][0])


@LONG
def test_a_blade_meets_the_passive_force_and_then_more(tmp_path):
    run = finished("soils/blade", tmp_path, "output.frames=0.5")
    push = run.gauges()["push"]
    early = (push["time"] > 0.1) & (push["time"] < 0.2)
    rankine = 0.5 * 1800.0 * G * 0.1**2 * (1.0 + MU) / (1.0 - MU)
    assert -push["push.force_x"][early].mean() == pytest.approx(rankine, rel=0.15)
    assert -push["push.force_x"][push["time"] > 0.9].mean() > 1.5 * rankine


@LONG
def test_a_bucket_bears_what_it_has_dug(tmp_path):
    """At rest the force on it is the weight of the sand that lies in it, 136 of 1,042 grains."""
    run = finished("soils/bucket", tmp_path, "output.frames=0.5")
    held = (sand(run, "position")[:, 1] > 0.25).sum() * 1800.0 * 0.01**2 * G
    down = window(run.gauges()["bucket"], "bucket.force_y", 2.3, 3.0)
    assert held > 100.0 and -down.mean() == pytest.approx(held, rel=0.01)


@LONG
def test_clay_bears_a_punch_as_prandtl_has_it(tmp_path):
    """(2 + π) c: 7 % too little with ten spacings half a width, and no more as it goes deeper."""
    push = finished("soils/punch", tmp_path).gauges()["push"]
    time, borne = push["time"], push["push.force_y"] / (1e4 * 0.2 * (2.0 + math.pi))
    tell(f"punch in clay over (2 + π) c: {borne[time > 0.3].mean():.3f}")
    assert borne[time > 0.3].mean() == pytest.approx(1.0, abs=0.08)
    assert borne[time > 0.4].mean() == pytest.approx(borne[(time > 0.2) & (time < 0.3)].mean(), rel=0.05)


def test_characteristics_have_what_a_flat_punch_bears():
    """5.69 c of a smooth one (Shield 1955); a sharper cone bears less, a rough one more."""
    assert bearing(180.0) == pytest.approx(5.69, abs=0.01)
    assert bearing(60.0, step=0.01, fan=40) == pytest.approx(bearing(60.0), rel=1e-3)
    assert bearing(60.0) < 0.8 * bearing(180.0) < bearing(60.0, roughness=1.0)


@LONG
@pytest.mark.timeout(1800)
def test_clay_bears_a_cone_as_characteristics_have_it(tmp_path):
    """N = F/(π R² c): of a smooth cone 5 % too little, measured 4.22.  The control: along a cone with ``no_slip`` the
    clay bears more, 5.76 of 6.68, as much as by characteristics with half of c along the face."""
    borne = {}
    for name, keys in (("smooth", ()), ("rough", ("bodies.cone.no_slip=true",))):
        push = finished("soils/cone", tmp_path / name, *keys).gauges()["push"]
        borne[name] = window(push, "push.force_z", 0.25, 0.3).mean() / (1e4 * 0.25 * math.pi * 0.2**2)
        tell(f"{name} cone in clay: {borne[name]:.2f} c")
    assert borne["smooth"] == pytest.approx(bearing(60.0), rel=0.08)
    assert bearing(60.0, roughness=0.3) < borne["rough"] < bearing(60.0, roughness=1.0)


@LONG
def test_a_silo_discharges_with_the_power_five_halves_of_its_opening(tmp_path):
    """Beverloo and others (1961); and no slower as the sand in it falls."""
    width, rate = np.array([0.06, 0.08, 0.1]), []
    for one in width:
        hole = (
            f"{{ box = {{ lower = [{-one / 2}, {-one / 2}, -0.03], upper = [{one / 2}, {one / 2}, 0.0] }} }}"
        )
        inside = "{ box = { lower = [-0.12, -0.12, 0.0], upper = [0.12, 0.12, 0.3] } }"
        minus = f"walls.silo.shape.difference.minus=[{inside}, {hole}]"
        out = finished("soils/silo", tmp_path / f"{one}", minus, "time.end=0.5").gauges()["out"]
        early, late = (
            -4.0 * out["out.flow"][(out["time"] > begin) & (out["time"] < begin + 0.1)].mean()
            for begin in (0.25, 0.4)
        )
        assert late == pytest.approx(early, rel=0.03)
        rate.append(0.5 * (early + late))
    power = polynomial.polyfit(np.log(width), np.log(rate), 1)[1]
    tell(f"silo: {np.array(rate) / math.sqrt(G) / width**2.5} √g D^5/2, power {power:.2f}")
    assert power == pytest.approx(2.5, abs=0.2)


@LONG
def test_without_stress_diffusion_the_stress_of_standing_soil_is_noise(tmp_path):
    """The control: the cut that stands; between neighbours s differs by a tenth of the weight of the bank."""
    weight, rough, creep = 1835.0 * G * 1.5, {}, {}
    for diffusion in (0.1, 0.0):
        run = finished(
            "soils/vertical_cut",
            tmp_path / f"{diffusion}",
            f"soils.bank.stress_diffusion={diffusion}",
            "time.end=1.0",
        )
        rough[diffusion] = roughness(sand(run, "position"), sand(run, "deviator"), 0.1) / weight
        creep[diffusion] = np.sqrt((sand(run, "velocity") ** 2).sum(axis=1).mean())
    tell(f"cut that stands, noise of s with and without diffusion: {rough[0.1]:.4f}, {rough[0.0]:.4f} ρgH")
    tell(f"the same, speed (rms): {creep[0.1]:.4f}, {creep[0.0]:.4f} m/s")
    assert rough[0.1] < 0.01 and rough[0.0] > 0.08
    assert creep[0.1] < 0.01 < 0.02 < creep[0.0]


class Untorn(MohrCoulomb):
    """Soil without a limit of tension: beyond the tip of its cone it bears no shear, and any tension."""

    def returned(self, i, s, rho):
        """As of the law, without dilatancy and without the cut-off."""
        p = self.bulk * np.log(rho / i.rest_density)
        q = np.sqrt(j2(s, i.position))
        slip = max(q - max(self.cohesion + self.friction * p, 0.0), 0.0) / self.shear
        return scale(s, 1.0 - self.shear * slip / max(q, NO_STRESS)), rho, slip / math.sqrt(3.0)


def run_out(folder, *keys):
    """Of 98 % of the sand of the column over its height, and the lowest pressure of all frames, Pa."""
    run = finished("soils/column_collapse", folder, "space.spacing=0.005", "output.frames=0.1", *keys)
    front = np.quantile(sand(run, "position")[:, 0], 0.98)
    lowest = min(sand(run, "pressure", frame).min() for frame in range(len(run.times)))
    return (front - 0.1) / 0.1, lowest


@LONG
def test_sand_that_bears_tension_hangs_together_and_stops_short(tmp_path, monkeypatch):
    """The control of the tension cut-off: 1.2 by experiments, ± 15 %."""
    found, lowest = run_out(tmp_path / "torn")
    monkeypatch.setattr(soils, "MohrCoulomb", Untorn)
    monkeypatch.setattr(soils.Soil, "tip", property(lambda soil: 1e30))
    # Of what is pulled one particle gets through the wall (29 November 2026); the floor of densities, too, limits it.
    without, pulled = run_out(tmp_path / "untorn", "guards.on_trouble='warn'", "physics.tension_floor='off'")
    tell(f"run-out of a column with and without the tension cut-off: {found:.2f}, {without:.2f}")
    assert lowest > -1.0 and pulled < -0.05 * 1800.0 * G * 0.1
    assert without < 0.9 * found and without < 0.85 * 1.2 < found
