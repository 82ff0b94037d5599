"""Effects that nothing in a scene can feel are named, and those that act are not."""

import pytest
from drafts import SQUARE, TANK, draft

from psph.case import load
from psph.runs.hints import hints, plan_warnings
from psph.scene import Scene
from psph.simulation.plan import make_plan


def said(folder, text, *overrides) -> list[str]:
    scene = Scene(draft(folder, text, *overrides))
    return list(hints(scene, make_plan(scene)))


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (
            ["physics.gravity=[0.0, 0.0]", "fluids.water.pressure=0.0", "physics.sound_speed=9.0"],
            "gravity: physics.gravity is zero along every axis",
        ),
        (["physics.artificial_viscosity={alpha = 0.0}"], "both of its coefficients are zero"),
        (
            ["fluids.water.viscosity=1e-6", "physics.artificial_viscosity=0.1"],
            "laminar viscosity: its 1e-06 m2/s are negligible beside the 0.",
        ),
    ],
)
def test_an_idle_effect_is_a_hint(tmp_path, overrides, says):
    [line] = said(tmp_path, TANK, *overrides)
    assert says in line


def test_a_closed_box_has_no_surface_and_a_tank_has(tmp_path):
    closed = [
        'space.periodic=["x", "y"]',
        "space.lower=[0.0, 0.0]",
        "space.upper=[1.0, 1.0]",
        "physics.free_surface=0.9",
        "physics.sound_speed=10.0",
    ]
    lines = said(tmp_path, SQUARE, *closed)
    assert any(line.startswith("free surface: the fluid has no free surface") for line in lines)
    assert not said(tmp_path, TANK, "physics.free_surface=0.9")


def test_nothing_moves_so_friction_rests(tmp_path):
    still = ["fluids.water.viscosity=1e-3", "physics.sound_speed=10.0"]
    assert any("nothing moves" in line for line in said(tmp_path, SQUARE, *still))
    moving = [*still, "fluids.water.velocity=[1.0, 0.0]"]
    assert not any("nothing moves" in line for line in said(tmp_path, SQUARE, *moving))


@pytest.mark.parametrize(("asked", "served"), [(4, 4), (8, 4)])
def test_friction_that_is_held_for_less_than_asked_for_is_a_hint(tmp_path, asked, served):
    """Damping in disorder does not bear 8 steps in 2D."""
    lines = said(tmp_path, TANK, "scheme=stable", f"time.damping_every={asked}")
    told = [line for line in lines if line.startswith("time.damping_every")]
    assert [f"friction serves for {served} here" in line for line in told] == [True] * (served < asked)


REFINED = """
space = { dimensions = 2, spacing = 0.05, refine = [{ shape.box = { lower = [0.4, 0.0], upper = [1.0, 1.0] } }] }
time.end = 0.1
physics.gravity = [0.0, -9.81]
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [1.2, 1.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 1.0] } }]
"""
GAS = """
scheme = "gas"
space = { dimensions = 1, spacing = 0.02, lower = [0.0], upper = [2.0] }
time.end = 0.1
ideal_gases.air = { shape.box = { lower = [0.0], upper = [2.0] }, density = 1.3, pressure = 1.0 }
"""


@pytest.mark.parametrize("text", [REFINED, GAS], ids=["refined", "gas"])
@pytest.mark.parametrize(
    "asked",
    [{}, {"passes": 2}, {"damping_every": 4}, {"passes": 2, "damping_every": 4}, {"lead": 0.1}],
)
def test_keys_of_the_time_that_do_nothing_are_warned_of_once(tmp_path, text, asked):
    scene = Scene(draft(tmp_path, text, *(f"time.{key}={value}" for key, value in asked.items())))
    plan = make_plan(scene)
    told = [line.partition(" does nothing")[0] for line in plan_warnings(scene, plan, 1)]
    assert told == [f"{scene.case.file}: time.{key}: {value}" for key, value in asked.items()]
    assert not [line for line in hints(scene, plan) if line.startswith("time.")]


def test_keys_of_the_time_that_do_something_are_not_warned_of(tmp_path):
    scene = Scene(draft(tmp_path, TANK, "scheme=stable", "time.passes=2", "time.damping_every=4"))
    assert not [*plan_warnings(scene, make_plan(scene), 1)]


DOES_NOTHING = ("physics.wall_approach=2.0", "physics.tension_floor=0.9")


@pytest.mark.parametrize("key", DOES_NOTHING)
def test_a_key_whose_effect_is_left_out_is_warned_of(tmp_path, key):
    """Where the case gives it.  The controls: what the scheme sets, and both in a tank, where they act."""
    closed = ("space.periodic=['x', 'y']", "space.lower=[0.0, 0.0]", "space.upper=[1.0, 1.0]")
    closed += ("physics.sound_speed=10.0", "scheme=stable")
    name = key.partition("=")[0]
    for text, keys, told in (
        (SQUARE, (*closed, key), True),
        (SQUARE, closed, False),
        (TANK, ("scheme=stable", key), False),
    ):
        scene = Scene(draft(tmp_path, text, *keys))
        lines = [line for line in plan_warnings(scene, make_plan(scene), 1) if name in line]
        assert len(lines) == told and all(line.endswith("; remove it") for line in lines)
        assert all(f"{scene.case.file}: {name} does nothing here: " in line for line in lines)


def test_a_key_that_serves_what_is_no_effect_is_not_warned_of():
    """Bodies meet by impulses, with the friction of the key that elastic solids have too."""
    scene = Scene(load("run/cases/coast/armour.toml"))
    plan = make_plan(scene)
    assert plan.dropped["SolidContact"] and not [*plan_warnings(scene, plan, 1)]
