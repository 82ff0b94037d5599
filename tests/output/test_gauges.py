"""Gauges: forces, levels and flows against what is exact."""

import math
from pathlib import Path

import numpy as np
import pytest
from drafts import TANK, WATER, draft, refusal
from gauging import readings, started
from long import LONG
from mpi4py import MPI

from psph.case import load
from psph.fields import FLUID
from psph.output.checkpoint import checkpoints
from psph.output.gauges import gauges_of
from psph.output.gauges.level import surfaces
from psph.output.gauges.points import disc
from psph.output.gauges.run_up import tongue
from psph.output.gauges.units import quantity_of, unit_of
from psph.output.reader import Run
from psph.runs.start import resume, run
from psph.scene import Scene, check
from psph.simulation.plan import make_plan

STIRRED = """
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
gather_every = {every}
[physics]
gravity = [1.0, -9.8]
sound_speed = 30.0
[fluids.heavy]
shape.box = {{ lower = [0.0, 0.0], upper = [1.0, 0.4] }}
density = 1200.0
viscosity = 0.1
velocity = [0.5, -0.4]
jitter = 0.2
[fluids.light]
shape.box = {{ lower = [0.0, 0.4], upper = [1.0, 0.8] }}
density = 900.0
viscosity = 0.01
velocity = [-0.8, 0.3]
jitter = 0.1
[walls.floor]
shape.box = {{ lower = [-0.3, -0.3], upper = [1.3, 0.0] }}
condition = "{condition}"
no_slip = true
[walls.sides]
shape.union = [
  {{ box = {{ lower = [-0.3, 0.0], upper = [0.0, 1.0] }} }},
  {{ box = {{ lower = [1.0, 0.0], upper = [1.3, 1.0] }} }},
]
condition = "{condition}"
continues = "light"
[gauges.floor.force]
on = ["floor"]
[gauges.sides.force]
on = ["sides"]
about = [0.3, 0.7]
[gauges.all.force]
on = ["floor", "sides"]
about = [0.5, 0.2]
"""
"""Two fluids in disorder between two walls."""


OF_EACH = """
[gauges.{name}_level]
level = {{ foot = [0.5, 0.0], top = [0.5, 1.2] {of} }}
[gauges.{name}_run_up]
run_up = {{ foot = [0.5, 0.0], top = [0.5, 1.2] {of} }}
[gauges.{name}_end]
highest = {{ axis = "y" {of} }}
[gauges.{name}_flow]
flow = {{ lower = [0.5, 0.0], upper = [0.5, 0.8] {of} }}
"""


def test_gauges_of_one_of_two_fluids_leave_out_the_other(tmp_path):
    asked = (("all", ""), ("heavy", ', of = "heavy"'), ("light", ', of = "light"'))
    text = STIRRED.format(every=4, condition="dynamic").replace("jitter", "#")
    text += "".join(OF_EACH.format(name=name, of=of) for name, of in asked)
    found = readings(*started(draft(tmp_path, text)))
    for name, top in (("all", 0.8), ("heavy", 0.4), ("light", 0.8)):
        assert found[f"{name}_level.level"] == pytest.approx(top, abs=0.02)
        assert found[f"{name}_end.front"] == pytest.approx(top - 0.05)
    assert found["light_level.wetted"] == pytest.approx(0.4, abs=0.02)
    assert found["heavy_run_up.run_up"] == pytest.approx(0.4) and found["light_run_up.run_up"] == 0.0
    parts = {"heavy": 0.5 * 0.4, "light": -0.8 * 0.4}
    for name, flow in parts.items():  # the sum of the kernel over the rows misses 1 by 7e-3
        assert found[f"{name}_flow.flow"] == pytest.approx(flow, rel=0.01)
    both = found["heavy_flow.flow"] + found["light_flow.flow"]
    assert found["all_flow.flow"] == pytest.approx(both, rel=1e-12)


def test_a_fluid_that_is_not_there_has_no_level(tmp_path):
    text = STIRRED.format(every=4, condition="dynamic") + OF_EACH.format(name="x", of=', of = "hevy"')
    lines = refusal(tmp_path, text)
    assert len(lines) == 4 and all("did you mean 'heavy'?" in line for line in lines)


