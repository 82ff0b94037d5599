"""Mirrors: what stands behind a plane is the image of what stands before it."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import start
from numba import njit

from psph.case import CaseError
from psph.composition.mirrors import at_look, image, images
from psph.composition.reflections import ABOVE, BELOW, Plane, mirrors_of
from psph.fields import (
    MATRIX,
    OF_EVERY_SCENE,
    OF_MATERIAL,
    SYMMETRIC,
    VECTOR,
    Field,
    StillSlope,
    StrainRate,
    Stress,
    Turned,
    VelocityGradient,
    view_of,
)
from psph.output.probes import FieldProbe
from psph.scene import Scene
from psph.scene.checks import faults
from psph.scene.walls import touches_air

FIELDS = (
    *OF_EVERY_SCENE,
    *OF_MATERIAL,
    Field("wet", "1", "read of no neighbour"),
    Field("strain", "1/s", "a rate of strain", SYMMETRIC, image=StrainRate),
    Field("gradient", "1/s", "a gradient of the velocity", MATRIX, image=VelocityGradient),
    Field("matrix", "1", "of places", MATRIX, image=Turned),
    Field("crowding", "1", "a gradient", VECTOR, image=Turned),
    Field("stress", "Pa", "a stress", SYMMETRIC, image=Stress),
    Field("density_gradient", "kg/m4", "a gradient under weight", VECTOR, image=StillSlope),
)

CROSS = """
space = { dimensions = 2, spacing = 0.05, lower = [-1.0, -1.0], upper = [1.0, 1.0] }
time.end = 1.0
physics.sound_speed = 20.0
neighbours.skin = 0.001
[fluids.water]
shape.box = { lower = [-0.5, -0.5], upper = [0.5, 0.5] }
velocity_gradient = [[1.0, 0.0], [0.0, -1.0]]
"""
"""Lists that hardly last: the wholes and their parts take them at the same steps, to rounding."""

CLAY = CROSS.replace("physics.sound_speed = 20.0\n", "").replace(
    "[fluids.water]",
    "[soils.clay]\nyoung = 1e5\npoisson = 0.3\nfriction_angle = 10.0\ncohesion = 500.0\ndensity = 1000.0",
)

QUARTER = ("space.lower=[0.0, 0.0]", 'space.symmetry=["x.lower", "y.lower"]')

TANK = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.gravity = [0.0, -9.8]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
pressure = "hydrostatic"
viscosity = 1e-3
[walls.tank]
condition = "mirror"
shape.difference.from.box = { lower = [-0.15, -0.15], upper = [1.15, 0.6] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.6] } }]
"""


def simulated(case, steps):
    """The simulation of a case after so many steps."""
    simulation = start(case)
    for _ in range(steps):
        simulation.step()
    return simulation


def sorted_state(simulation, quarter=False):
    """Position, velocity and pressure, a row a particle, from the lowest x and y on."""
    store = simulation.store
    rows = np.column_stack([store.shown(name) for name in ("position", "velocity", "pressure")])
    rows = rows[(rows[:, :2] > 0.0).all(axis=1)] if quarter else rows
    return rows[np.lexsort(rows[:, :2].round(6).T)]


@pytest.mark.parametrize("pull", [(0.0, -9.8), (2.0, -9.8), (3.0, 0.0)])
def test_a_still_column_goes_on_behind_a_mirror_with_the_slope_of_its_density(pull):
    """The image of ρ₀g/c² is ρ₀g/c² again, and compiled it is what it is in plain Python."""
    i = view_of(("rest_density", "sound_speed"))(900.0, 15.0)
    still = tuple(900.0 / 15.0**2 * g for g in pull)
    j = view_of(("position", "density_gradient"))((0.3, 0.1), still)
    for reflection in mirrors_of((Plane(0, BELOW, 0.2), Plane(1, BELOW, 0.0)), pull, 0.3, FIELDS).reflections:
        assert image(reflection, i, j).density_gradient == pytest.approx(still, abs=1e-12)
        other = j._replace(density_gradient=(40.0, -70.0))
        compiled = njit(lambda *seen: image(*seen))(reflection, i, other).density_gradient
        assert compiled == image(reflection, i, other).density_gradient


SIDES = (-1.0, 1.0)


def shifted(sides):
    """Perturbations that put a particle, and its images, over a plane."""
    each = (f"{{ position = [{0.025 * s}, {0.225 * t}], shift = [{-0.03 * s}, 0.0] }}" for s, t in sides)
    return f"perturbations=[{', '.join(each)}]"


