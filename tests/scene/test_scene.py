"""The scene: domain, speeds, materials, counts."""

import math
from pathlib import Path

import numpy as np
import pytest
from drafts import TANK, WATER, draft

from psph.case import CaseError, load
from psph.physics.fluid.state import Linear
from psph.physics.motion import Fixed, Free
from psph.scene import Scene, Species, check
from psph.scene import lattice as lattices

CASES = Path(__file__).parents[2] / "run/cases"
PERIODIC = WATER.replace(
    "spacing = 0.1", 'spacing = 0.1\nperiodic = ["x"]\nlower = [0.0, 0.0]\nupper = [1.0, 2.0]'
)


def scene(folder, text=WATER, *overrides):
    """The scene of a text."""
    return Scene(draft(folder, text, *overrides))


def test_the_domain_is_found_from_the_shapes(tmp_path):
    tank = scene(tmp_path, TANK)
    assert tank.layout.lower == pytest.approx((-0.3, -0.3))
    assert tank.layout.upper == pytest.approx((1.3, 0.7))
    assert tank.layout.periods == (None, None)
    assert tank.layout.axis == 0
    assert tank.layout.planes == 16


def test_a_periodic_axis_has_its_length(tmp_path):
    periodic = scene(tmp_path, PERIODIC)
    assert (periodic.layout.lower, periodic.layout.upper) == ((0.0, 0.0), (1.0, 2.0))
    assert periodic.layout.periods == (1.0, None)


def test_the_slab_axis_can_be_given(tmp_path):
    assert scene(tmp_path, WATER, "parallel.axis=y").layout.axis == 1


def test_smoothing_and_kernel(tmp_path):
    found = scene(tmp_path, WATER, "space.smoothing=1.2", "space.kernel=quintic")
    assert found.smoothing_length == pytest.approx(0.12)
    assert found.kernel.support == 3.0
    assert found.kernel.w(0.35) > 0.0 == found.kernel.w(0.37)


@pytest.mark.parametrize("cut", [7, 1 << 20])
def test_counts_are_the_particles_of_each_plane(tmp_path, monkeypatch, cut):
    monkeypatch.setattr(lattices, "SITES_AT_ONCE", cut)
    counts = scene(tmp_path, TANK).census.counts
    assert counts.dtype == np.int64
    assert counts.tolist() == [10] * 3 + [8] * 10 + [10] * 3


def test_the_expected_speed_is_free_fall_over_the_height(tmp_path):
    tank = scene(tmp_path, TANK)
    assert tank.expected_speed == pytest.approx((2 * 9.8 * 0.5) ** 0.5)
    assert tank.sound_speed == pytest.approx(10 * tank.expected_speed)


def test_height_is_along_gravity(tmp_path):
    sideways = scene(tmp_path, WATER, "physics.gravity=[9.8, 0.0]")
    assert sideways.expected_speed == pytest.approx((2 * 9.8 * 1.0) ** 0.5)
    assert sideways.layout.up == pytest.approx((-1.0, 0.0))


@pytest.mark.parametrize(
    ("overrides", "speed"),
    [
        (["fluids.water.velocity=[-30.0, 40.0]"], 50.0),
        (["perturbations=[{position=[0.0, 0.0], velocity=[20.0, 0.0]}]"], 20.0),
        (
            [
                "fluids.water.velocity=[10.0, 0.0]",
                "perturbations=[{position=[0.0, 0.0], velocity=[20.0, 0.0]}]",
            ],
            30.0,
        ),
    ],
)
def test_the_expected_speed_knows_initial_speeds(tmp_path, overrides, speed):
    assert scene(tmp_path, WATER, *overrides).expected_speed == pytest.approx(speed)


BRICK = ("bodies.brick.shape.box={lower=[0.2,1.5],upper=[0.6,1.8]}", "bodies.brick.density=700.0")


@pytest.mark.parametrize(
    ("overrides", "speed"),
    [
        ((), math.sqrt(2.0 * 9.8 * 1.5)),  # its lowest face comes to the bed
        (("bodies.brick.free=['x']",), math.sqrt(2.0 * 9.8 * 0.5)),  # the water's fall alone
        (("bodies.brick.pivot=[0.4,1.5]",), math.sqrt(2.0 * 9.8 * 1.8)),
        (("bodies.brick.spin=40.0",), 40.0 * math.hypot(0.2, 0.15)),
        (("bodies.brick.spin=40.0", "bodies.brick.velocity=[3.0,4.0]"), 40.0 * math.hypot(0.2, 0.15) + 5.0),
        (("bodies.brick.free=['y']", "bodies.brick.motion={translation=[-12.0,0.0]}"), 12.0),
    ],
)
def test_the_expected_speed_knows_what_bodies_do(tmp_path, overrides, speed):
    assert scene(tmp_path, TANK, *BRICK, *overrides).expected_speed == pytest.approx(speed)


def test_a_given_sound_speed_holds(tmp_path):
    assert scene(tmp_path, WATER, "physics.sound_speed=50").sound_speed == 50.0


def test_nothing_that_moves_asks_for_the_sound_speed(tmp_path):
    still = scene(tmp_path, WATER, "physics.gravity=[0.0, 0.0]")
    with pytest.raises(CaseError, match="sound_speed: missing.*give ten times") as found:
        still.sound_speed
    assert len(found.value.lines) == 1


def test_materials_are_fluids_then_walls(tmp_path):
    text = (
        TANK
        + """
continues = "oil"
[fluids.oil]
shape.box = { lower = [0.0, 0.5], upper = [1.0, 0.6] }
density = 900.0
viscosity = 1e-4
"""
    )
    made = scene(tmp_path, text)
    sound = {"wave_speed": made.sound_speed, "sound_speed": made.sound_speed}
    assert made.species == (
        Species("water", Free(), 1000.0, 0.0, pytest.approx(10.0), Linear(), fluid=1, **sound),
        Species("oil", Free(), 900.0, 1e-4, pytest.approx(9.0), Linear(), fluid=2, **sound),
        Species("tank", Fixed(), 900.0, 1e-4, pytest.approx(9.0), Linear(), solid=1, **sound),
    )


@pytest.mark.parametrize("state", ["linear", "tait"])
def test_a_uniform_pressure_sets_the_mass(tmp_path, state):
    overrides = (f"physics.equation_of_state={state}", "physics.sound_speed=5")
    square = scene(tmp_path, WATER, "fluids.water.pressure=-2500", *overrides)
    density = square.species[0].law.density(-2500.0, 1000.0, 5.0)
    assert density < 905.0
    assert square.species[0].mass == pytest.approx(density * 0.01)


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("hydrostatic", [5000, 678]),
        ("hydrostatic_traditional", [5000, 678]),
        ("negative_pressure", [225, 216]),
        ("negative_pressure_traditional", [225, 216]),
        ("dam_break", [5000, 3072]),
        ("dam_break_3d", [10850, 24891, 144]),
        ("dam_break_on_box", [5208, 12240, 80]),
        ("impact_pressure", [7200, 2064]),
        ("minimal", [1250, 621]),
    ],
)
def test_shipped_cases_are_sound(name, sizes):
    path = CASES / f"{name}.toml"
    shipped = Scene(load(path))
    assert check(shipped) == []
    assert shipped.census.sizes.tolist() == sizes
    assert f"# Particles: {sum(sizes):,} (" in path.read_text(encoding="utf-8")
