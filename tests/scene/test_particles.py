"""Particles: the same wherever they are made, in the right state."""

import numpy as np
import pytest
from drafts import TANK, WATER, draft

from psph.fields import FLUID, WALL
from psph.scene import Scene, check
from psph.scene import lattice as lattices

BLOCK = """
scheme = "sph"
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, -9.8, 0.0]
[fluids.ball]
shape.ball = { center = [0.0, 0.0, 0.0], radius = 0.5 }
jitter = 0.2
[fluids.shell]
shape.difference.from.ball = { center = [0.0, 0.0, 0.0], radius = 0.7 }
shape.difference.minus = [{ ball = { center = [0.0, 0.0, 0.0], radius = 0.5 } }]
jitter = 0.1
seed = 5
[[perturbations]]
position = [0.03, 0.03, 0.03]
velocity = [1.0, 0.0, 0.0]
"""


def scene(folder, text=WATER, *overrides):
    """The scene of a text."""
    return Scene(draft(folder, text, *overrides))


def everything(found):
    """All particles of a scene."""
    return found.particles(0, found.layout.planes, 0)


SHAKEN = TANK.replace("[fluids.water]", "[fluids.water]\njitter = 0.1")


@pytest.mark.parametrize("text", [SHAKEN, BLOCK], ids=["tank", "block"])
@pytest.mark.parametrize("cuts", [[5], [1, 2, 9]])
def test_parts_are_the_whole(tmp_path, monkeypatch, text, cuts):
    whole = everything(scene(tmp_path, text))
    monkeypatch.setattr(lattices, "SITES_AT_ONCE", 40)
    parted = scene(tmp_path, text)
    before = np.concatenate([[0], np.cumsum(parted.census.counts)])
    ends = [0, *cuts, parted.layout.planes]
    parts = [parted.particles(a, b, int(before[a])) for a, b in zip(ends, ends[1:])]
    for name, array in vars(whole).items():
        joined = np.concatenate([getattr(part, name) for part in parts])
        assert joined.dtype == array.dtype
        assert np.array_equal(joined, array), name


def test_ids_count_in_the_order_of_the_lattice(tmp_path):
    found = scene(tmp_path, TANK).particles(3, 5, 30)
    assert found.id.tolist() == list(range(30, 46))
    assert np.all(np.diff(found.position[:, 0]) >= 0)
    assert found.position[:8, 1] == pytest.approx(-0.25 + 0.1 * np.arange(8))
    assert found.kind.tolist() == ([WALL] * 3 + [FLUID] * 5) * 2
    assert found.material.tolist() == ([1] * 3 + [0] * 5) * 2


def test_no_plane_gives_no_particle(tmp_path):
    found = scene(tmp_path).particles(3, 3, 15)
    assert [len(array) for array in vars(found).values()] == [0] * 7


def test_hydrostatic_pressure_grows_below_the_surface(tmp_path):
    tank = scene(tmp_path, TANK, "physics.sound_speed=50")
    found = everything(tank)
    pressure = tank.species[0].law.pressure(found.density, 1000.0, 50.0)
    depth = np.maximum(0.5 - found.position[:, 1], 0.0)
    assert pressure == pytest.approx(1000.0 * 9.8 * depth, abs=1e-6)
    assert pressure.max() > 1000.0 * 9.8 * 0.7  # the wall below continues the law
    assert np.all(found.density[found.position[:, 1] > 0.5] == 1000.0)  # above, it is cut off
    assert found.mass == pytest.approx(np.full(len(found.mass), 10.0))


def test_hydrostatic_pressure_follows_any_gravity(tmp_path):
    tank = scene(tmp_path, TANK, "physics.sound_speed=50", "physics.gravity=[3.0, -4.0]")
    found = everything(tank)
    fluid = found.kind == FLUID
    pressure = tank.species[0].law.pressure(found.density, 1000.0, 50.0)[fluid]
    gradient = np.linalg.lstsq(
        np.column_stack([found.position[fluid], np.ones(fluid.sum())]), pressure, rcond=None
    )[0]
    assert gradient[:2] == pytest.approx([3000.0, -4000.0])
    assert pressure.min() == pytest.approx(1000.0 * 5.0 * 0.05)  # half a spacing below the surface


def test_a_uniform_pressure_holds_in_the_wall_too(tmp_path):
    overrides = ("physics.sound_speed=5", "fluids.water.pressure=-2500")
    found = everything(scene(tmp_path, TANK, *overrides))
    assert found.density == pytest.approx(np.full(len(found.density), 900.0))
    assert found.mass == pytest.approx(np.full(len(found.mass), 9.0))


def test_tait_starts_at_its_own_density(tmp_path):
    tank = scene(tmp_path, TANK, "physics.equation_of_state=tait", "physics.sound_speed=50")
    found = everything(tank)
    pressure = tank.species[0].law.pressure(found.density, 1000.0, 50.0)
    assert pressure == pytest.approx(9800.0 * np.maximum(0.5 - found.position[:, 1], 0.0), abs=1e-5)


def test_each_fluid_has_its_velocity_and_walls_are_still(tmp_path):
    found = everything(scene(tmp_path, TANK, "fluids.water.velocity=[1.0, 2.0]"))
    assert np.all(found.velocity[found.kind == FLUID] == [1.0, 2.0])
    assert np.all(found.velocity[found.kind == WALL] == 0.0)


