"""Sensors in the face of a wall read the force across it over their area."""

import pytest
from drafts import draft
from gauging import readings, started

from psph.output.gauges.make import gauges_of
from psph.output.gauges.points import PointGauge
from psph.output.gauges.sensor import SensorGauge
from psph.runs.record import probes_of

DX = 0.05
STILL = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics = { gravity = [0.0, -9.8], sound_speed = 40.0 }
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
shape.difference.minus = [{ box = { lower = [0.9, 0.0], upper = [1.0, 0.6] } }]
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [2.2, 1.4] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 1.4] } }]
[walls.plate]
shape.box = { lower = [0.9, 0.0], upper = [1.0, 0.6] }
"""
"""A plate of two spacings on the floor of a tank."""

PLACES = {
    "corner": ((0.0, 0.01), "x", 0.02),
    "middle": ((0.0, 0.5), "x", 0.5),
    "floor": ((0.01, 0.0), "y", 0.02),
    "plate": ((0.9, 0.3), "x", 0.05),
    "behind": ((1.0, 0.3), "x", 0.05),
    "tip": ((0.9, 0.58), "x", 0.05),
}


def table(name, position, axis, diameter):
    where = ", ".join(map(str, position))
    return f'[gauges.{name}.sensor]\nposition = [{where}]\naxis = "{axis}"\ndiameter = {diameter}\n'


def asked(places):
    return "".join(table(name, *place) for name, place in places.items())


@pytest.mark.parametrize("condition", ["dynamic", "extrapolated"])
def test_still_water_presses_as_it_is_deep_in_corners_and_on_both_sides_of_a_plate(tmp_path, condition):
    sets = [f"walls.{name}.condition={condition}" for name in ("tank", "plate")]
    simulation, scene = started(draft(tmp_path, STILL + asked(PLACES), *sets), steps=100)
    read = readings(simulation, scene)
    for name, ((_, y), *_) in PLACES.items():
        near = 0.06 if name == "tip" else 0.02  # there the depth changes by 5 % in a spacing
        assert read[f"{name}.pressure"] == pytest.approx(9800.0 * (1.0 - y), rel=near), name


def test_parts_of_a_sensor_are_not_what_they_seem(tmp_path):
    """The controls: in a corner the floor bears a part of the pressure, and rows of a plate the water behind it."""
    _, scene = started(draft(tmp_path, STILL + asked(PLACES)))
    faces = {name: gauges_of(scene)[f"gauge-{name}.csv"].faces[0] for name in PLACES}
    assert faces["corner"].area < 0.8 * DX and faces["middle"].area == pytest.approx(DX, rel=0.01)
    assert faces["middle"].shares.min() == 0.0 > faces["plate"].shares.min()


FILM = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.sound_speed = 20.0
[fluids.water]
shape.box = { lower = [-1.0, 0.9], upper = [-0.05, 1.0] }
velocity = [2.0, 0.0]
density = 900.0
[walls.wall]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 2.0] }
[gauges.wall.force]
on = ["wall"]
[probes.mean]
position = [0.0, 1.0]
extent = [0.0, 1.9]
"""
"""A film of two particles meets a wall."""


def test_a_film_counts_by_the_momentum_that_it_loses(tmp_path):
    """Its mean pressure, the control, is that of the fluid that there is: twice as much."""
    simulation, scene = started(draft(tmp_path, FILM + asked({"whole": ((0.0, 1.0), "x", 1.9)})))
    [probe] = probes_of(scene.case)
    before = momentum(simulation)
    impulse = mean = 0.0
    while simulation.time < 0.4:
        time = simulation.time
        simulation.step()
        dt = simulation.time - time
        impulse += 1.9 * dt * readings(simulation, scene)["whole.pressure"]
        mean += 1.9 * dt * probe.sample(simulation)[0]
    lost = before - momentum(simulation)
    assert lost > 150.0 and impulse == pytest.approx(lost, rel=0.05) and mean > 1.5 * lost


def momentum(simulation) -> float:
    """Along x, of the fluid, kg m/s."""
    flows = simulation.store.owned_rows("group") == 0
    return float(
        (simulation.store.owned_rows("mass") * simulation.store.owned_rows("velocity")[:, 0])[flows].sum()
    )


def test_beside_walls_whose_particles_bear_nothing_it_is_the_mean_of_the_fluid(tmp_path):
    place = asked({"one": PLACES["middle"]})
    kinds = {}
    for condition in ("dynamic", "mirror", "penalty"):
        folder = tmp_path / condition
        folder.mkdir()
        scene = started(draft(folder, STILL + place, f"walls.tank.condition={condition}"))[1]
        [gauge] = gauges_of(scene).values()
        kinds[condition] = type(gauge)
    assert kinds == {"dynamic": SensorGauge, "mirror": PointGauge, "penalty": PointGauge}


