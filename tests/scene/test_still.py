"""Fluids under their own weight at the start: psph.scene.fluid.still."""

import numpy as np
import pytest
from drafts import draft

from psph.scene import Scene, check

G = 9.81
HEAD = """
space = {{ dimensions = {dim}, spacing = 0.05 }}
time.end = 0.1
physics = {{ gravity = {gravity}, sound_speed = 60.0 }}
"""
BASIN = """
[walls.basin.shape.difference]
from.box = { lower = [-0.2, -0.2], upper = [2.2, 1.4] }
minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 1.4] } }]
"""
LEVELS = """
[fluids.water]
pressure = "hydrostatic"
shape.union = [
    { box = { lower = [0.0, 0.0], upper = [0.5, 1.0] } },
    { box = { lower = [0.5, 0.0], upper = [2.0, 0.2] } },
    { disc = { center = [1.5, 0.8], radius = 0.2 } },
]
"""
SLAB = """
[fluids.water]
pressure = "hydrostatic"
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.4] }
[fluids.oil]
density = 800.0
pressure = "hydrostatic"
shape.box = { lower = [0.8, 0.4], upper = [1.2, 0.6] }
"""


def box(lower, upper):
    """The text of a box."""
    return f"{{ box = {{ lower = {list(lower)}, upper = {list(upper)} }} }}"


def within(density=800.0):
    """Water with a ball of another fluid in it."""
    hole = "{ disc = { center = [1.0, 0.5], radius = 0.2 } }"
    return (
        '[fluids.water]\npressure = "hydrostatic"\nshape.difference = { from = '
        f"{box((0.0, 0.0), (2.0, 1.0))}, minus = [{hole}] }}\n"
        f'[fluids.ball]\npressure = "hydrostatic"\ndensity = {density}\nshape = {hole}\n'
    )


class Pressures:
    """What the particles of a case start with, Pa."""

    def __init__(self, folder, text, *keys, gravity=(0.0, -G)):
        head = HEAD.format(dim=len(gravity), gravity=list(gravity))
        self.scene = Scene(draft(folder, head + text, *keys))
        self.found = self.scene.particles(0, self.scene.layout.planes, 0)
        self.p = np.zeros(len(self.found.id))
        for n, one in enumerate(self.scene.species):
            rows = self.found.material == n
            speed = self.scene.sound_speed
            self.p[rows] = one.law.pressure(self.found.density[rows], one.density, speed)

    def at(self, *x):
        """Of the particle nearest to ``x``, carried on to there by the weight of water."""
        nearest = np.argmin(((self.found.position - np.array(x)) ** 2).sum(axis=1))
        return self.p[nearest] + 1000.0 * np.dot(self.scene.gravity, x - self.found.position[nearest])


def test_each_column_bears_its_own_water_and_a_drop_in_the_air_none(tmp_path):
    """One surface for the whole fluid gave 9810 Pa on the low bed, and 3924 in the drop that falls."""
    found = Pressures(tmp_path, LEVELS + BASIN)
    assert found.at(0.275, 0.0) == pytest.approx(1000.0 * G * 1.0)
    assert found.at(1.775, 0.0) == pytest.approx(1000.0 * G * 0.2)
    assert found.at(1.525, 0.0) == pytest.approx(1000.0 * G * 0.2)  # under the drop
    assert found.at(1.775, -0.025) == pytest.approx(1000.0 * G * 0.225)  # in the wall
    drop = (found.found.material == 0) & (found.found.position[:, 1] > 0.55)
    drop &= found.found.position[:, 0] > 1.0
    assert drop.sum() > 20 and np.abs(found.p[drop]).max() < 1e-6


def test_a_slab_of_oil_loads_the_water_below_it_alone(tmp_path):
    """Any overlap counted as a load on all of the water: 5494 Pa."""
    found = Pressures(tmp_path, SLAB + BASIN)
    assert found.at(0.275, 0.0) == pytest.approx(1000.0 * G * 0.4)
    assert found.at(1.025, 0.0) == pytest.approx(G * (1000.0 * 0.4 + 800.0 * 0.2))


@pytest.mark.parametrize("density", [800.0, 1300.0])
def test_what_hangs_in_another_fluid_has_the_pressure_around_it(tmp_path, density):
    """Its own surface gave a ball in the water no pressure at its top."""
    found = Pressures(tmp_path, within(density) + BASIN)
    for x, y in ((0.275, 0.0), (1.025, 0.0), (1.025, 0.9)):
        assert found.at(x, y) == pytest.approx(1000.0 * G * (1.0 - y))
    ball = found.found.material == 1
    depth = 1.0 - found.found.position[ball][:, 1]
    assert found.p[ball] == pytest.approx(1000.0 * G * depth, rel=1e-9)