@pytest.mark.parametrize("condition", ["dynamic", pytest.param("extrapolated", marks=LONG)])
@pytest.mark.parametrize("every", [4, pytest.param(1, marks=LONG)])
def test_force_on_walls_is_what_the_fluid_feels_of_them_turned_round(tmp_path, condition, every):
    case = draft(tmp_path, STIRRED.format(condition=condition, every=every))
    simulation, scene = started(case, 10)
    read, store = readings(simulation, scene), simulation.store
    fluid = store.shown("kind") == FLUID
    mass = store.shown("mass")[fluid, None]
    # The fluids' pushes on each other cancel in the sum; gravity is not of the walls.
    push = (mass * (store.shown("acceleration")[fluid] - np.array(scene.gravity))).sum(axis=0)
    total = np.array([read["all.force_x"], read["all.force_y"]])
    parts = np.array([[read[f"{of}.force_{axis}"] for axis in "xy"] for of in ("floor", "sides")])
    size = np.abs(mass * store.shown("acceleration")[fluid]).sum()
    assert np.abs(parts).min() > 1e-3 * size  # each wall bears something along each axis
    assert np.abs(total + push).max() < 1e-13 * size
    assert np.abs(parts.sum(axis=0) - total).max() < 1e-13 * size


def test_moments_are_about_the_point_of_the_gauge(tmp_path):
    """On all walls, since parts share what acts where they meet (test_corners.py)."""
    at_zero = 'gauges.zero.force={on=["sides"]}'
    case = draft(tmp_path, STIRRED.format(condition="dynamic", every=1), at_zero)
    simulation, scene = started(case, 3)
    read, store = readings(simulation, scene), simulation.store
    held = store.shown("group") >= 2
    force = store.shown("mass")[held, None] * store.shown("load")[held]
    x, y = (store.shown("position")[held] - np.array([0.5, 0.2])).T
    couples = store.shown("mass")[held] * store.shown("couple")[held, 0]  # the fluids are viscous
    whole = float((x * force[:, 1] - y * force[:, 0] + couples).sum())
    assert read["all.moment_z"] == pytest.approx(whole, rel=1e-9) and abs(couples.sum()) > 1e-6 * abs(whole)
    about = read["zero.moment_z"] - 0.3 * read["sides.force_y"] + 0.7 * read["sides.force_x"]
    assert read["sides.moment_z"] == pytest.approx(about, rel=1e-9)
    assert read["sides.moment_z"] != pytest.approx(read["zero.moment_z"], rel=1e-3)


AT_REST = (
    TANK
    + """
[gauges.bottom.force]
on = ["tank"]
[gauges.middle.level]
foot = [0.43, 0.0]
top = [0.43, 0.7]
[gauges.slanted.level]
foot = [0.2, 0.0]
top = [0.8, 0.6]
[gauges.dry.level]
foot = [0.5, 0.6]
top = [0.5, 0.7]
[gauges.top.highest]
axis = "y"
[gauges.inside.point]
position = [0.5, 0.25]
[gauges.round.sensor]
position = [1.0, 0.25]
axis = "x"
diameter = 0.2
"""
)


def test_still_water_rests_on_its_tank(tmp_path):
    simulation, scene = started(draft(tmp_path, AT_REST))
    read = readings(simulation, scene)
    weight = 1000.0 * 9.8 * 0.5 * 1.0
    assert read["bottom.force_y"] == pytest.approx(-weight, rel=0.08)  # its top row has no pressure yet
    assert abs(read["bottom.force_x"]) < 1e-9 * weight
    assert read["middle.level"] == pytest.approx(0.5, abs=0.005)
    assert read["middle.wetted"] == pytest.approx(0.5, abs=0.02)
    assert read["slanted.level"] == pytest.approx(0.5 * math.sqrt(2.0), abs=0.01)
    assert read["dry.level"] == read["dry.wetted"] == 0.0
    assert read["top.front"] == pytest.approx(0.45)
    assert read["inside.pressure"] == pytest.approx(2450.0, rel=0.02)
    assert read["inside.velocity_x"] == 0.0
    assert read["round.pressure"] == pytest.approx(2450.0, rel=0.02)