@pytest.mark.parametrize("text", (CROSS, CLAY), ids=("water", "clay"))
def test_a_quarter_between_two_planes_is_a_quarter_of_the_whole(text, tmp_path):
    """The corner sees images of images; a particle that crosses a plane is followed by its image.  Clay had
    ended at the planes for its damping, and for the spreading of its stress."""
    whole = simulated(draft(tmp_path, text, shifted(product(SIDES, SIDES))), 40)
    part = simulated(draft(tmp_path, text, *QUARTER, shifted([(1.0, 1.0)])), 40)
    expected = sorted_state(whole, quarter=True)
    assert expected.shape == (100, 5)
    assert sorted_state(part) == pytest.approx(expected, abs=1e-7, rel=1e-9)


def test_without_the_planes_the_quarter_is_another_flow(tmp_path):
    """The control: at its inner edges it has a free surface."""
    whole = simulated(draft(tmp_path, CROSS), 40)
    part = simulated(draft(tmp_path, CROSS, "fluids.water.shape.box.lower=[0.0, 0.0]"), 40)
    away = sorted_state(part)[:, 2:4] - sorted_state(whole, quarter=True)[:, 2:4]
    assert np.abs(away).max() > 0.05


def test_water_rests_in_a_tank_of_mirrors(tmp_path):
    """Images bear the weight of the water between, the corners too; walls have no particles."""
    simulation = simulated(draft(tmp_path, TANK), 100)
    assert simulation.store.owned == 200 and simulation.fluid_speed < 2e-3
    simulation.settle_pressure()
    probe = FieldProbe("corner", np.zeros(2), ("pressure", "velocity", "density"))
    pressure, *velocity, density = probe.sample(simulation)
    c = simulation.plan.constants["sound_speed"]
    assert pressure == pytest.approx(4900.0, rel=0.01)
    assert density == pytest.approx(1000.0 + 4900.0 / c**2, rel=1e-4)
    assert velocity == pytest.approx([0.0, 0.0], abs=1e-15)  # the images' cancel it


def test_a_tank_of_mirrors_is_part_of_the_domain(tmp_path):
    """Water in a part of it, a probe on its far wall, and what lies behind the wall."""
    wide = TANK.replace("1.15", "2.15").replace("1.0, 0.6", "2.0, 0.6")
    near, far = (Scene(draft(tmp_path, f"{wide}[probes.wall]\nposition = [{x}, 0.1]\n")) for x in (2.0, 2.1))
    assert near.layout.lower == (0.0, 0.0) and near.layout.upper == (2.0, 0.6)
    assert not any("probes" in line for line in faults(near))
    assert any("outside the domain [0, 0] to [2, 0.6]" in line for line in faults(far))