def test_a_slab_across_a_basin_is_a_layer_and_weighs_what_it_is(tmp_path):
    """What is above and below is of one fluid, and not connected: the control of the ball."""
    text = (
        '[fluids.water]\npressure = "hydrostatic"\n'
        f"shape.union = [{box((0.0, 0.0), (2.0, 0.4))}, {box((0.0, 0.6), (2.0, 1.0))}]\n"
        '[fluids.oil]\ndensity = 800.0\npressure = "hydrostatic"\n'
        f"shape = {box((0.0, 0.4), (2.0, 0.6))}\n"
    )
    found = Pressures(tmp_path, text + BASIN)
    assert found.at(1.025, 0.0) == pytest.approx(G * (1000.0 * 0.8 + 800.0 * 0.2))


def test_under_a_roof_the_level_is_that_of_the_connected_water(tmp_path):
    """A weir with a culvert below it: each side has its level, the culvert that of the nearer one, and a
    closed chamber beside it has no pressure at its own top."""
    water = (
        '[fluids.water]\npressure = "hydrostatic"\nshape.union = ['
        f"{box((0.0, 0.0), (0.8, 1.0))}, {box((1.2, 0.0), (2.0, 0.6))}, {box((0.8, 0.0), (1.2, 0.2))},"
        f"{box((2.4, 0.0), (2.8, 0.4))}]\n"
    )
    walls = (
        "[walls.basin.shape.difference]\n"
        f"from = {box((-0.2, -0.2), (3.0, 1.4))}\n"
        f"minus = [{box((0.0, 0.0), (0.8, 1.4))}, {box((1.2, 0.0), (2.0, 1.4))}, "
        f"{box((0.8, 0.0), (1.2, 0.2))}, {box((2.4, 0.0), (2.8, 0.4))}]\n"
    )
    found = Pressures(tmp_path, water + walls)
    assert found.at(0.425, 0.0) == pytest.approx(1000.0 * G * 1.0)
    assert found.at(1.625, 0.0) == pytest.approx(1000.0 * G * 0.6)
    assert found.at(0.825, 0.0) == pytest.approx(1000.0 * G * 1.0)
    assert found.at(1.175, 0.0) == pytest.approx(1000.0 * G * 0.6)
    assert found.at(2.625, 0.0) == pytest.approx(1000.0 * G * 0.4)


def test_levels_follow_gravity_along_any_axis(tmp_path):
    """To the left, in 3D too; oblique to the axes each part has one surface, its highest point."""
    left = Pressures(
        tmp_path,
        '[fluids.water]\npressure = "hydrostatic"\nshape.union = ['
        f"{box((0.0, 0.0, 0.0), (1.0, 0.5, 0.4))}, {box((0.0, 0.5, 0.0), (0.2, 1.0, 0.4))}]\n"
        f"[walls.left]\nshape = {box((-0.2, 0.0, 0.0), (0.0, 1.0, 0.4))}\n",
        gravity=(-G, 0.0, 0.0),
    )
    assert left.at(0.0, 0.275, 0.225) == pytest.approx(1000.0 * G * 1.0)
    assert left.at(0.0, 0.775, 0.225) == pytest.approx(1000.0 * G * 0.2)
    oblique = Pressures(tmp_path, LEVELS + BASIN, gravity=(3.0, -4.0))
    x = oblique.found.position[oblique.found.material == 0]
    height, falls = x @ np.array([-0.6, 0.8]), x[:, 1] > 1.3 - x[:, 0] / 2.0
    p = oblique.p[oblique.found.material == 0]
    right = 1000.0 * 5.0 * (height[~falls].max() + 0.025 - height)
    assert p == pytest.approx(np.where(falls, 0.0, right), rel=1e-9)


@pytest.mark.parametrize("slant", [0.0, 0.0171])
def test_pools_and_drops_are_parts_of_their_own_under_slanted_gravity(tmp_path, slant):
    """Turned by a tenth of a degree, a shallow pool had 9590 Pa for 3680, and a drop in the air 1720 for 0;
    what hangs in water has the pressure of the water around it."""
    walls = (
        f"[walls.basin.shape.difference]\nfrom = {box((-0.2, -0.2), (2.2, 2.4))}\n"
        f"minus = [{box((0.0, 0.0), (0.8, 2.4))}, {box((1.2, 0.0), (2.0, 2.4))}]\n"
    )
    hole, drop = (f"{{ disc = {{ center = [{x}], radius = 0.15 }} }}" for x in ("0.4, 0.5", "1.6, 1.2"))
    fluids = (
        '[fluids.water]\npressure = "hydrostatic"\nshape.difference = { from = { union = ['
        f"{box((0.0, 0.0), (0.8, 1.0))}, {box((1.2, 0.0), (2.0, 0.4))}, {drop}] }}, minus = [{hole}] }}\n"
        f'[fluids.oil]\npressure = "hydrostatic"\ndensity = 800.0\nshape = {hole}\n'
    )
    found = Pressures(tmp_path, fluids + walls, gravity=(slant, -G))
    assert found.at(0.425, 0.0) == pytest.approx(1000.0 * G * 1.0, abs=30.0)
    assert found.at(1.625, 0.0) == pytest.approx(1000.0 * G * 0.4, abs=30.0)
    assert found.at(0.425, 0.5) == pytest.approx(1000.0 * G * 0.5, abs=30.0)
    drop = found.found.material == 0
    drop &= found.found.position[:, 1] > 1.02
    assert drop.sum() > 20 and not found.p[drop].any()