LINES = {
    "corner": ((0.0, 0.0), (0.0, 0.7), 0.5),
    "middle": ((0.05, 0.0), (0.05, 0.7), 0.5),
    "near": ((0.1, 0.0), (0.1, 0.7), 0.5),
    "below": ((0.53, -0.2), (0.53, 0.7), 0.7),
    "floor": ((0.2, 0.0), (0.8, 0.0), 0.6),
    "within": ((-0.15, 0.0), (-0.15, 0.6), 0.0),
}
"""Foot, top and level of lines on walls, between them and from within them."""


def test_level_on_walls_is_that_before_them(tmp_path):
    """Where walls take up the half of the kernel and more."""
    lines = [
        f"gauges.{name}.level={{foot={list(foot)}, top={list(top)}}}"
        for name, (foot, top, _) in LINES.items()
    ]
    read = readings(*started(draft(tmp_path, TANK, *lines)))
    for name, (foot, _, level) in LINES.items():
        assert read[f"{name}.level"] == pytest.approx(level, abs=0.01), name
        dry = -min(foot[1], 0.0)
        assert read[f"{name}.wetted"] == pytest.approx(level - dry, abs=0.01), name


BEACH = (
    TANK.replace("shape.box", "shape.difference.from.box")
    + """
[walls.slope.shape.polygon]
points = [[0.2, 0.0], [1.0, 0.8], [1.0, 0.0]]
[gauges.slope.run_up]
foot = [0.2, 0.0]
top = [0.9, 0.7]
[gauges.above.run_up]
foot = [0.8, 0.6]
top = [0.9, 0.7]
"""
)


def test_run_up_ends_where_the_water_meets_the_slope(tmp_path):
    cut = "fluids.water.shape.difference.minus=[{polygon={points=[[0.2, 0.0], [1.0, 0.8], [1.0, 0.0]]}}]"
    read = readings(*started(draft(tmp_path, BEACH, cut)))
    assert read["slope.height"] == pytest.approx(0.5, abs=0.5 * 0.1)  # the spacing is 0.1
    assert read["slope.run_up"] == pytest.approx(read["slope.height"] * math.sqrt(2.0))
    assert read["above.run_up"] == read["above.height"] == 0.0


@pytest.mark.parametrize("angle", [0, 10, 20, 30, 45])
def test_run_up_of_a_drawn_tongue_is_its_length(tmp_path, angle):
    """A tongue of five spacings that ends across the slope: exact along the lattice."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))

    def at(*places):
        return str([[a * c - b * s, a * s + b * c] for a, b in places])

    text = (
        "space = { dimensions = 2, spacing = 0.02 }\ntime.end = 0.1\nphysics.sound_speed = 20.0\n"
        "physics.gravity = [0.0, -9.8]\n"
        f"fluids.water.shape.polygon.points = {at((0, 0), (0.6, 0), (0.6, 0.1), (0, 0.1))}\n"
        f"walls.slope.shape.polygon.points = {at((-0.2, -0.1), (1.2, -0.1), (1.2, 0), (-0.2, 0))}\n"
        f"gauges.tip.run_up = {{ foot = {at((0, 0))[1:-1]}, top = {at((1, 0))[1:-1]} }}\n"
    )
    found = readings(*started(draft(tmp_path, text)))
    assert found["tip.run_up"] == pytest.approx(0.6, abs=0.6 * 0.02 if angle else 1e-9)
    assert found["tip.height"] == pytest.approx(found["tip.run_up"] * s)


def test_spray_is_no_run_up():
    nothing = -np.inf
    assert tongue(np.array([nothing, 0.1, nothing, 0.25, nothing, 0.45]), 0.2) == 0.45
    assert tongue(np.array([-0.02, 0.1, nothing, 0.25, nothing, nothing, 0.46]), 0.2) == 0.25
    assert tongue(np.array([nothing, nothing, 0.21]), 0.2) == nothing


GOING_ROUND = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0, 0], upper = [2, 1] }
time.end = 0.5
output = { frames = 0.5, log = 0.5 }
checkpoint.every = 40
[solids.block]
shape.box = { lower = [0.2, 0.2], upper = [0.8, 0.6] }
density = 1000.0
young = 1e5
poisson = 0.3
velocity = [9.0, 0.0]
[gauges.middle]
displacement = { of = "block", at = [0.5, 0.4] }
every = 0.05
"""