def test_water_falls_without_the_mirrors(tmp_path):
    """The control."""
    simulation = simulated(draft(tmp_path, TANK.partition("[walls")[0]), 100)
    assert simulation.fluid_speed > 0.5


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize("sticks", (False, True))
def test_images_are_reflections(dim, sticks):
    rng, g, rho, c = np.random.default_rng(5), np.array([0.3, -9.8, 2.0][:dim]), 900.0, 15.0
    belt = tuple([0.4, 0.0, 0.7][:dim])
    planes = (Plane(0, BELOW, 0.2), Plane(1, ABOVE, 1.5, sticks, belt))
    mirrors = mirrors_of(planes, tuple(g), 0.3, FIELDS)
    assert images(mirrors) == 4 and images(None) == 1
    names = (
        "position",
        "velocity",
        "pressure",
        "specific_volume",
        "density",
        "strain",
        "gradient",
        "stress",
        "matrix",
        "mass",
        "wet",
        "density_gradient",
    )
    x, v, vector, full = (
        rng.normal(size=dim),
        rng.normal(size=dim),
        rng.normal(size=dim),
        rng.normal(size=(dim, dim)),
    )
    gradient = full.copy()  # of the velocity; what does not slip has none along a wall across it
    gradient[1, np.arange(dim) != 1] = 0.0
    symmetric = gradient + gradient.T
    upper, uphill = np.triu_indices(dim), rng.normal(size=dim) * 300.0
    j = view_of((*names, "crowding"))(
        tuple(x),
        tuple(v),
        5.0,
        1e-3,
        1000.0,
        tuple(symmetric[upper]),
        tuple(gradient.ravel()),
        tuple(symmetric[upper]),
        tuple(full.ravel()),
        2.0,
        None,
        tuple(uphill),
        tuple(vector),
    )
    i = SimpleNamespace(rest_density=rho, sound_speed=c)
    assert image(None, i, j) is j and image(at_look(mirrors, 0), i, j) == j
    found = {}
    for m in range(1, 4):
        seen = image(at_look(mirrors, 2 * m), i, j)
        assert at_look(mirrors, 2 * m - 1) == at_look(mirrors, 2 * m) == mirrors.reflections[m]
        turn = np.diag(mirrors.reflections[m].turn)
        there = np.array(seen.position)
        found[tuple(mirrors.reflections[m].turn[:2])] = there, np.array(seen.velocity)
        assert np.array(seen.crowding) == pytest.approx(turn @ vector)
        there_too = np.diag(mirrors.reflections[m].turn_velocity) @ gradient @ turn
        assert np.array(seen.strain) == pytest.approx((there_too + there_too.T)[upper])
        assert np.array(seen.gradient).reshape(dim, dim) == pytest.approx(there_too)
        slides = np.diag([*turn.diagonal()[:1], 1.0 if sticks else turn[1, 1], *[1.0] * (dim - 2)])
        assert np.array(seen.stress) == pytest.approx((slides @ symmetric @ slides)[upper])
        assert np.array(seen.matrix).reshape(dim, dim) == pytest.approx(turn @ full @ turn)
        weight = rho * g @ (there - x)
        assert seen.pressure == pytest.approx(5.0 + weight)
        assert 1.0 / seen.specific_volume == pytest.approx(1000.0 + weight / c**2)
        assert seen.density == pytest.approx(1000.0 + weight / c**2)
        assert seen.mass == 2.0 and seen.wet is None
        steeper = (np.eye(dim) - turn) @ g * rho / c**2
        assert np.array(seen.density_gradient) == pytest.approx(turn @ uphill + steeper)
    first, second = np.ones(dim), np.ones(dim)
    first[0], second[1] = -1.0, -1.0
    across = np.array([0.4, *[0.0] * (dim - 1)]), np.array([0.0, 3.0, 0.0][:dim])
    slides = first * v
    assert found[-1.0, 1.0] == (pytest.approx(first * x + across[0]), pytest.approx(slides))
    beyond = (lambda u: 2.0 * np.array(belt) - u) if sticks else (lambda u: second * u)
    assert found[1.0, -1.0] == (pytest.approx(second * x + across[1]), pytest.approx(beyond(v)))
    both = 0.5 * (beyond(slides) + first * beyond(v))  # whichever is seen in the other
    assert found[-1.0, -1.0] == (pytest.approx(first * second * x + sum(across)), pytest.approx(both))


def test_the_image_in_a_corner_of_a_lid_and_a_side_goes_as_the_fluid_does():
    """Seen in the side first it would go at v + 2U, in the lid first at v − 2U: either blows a cavity up."""
    lid, side = Plane(1, ABOVE, 1.0, True, (0.7, 0.0)), Plane(0, ABOVE, 1.0, True, (0.0, 0.0))
    j = view_of(("position", "velocity"))((0.9, 0.95), (0.3, -0.2))
    seen = image(mirrors_of((side, lid), (0.0, 0.0), 0.3, FIELDS).reflections[3], None, j)
    assert seen.position == pytest.approx((1.1, 1.05)) and seen.velocity == pytest.approx((0.3, -0.2))


