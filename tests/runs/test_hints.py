"""Effects that nothing in a scene can feel are named, and those that act are not."""

import pytest
from drafts import SQUARE, TANK, draft

from psph.runs.hints import hints
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