def test_displacement_counts_the_periods_also_after_a_restart(tmp_path):
    case, folder = draft(tmp_path, GOING_ROUND), tmp_path / "run"
    quiet = {"say": lambda *_: None}
    run(case, folder, MPI.COMM_SELF, **quiet)
    table = Run(folder).gauges()["middle"]
    assert table["middle.displacement_x"] == pytest.approx(9.0 * table["time"], abs=1e-9)
    assert table["time"][-1] == 0.5
    checkpoints(folder)[0].unlink()
    resume(folder, MPI.COMM_SELF, **quiet)
    again = Run(folder).gauges()["middle"]
    assert np.array_equal(again["middle.displacement_x"], table["middle.displacement_x"])


def test_level_counts_drops_and_wetted_length_does_not_the_air_below_them():
    share = np.array([0.9, 0.9, 0.3, 0.1, 0.7, 0.2, 0.0])
    level, wetted = surfaces(share, 0.1)
    assert level == pytest.approx(0.4 + 0.1 * 0.2 / 0.5)
    assert wetted == pytest.approx(0.1 + 0.1 * 0.4 / 0.6 + 0.1 * 0.2 / 0.6 + 0.1 * 0.2 / 0.5)
    assert surfaces(np.ones(3), 0.1) == pytest.approx((0.2, 0.2))
    assert surfaces(np.zeros(3), 0.1) == (0.0, 0.0)


def test_level_beside_a_plane_of_symmetry_is_that_of_the_whole(tmp_path):
    line = "gauges.wall.level={foot=[0.0, 0.0], top=[0.0, 0.7]}"
    half = ("space.symmetry=['x.lower']", "space.lower=[0.0, -0.3]", "space.upper=[1.3, 0.7]")
    whole = readings(*started(draft(tmp_path, AT_REST, "gauges.wall.level={foot=[0.5,0.0], top=[0.5,0.7]}")))
    mirrored = readings(*started(draft(tmp_path, AT_REST, line, *half)))
    assert mirrored["wall.level"] == pytest.approx(whole["wall.level"], rel=1e-9)