SHEAR = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, -0.3], upper = [1.0, 1.3] }
time.end = 1.0
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
viscosity = 1e-3
velocity_gradient = [[0.0, 1.0], [0.0, 0.0]]
[walls.low]
shape.box = { lower = [0.0, -0.3], upper = [1.0, 0.0] }
condition = "mirror"
no_slip = true
[walls.up]
shape.box = { lower = [0.0, 1.0], upper = [1.0, 1.3] }
condition = "mirror"
no_slip = true
velocity = [1.0, 0.0]
"""


def test_a_shear_flow_between_mirrors_that_it_sticks_to_stays_as_it_is(tmp_path):
    """Its rate of strain goes on behind them: with that of a mirror without friction, of the other sign, the
    damping would take it for disorder, and it would change by 2e-2; it changes by 5e-4."""
    ran = simulated(draft(tmp_path, SHEAR), 120)
    y, u = ran.store.shown("position")[:, 1], ran.store.shown("velocity")[:, 0]
    assert 0.7 < ran.time and np.abs(u - y).max() < 1e-3


@pytest.mark.parametrize(
    ("text", "keys", "says"),
    [
        (
            SHEAR,
            ("walls.up.no_slip=false",),
            "walls.up.velocity: without no_slip a mirror drags nothing along",
        ),
        (SHEAR, ("walls.up.velocity=[0.0, 0.5]",), "0.5 m/s across its face y = 1 m: a mirror moves along"),
        (TANK, ('space.periodic=["x"]', "space.lower=[0.0, -0.1]", "space.upper=[1.0, 1.0]"), "is periodic"),
        (
            CROSS,
            (
                *QUARTER,
                'use=["stress_points.py"]',
                'physics.pressure_gradient="stress_points"',
                "scheme=sph",
            ),
            'physics.pressure_gradient: "stress_points": does not work with mirrors',
        ),
        (
            CROSS,
            (*QUARTER, "physics.central_force={ frequency = 1.0, center = [0.5, 0.0] }"),
            "physics.central_force pulls through it; put its center on the plane",
        ),
    ],
)
def test_a_mirror_that_would_show_something_else_is_refused(tmp_path, text, keys, says):
    with pytest.raises(CaseError) as refused:
        Scene(draft(tmp_path, text, *keys))
    assert any(says in line for line in refused.value.lines)


def test_mirrors_within_reach_of_each_other_are_refused(tmp_path):
    narrow = ("space.lower=[0.0, -1.0]", "space.upper=[0.1, 1.0]", "fluids.water.shape.box.upper=[0.1, 0.5]")
    sides = 'space.symmetry=["x.lower", "x.upper"]'
    assert any(
        "nearer to each other than" in line for line in faults(Scene(draft(tmp_path, CROSS, *narrow, sides)))
    )
    assert not list(faults(Scene(draft(tmp_path, CROSS, *narrow, 'space.symmetry=["x.lower"]'))))


def test_fluid_at_a_mirror_has_no_free_surface_there(tmp_path):
    box = ("fluids.water.shape.box.lower=[0.0, 0.0]", "space.lower=[0.0, 0.0]", "space.upper=[0.5, 0.5]")
    sides = 'space.symmetry=["x.lower", "x.upper", "y.lower", "y.upper"]'
    assert not touches_air(Scene(draft(tmp_path, CROSS, *box, sides)).layout)
    assert touches_air(Scene(draft(tmp_path, CROSS, *box, sides.replace(', "y.upper"', ""))).layout)


def test_lists_last_shorter_where_particles_move_across_a_mirror(tmp_path):
    """All move as one, so nothing comes nearer but the images."""
    moving = (
        "time.passes=1",
        "neighbours.skin=0.2",
        "fluids.water.velocity_gradient=off",
        "fluids.water.velocity=[-1.0, 0.0]",
        "fluids.water.shape.box.lower=[0.0, -0.5]",
        "space.lower=[0.0, -1.0]",
    )
    free = simulated(draft(tmp_path, CROSS, *moving), 25)
    held = simulated(draft(tmp_path, CROSS, *moving, 'space.symmetry=["x.lower"]'), 25)
    assert free.domain.rebuilds == 1 < held.domain.rebuilds
    assert (held.store.shown("position")[:, 0] > -0.2 * 0.14).all()


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        (('space.symmetry=["z.lower"]',), 'space.symmetry: "z.lower": no axis in 2D; give another side'),
        (
            ('space.symmetry=["x.lower"]', 'space.periodic=["x"]'),
            'space.symmetry: "x.lower": the axis x is periodic; remove one of the two',
        ),
        (
            ('space.symmetry=["y.lower"]', "physics.gravity=[0.0, -9.8]"),
            'space.symmetry: "y.lower": gravity pulls through it; a wall with condition = "mirror" bears weight',
        ),
        (
            ('space.symmetry=["x.lower"]', 'precision="mixed"'),
            'precision: "mixed": mirrors do not work in single precision; use "double"',
        ),
    ],
)
def test_a_mirror_where_none_can_be_is_refused(tmp_path, keys, says):
    assert any(says in line for line in refusal(tmp_path, CROSS, *keys))


@pytest.mark.parametrize(
    ("text", "keys", "says"),
    [
        (
            CROSS,
            ('space.symmetry=["x.lower"]', "space.lower=[-0.51, -1.0]"),
            "not between two planes of the lattice",
        ),
        (TANK, ("walls.tank.shape={ disc = { center = [0.5, 0.2], radius = 2.0 } }",), "a mirror is flat"),
        (
            TANK,
            ("walls.tank.shape={ box = { lower = [0.2, -0.1], upper = [1.0, 0.0] } }",),
            "a mirror is flat",
        ),
        (
            TANK,
            ("space.lower=[0.0, -0.5]", "space.upper=[1.0, 1.0]", 'space.symmetry=["x.lower"]'),
            "walls.tank: space.symmetry: x.lower mirrors the same side; remove one of the two",
        ),
    ],
)
def test_a_mirror_that_does_not_fit_the_scene_is_refused(tmp_path, text, keys, says):
    with pytest.raises(Exception, match="mirror") as refused:
        Scene(draft(tmp_path, text, *keys))
    assert says in str(refused.value)