def test_jitter_moves_the_fluid_alone_and_within_its_bounds(tmp_path):
    still = everything(scene(tmp_path, TANK))
    moved = everything(scene(tmp_path, TANK, "fluids.water.jitter=0.2"))
    shift = (moved.position - still.position) / 0.1
    fluid = still.kind == FLUID
    assert np.all(shift[~fluid] == 0.0)
    assert 0.19 < np.abs(shift[fluid]).max() <= 0.2
    assert np.abs(shift[fluid].mean(axis=0)).max() < 0.06


def test_the_seed_changes_the_shifts(tmp_path):
    one, other = (
        everything(scene(tmp_path, WATER, "fluids.water.jitter=0.2", f"fluids.water.seed={seed}"))
        for seed in (0, 1)
    )
    assert not np.array_equal(one.position, other.position)


def test_shifts_wrap_around_a_periodic_domain(tmp_path):
    text = WATER.replace(
        "spacing = 0.1", 'spacing = 0.1\nperiodic = ["x"]\nlower = [0.0, 0.0]\nupper = [1.0, 2.0]'
    )
    found = everything(scene(tmp_path, text, "fluids.water.jitter=1.0"))
    x, y = found.position.T
    assert np.all((x >= 0.0) & (x < 1.0))
    assert y.min() < 0.0  # an open axis does not wrap


def kicked(folder, position, *overrides):
    """Positions of the particles that a perturbation moves."""
    kick = f"perturbations=[{{position={list(position)}, velocity=[1.0, 0.0]}}]"
    found = everything(scene(folder, TANK, kick, *overrides))
    return found.position[found.velocity[:, 0] > 0.0].tolist()


@pytest.mark.parametrize(
    ("position", "nearest"),
    [
        ((0.36, 0.24), (0.35, 0.25)),
        ((0.05, 0.05), (0.05, 0.05)),
        ((0.3, 0.2), (0.25, 0.15)),  # four are equally near: the first of the lattice
        ((-0.2, 0.25), (0.05, 0.25)),  # not the wall
        ((50.0, -50.0), (0.95, 0.05)),
    ],
)
def test_a_kick_goes_to_the_nearest_fluid_particle(tmp_path, position, nearest):
    assert kicked(tmp_path, position) == [pytest.approx(nearest)]


def test_nearest_looks_across_a_periodic_edge(tmp_path):
    text = ("space.periodic=['x']", "space.lower=[-0.5, -1.0]", "space.upper=[1.5, 1.0]")
    assert kicked(tmp_path, (-0.49, 0.25), *text) == [pytest.approx((0.05, 0.25))]
    assert kicked(tmp_path, (1.8, 0.25), *text) == [pytest.approx((0.05, 0.25))]


def test_a_particle_is_moved_onto_another(tmp_path):
    still = everything(scene(tmp_path, WATER))
    moved = everything(scene(tmp_path, WATER, "perturbations=[{position=[0.05, 0.05], shift=[0.1, 0.0]}]"))
    [row] = np.flatnonzero((moved.position != still.position).any(axis=1))
    assert still.position[row] == pytest.approx([0.05, 0.05])
    [twin] = np.flatnonzero(np.isclose(still.position, [0.15, 0.05]).all(axis=1))
    assert moved.position[row] == pytest.approx(moved.position[twin], abs=1e-15)
    assert (moved.velocity == still.velocity).all() and moved.density[row] == still.density[row]


def test_two_kicks_to_one_particle_add_up(tmp_path):
    kick = "{position=[0.05, 0.05], velocity=[1.0, 0.5]}"
    found = everything(scene(tmp_path, WATER, f"perturbations=[{kick}, {kick}]"))
    assert found.velocity.sum(axis=0).tolist() == [2.0, 1.0]


def test_lines_of_particles_in_one_dimension(tmp_path):
    text = """
scheme = "sph"
space = { dimensions = 1, spacing = 0.5 }
time.end = 1.0
physics.sound_speed = 10.0
[fluids.gas]
shape.box = { lower = [0.0], upper = [2.0] }
density = 2.0
"""
    found = everything(scene(tmp_path, text))
    assert found.position.tolist() == [[0.25], [0.75], [1.25], [1.75]]
    assert found.mass.tolist() == [1.0] * 4


def test_a_wall_that_displaces_is_a_wall_that_was_subtracted(tmp_path):
    """Particle for particle, in a shaken fluid; a body beside it takes its place too."""
    post = "{ lower = [0.4, 0.0], upper = [0.7, 0.6] }"
    buoy = "\n[bodies.buoy]\nshape.box = { lower = [0.1, 0.3], upper = [0.3, 0.6] }\ndensity = 500.0"
    stands = SHAKEN + f"\n[walls.post]\nshape.box = {post}\n"
    box = "shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }"
    assert box in SHAKEN
    hollow = f"shape.difference = {{ from.{box.removeprefix('shape.')}, minus = [{{ box = {post} }}] }}"
    for rest in ("", buoy):
        taking = scene(tmp_path, stands + "displaces = true" + rest)
        drawn = scene(tmp_path, (stands + rest).replace(box, hollow))
        assert check(taking) == check(drawn)
        for name, array in vars(everything(drawn)).items():
            assert np.array_equal(array, getattr(everything(taking), name)), name
        assert taking.census.sizes[0] == 10 * 5 - 3 * 5 - bool(rest) * 2 * 2