STREAM = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, 0.0], upper = [3.0, 1.0] }
time.end = 1.0
physics.sound_speed = 30.0
[fluids.upper]
shape.box = { lower = [0.0, 0.5], upper = [3.0, 1.0] }
velocity = [2.0, 0.0]
density = 800.0
[fluids.lower]
shape.box = { lower = [0.0, 0.0], upper = [3.0, 0.5] }
velocity = [-0.5, 0.0]
density = 1000.0
[gauges.all.flow]
lower = [0.03, 0.0]
upper = [0.03, 1.0]
[gauges.part.flow]
lower = [2.21, 0.5]
upper = [2.21, 0.8]
[gauges.along.flow]
lower = [1.0, 0.5]
upper = [2.0, 0.5]
"""


def test_flow_through_a_section_is_speed_times_area(tmp_path):
    read = readings(*started(draft(tmp_path, STREAM)))
    assert read["all.flow"] == pytest.approx(2.0 * 0.5 - 0.5 * 0.5, rel=0.01)
    assert read["all.mass_flow"] == pytest.approx(800.0 - 250.0, rel=0.01)
    assert read["part.flow"] == pytest.approx(0.6, rel=0.01)
    assert read["along.flow"] == 0.0


def test_flow_through_a_section_across_a_seam_counts_both_sides_of_it(tmp_path):
    """Only what is before the seam counted: half of it."""
    keys = [f"fluids.{name}.velocity=[0.0,0.4]" for name in ("upper", "lower")]
    keys += ["gauges.along.flow.lower=[2.5,0.5]", "gauges.along.flow.upper=[3.5,0.5]"]
    read = readings(*started(draft(tmp_path, STREAM, *keys)))
    assert read["along.flow"] == pytest.approx(0.4 * 1.0, rel=0.01)


def test_a_disc_has_points_a_spacing_apart_at_most():
    assert disc((1.0, 2.0), 0, 0.1, 0.1).tolist() == [[1.0, 2.0]]
    assert disc((1.0, 2.0), 0, 0.2, 0.1) == pytest.approx(np.array([[1.0, 1.95], [1.0, 2.05]]))
    plate = disc((1.0, 2.0, 3.0), 1, 1.0, 0.05)
    assert np.all(plate[:, 1] == 2.0) and plate.mean(axis=0) == pytest.approx([1.0, 2.0, 3.0])
    assert len(plate) * (1.0 / 20) ** 2 == pytest.approx(math.pi / 4.0, rel=0.05)


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("gauges.a.force.on=['side']", "no wall or body has this name; "),
        ("gauges.a.level={foot=[0.0,0.0],top=[0.0,0.0]}", "gauges.a.level: has no length; "),
        ("gauges.a.flow={lower=[0.0,0.0],upper=[1.0,1.0]}", "gauges.a.flow: is no section across an axis; "),
        ("gauges.a.every=0.1", "gauges.a: does not say what it measures; give one of force, level, "),
        ("gauges.a={highest={axis='x'},point={position=[0.0,0.0]}}", "gauges.a: highest and point in one"),
        ("gauges.a.highest.axis='z'", "no axis in 2D; give one of x, y"),
        ("gauges.a={highest={axis='x'},every=1e-12}", "gauges.a.every: 1e-12: gives more than 1e+09 outputs"),
        ("gauges.a.sensor={position=[0.0,0.0],axis='x',diameter=0.0}", "gauges.a.sensor.diameter"),
    ],
)
def test_gauges_that_can_measure_nothing_are_refused(tmp_path, override, says):
    [line] = refusal(tmp_path, TANK, override)
    assert says in line


@pytest.mark.parametrize("gradient", ["minimum", "difference", "tensile_control"])
def test_no_force_where_pairs_do_not_push_back(tmp_path, gradient):
    force = "gauges.a.force.on=['tank']"
    [line] = refusal(tmp_path, TANK, force, f"physics.pressure_gradient={gradient}")
    assert "gauges.a.force: " in line and f"physics.pressure_gradient = {gradient}" in line


@pytest.mark.parametrize("condition", ["repulsive", "penalty"])
def test_no_force_on_walls_that_bear_none(tmp_path, condition):
    [line] = refusal(tmp_path, TANK, "gauges.a.force.on=['tank']", f"walls.tank.condition={condition}")
    assert f'a wall with condition = "{condition}" bears no force; take "dynamic" or "extrapolated"' in line


def test_scenes_without_forces_sum_no_loads(tmp_path):
    plain, asked = (make_plan(Scene(draft(tmp_path, text))) for text in (TANK, AT_REST))
    assert plain.materials.loaded is None and "load" not in plain.arrays
    assert asked.materials.loaded.tolist() == [False, True] and set(asked.arrays) - set(plain.arrays) == {
        "load"
    }
    level = draft(tmp_path, WATER, "gauges.top.highest.axis='y'")
    assert make_plan(Scene(level)).arrays == make_plan(Scene(draft(tmp_path))).arrays


def test_check_warns_of_a_level_that_is_measured_downwards(tmp_path):
    line = "gauges.rod.level={{foot=[0.5,{}],top=[0.5,{}]}}"
    [told] = [text for text in check(Scene(draft(tmp_path, TANK, line.format(0.6, 0.0)))) if "rod" in text]
    assert "gauges.rod.level: its foot [0.5, 0.6] is above its top [0.5, 0]" in told
    upright, level = line.format(0.0, 0.6), "gauges.front.level={foot=[0.0,0.2],top=[1.0,0.2]}"
    assert not [text for text in check(Scene(draft(tmp_path, TANK, upright, level))) if "gauges" in text]


def test_every_column_of_a_shipped_case_has_a_unit():
    counted = 0
    for path in (Path(__file__).parents[2] / "run" / "cases").rglob("*.toml"):
        case = load(path)
        scene = Scene(case) if case.gauges else None
        for gauge in gauges_of(scene).values() if scene else ():
            for column in gauge.columns(scene):
                assert unit_of(quantity_of(column)[0], scene.dimensions), (path, column)
                counted += 1
    assert counted > 200