def test_across_a_wall_it_is_the_mean_of_the_fluid_too(tmp_path):
    """Along the axis a floor bears nothing but rounding, and a little of what presses a plate that is not far."""
    across = {"one": ((0.7, 0.0), "x", 0.06)}
    simulation, scene = started(draft(tmp_path, STILL + asked(across)), steps=20)
    assert [type(gauge) for gauge in gauges_of(scene).values()] == [PointGauge]
    assert readings(simulation, scene)["one.pressure"] == pytest.approx(9800.0, rel=0.02)


HALF = """
space = { dimensions = 3, spacing = 0.1, lower = [-0.3, 0.0, -0.3], upper = [1.3, 0.8, 1.2], symmetry = ["y.lower"] }
time.end = 1.0
physics = { gravity = [0.0, 0.0, -9.8], sound_speed = 40.0 }
fluids.water = { shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 0.5, 0.6] }, pressure = "hydrostatic" }
[walls.tank]
shape.difference.from.box = { lower = [-0.3, -0.3, -0.3], upper = [1.3, 0.8, 0.9] }
shape.difference.minus = [{ box = { lower = [0.0, -0.5, 0.0], upper = [1.0, 0.5, 0.9] } }]
"""


def test_half_a_sensor_behind_a_plane_of_symmetry_is_the_other_half(tmp_path):
    places = {"plane": ((0.0, 0.0, 0.3), "x", 0.1), "beside": ((0.0, 0.25, 0.3), "x", 0.1)}
    simulation, scene = started(draft(tmp_path, HALF + asked(places)), steps=5)
    read = readings(simulation, scene)
    assert read["plane.pressure"] == pytest.approx(read["beside.pressure"], rel=0.01)
    assert read["plane.pressure"] == pytest.approx(9800.0 * 0.3, rel=0.05)


ROUND = """
space = { dimensions = 2, spacing = 0.05, periodic = ["x"], lower = [0.0, -0.2], upper = [1.0, 1.5] }
time.end = 1.0
physics = { gravity = [0.0, -9.8], sound_speed = 30.0 }
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }, pressure = "hydrostatic" }
walls.floor.shape.box = { lower = [0.0, -0.2], upper = [1.0, 0.0] }
"""


def test_a_sensor_across_a_periodic_seam_or_round_a_period_has_each_particle_once(tmp_path):
    places = {
        "seam": ((0.0, 0.0), "y", 0.2),
        "middle": ((0.5, 0.0), "y", 0.2),
        "twice": ((0.3, 0.0), "y", 2.0),
    }
    simulation, scene = started(draft(tmp_path, ROUND + asked(places)), steps=5)
    read = readings(simulation, scene)
    assert read["middle.pressure"] == pytest.approx(9800.0, rel=0.02)
    for name in ("seam", "twice"):
        assert read[f"{name}.pressure"] == pytest.approx(read["middle.pressure"], rel=1e-6), name


WAYS = {
    "mirrored": lambda x, y: (-x, y),
    "upside down": lambda x, y: (x, -y),
    "turned by a quarter": lambda x, y: (-y, x),
    "with its axes exchanged": lambda x, y: (y, x),
}


def film(way):
    """The text of a film that meets a wall, as ``way`` has its points, with a sensor across its rim."""

    def box(*corners):
        lower, upper = ([*map(end, zip(*(way(*one) for one in corners)))] for end in (min, max))
        return f"shape.box = {{ lower = {lower}, upper = {upper} }}\n"

    axis = "xy"[way(1.0, 0.0)[0] == 0.0]
    return (
        "space = { dimensions = 2, spacing = 0.0625 }\ntime.end = 1.0\nphysics.sound_speed = 20.0\n"
        f"[fluids.water]\n{box((-1.0, 0.875), (-0.0625, 1.0))}"
        f"velocity = {[*way(2.0, 0.0)]}\ndensity = 900.0\n"
        f"[walls.wall]\n{box((0.0, 0.0), (0.25, 2.0))}" + table("rim", way(0.0, 1.06), axis, 0.1)
    )


@pytest.mark.parametrize("way", WAYS)
def test_a_sensor_reads_the_same_however_the_scene_is_turned(tmp_path, way):
    read = []
    for name, one in (("as it is", lambda x, y: (x, y)), (way, WAYS[way])):
        (tmp_path / name).mkdir()
        simulation, scene = started(draft(tmp_path / name, film(one)), steps=60)
        read.append(readings(simulation, scene)["rim.pressure"])
    assert read[0] > 300.0 and read[1] == pytest.approx(read[0], rel=1e-9)