BELL = f"""
[walls.basin.shape.difference]
from = {box((-0.2, -0.2), (2.2, 2.0))}
minus = [{box((0.0, 0.0), (1.0, 2.0))}, {box((1.0, 0.0), (2.0, 1.0))}]
"""


@pytest.mark.parametrize("below", [True, False])
def test_oil_that_water_closes_in_under_a_roof_has_the_pressure_of_the_water(tmp_path, below):
    """It had none at its highest point, and with it the water below: 8600 Pa at the floor for 14700.

    Closed in by water below it, and at its side alone.
    """
    text = (
        '[fluids.water]\npressure = "hydrostatic"\nshape.union = ['
        f"{box((0.0, 0.0), (1.0, 1.5))}, {box((0.0, 0.0), (2.0 if below else 1.0, 0.5))}]\n"
        '[fluids.oil]\ndensity = 800.0\npressure = "hydrostatic"\n'
        f"shape = {box((1.0, 0.5 if below else 0.0), (2.0, 1.0))}\n"
    )
    found = Pressures(tmp_path, text + BELL)
    assert found.at(0.525, 0.0) == pytest.approx(1000.0 * G * 1.5)
    if below:
        assert found.at(1.525, 0.0) == pytest.approx(1000.0 * G * 1.5)
    oil = found.found.material == 1
    y = found.found.position[oil][:, 1]
    met = 0.5 if below else 0.975  # m, where they meet: side by side all along, so at the first place
    right = 1000.0 * G * (1.5 - met) + 800.0 * G * (met - y)
    assert found.p[oil] == pytest.approx(right, rel=1e-6)


SLANTED = """
[fluids.water]
pressure = "hydrostatic"
shape.polygon.points = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.9], [0.0, 0.4]]
[fluids.oil]
density = 800.0
pressure = "hydrostatic"
shape.polygon.points = [[0.0, 0.4], [2.0, 0.9], [2.0, 1.3], [0.0, 0.8]]
"""


@pytest.mark.parametrize("frame", [False, True])
def test_slanted_layers_weigh_on_each_other_under_slanted_gravity(tmp_path, frame):
    """The steps of the lattice took the load of the oil away: 4000 Pa at the floor for 7000; in a frame that is
    accelerated heights were taken against the gravity of the case: 9100 Pa."""
    text, gravity = SLANTED + BASIN, (2.5, -10.0)
    if frame:
        text, gravity = text + "[frame]\nmotion = { acceleration = [-2.5, 0.0] }\n", (0.0, -10.0)
    found = Pressures(tmp_path, text, gravity=gravity)
    for x, y, density in ((0.025, 0.025, 1000.0), (1.975, 0.025, 1000.0), (0.975, 0.675, 800.0)):
        depth = 0.4 + 0.25 * x - y
        right = 800.0 * 10.0 * 0.4 + density * 10.0 * depth
        row = np.argmin(np.linalg.norm(found.found.position - np.array([x, y]), axis=1))
        assert found.p[row] == pytest.approx(right, abs=1000.0 * 10.0 * 0.025)  # half a spacing


def test_a_frame_that_falls_or_rises_changes_the_weight_from_the_start(tmp_path):
    water = (
        '[fluids.water]\npressure = "hydrostatic"\nshape.box = { lower = [0.0, 0.0], upper = [2.0, 0.5] }\n'
    )
    for acceleration, weight in ((29.43, 4.0), (-4.905, 0.5), (-9.81, 0.0)):
        moved = f"[frame]\nmotion = {{ acceleration = [0.0, {acceleration}] }}\n"
        found = Pressures(tmp_path, water + BASIN + moved)
        bed = found.p[(found.found.material == 0) & (found.found.position[:, 1] < 0.05)]
        assert bed == pytest.approx(1000.0 * weight * G * 0.475, abs=1e-6)


def test_a_start_without_the_pressure_of_the_weight_is_told(tmp_path):
    """Where the case says nothing: not where it asks for 0, nor of what falls."""
    silent = LEVELS.replace('pressure = "hydrostatic"', "")
    for text, keys, told in (
        (silent + BASIN, (), True),
        (silent + BASIN, ("fluids.water.pressure=0.0",), False),
        (LEVELS + BASIN, (), False),
        (silent, (), False),
    ):
        lines = check(Scene(draft(tmp_path, HEAD.format(dim=2, gravity=[0.0, -G]) + text, *keys)))
        assert any("pressures swing between 0 and 1.91e+04 Pa" in line for line in lines) == told
