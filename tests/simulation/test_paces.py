"""Rates that serve for several steps: the same sums in a pass of their own, and for as many as a scene bears."""

import numpy as np
import pytest
import tomli_w
from drafts import draft
from invariances.running import begun, by_id
from invariances.scenes import box, poured, scene, tank, water

from psph.physics.motion import HELD_COUPLE
from psph.scene import Scene
from psph.simulation.passes import HELD
from psph.simulation.plan import make_plan

DISC = {
    "shape": {"disc": {"center": [0.75, 0.5], "radius": 0.3}},
    "density": 800.0,
    "no_slip": True,
    "spin": 2.0,
}
STIRRED = poured(
    {"tank": tank(no_slip=True)},
    {"water": water(viscosity=0.15)},
    bodies={"disc": DISC},
)
FREE = scene(
    fluids={
        "water": water(viscosity=0.2),
        "oil": water(shape=box((0.0, 1.0), (1.5, 1.5)), density=600.0),
    }
)
ALL = (*HELD, HELD_COUPLE.name)


def every(steps, tables=STIRRED, **time):
    """The scene with damping in every so many steps, of one pass."""
    return {**tables, "time": {**tables["time"], "passes": 1, **time, "damping_every": steps}}


def rates(simulation):
    """What the passes of a start have summed, of all particles."""
    return {name: by_id(simulation, name) for name in ("acceleration", "density_rate", "load", "couple")}


def test_rates_in_a_pass_of_their_own_are_those_of_one_pass(tmp_path):
    """Of the fluid, and the loads and couples of what is in it; each held part is a part of them."""
    one, two = begun(every(1), tmp_path), begun(every(4), tmp_path)
    assert two.plan.steps_held == 4 and one.plan.steps_held == 1
    assert not set(ALL) & set(one.plan.arrays) and set(ALL) <= set(two.plan.arrays)
    for name, expected in rates(one).items():
        found = by_id(two, name)
        assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max(), name
    for name in ALL:
        assert np.abs(by_id(two, name)).max() > 0.0, name


def test_they_are_renewed_in_each_fourth_step_and_serve_in_between(tmp_path):
    ran = begun(every(4, FREE), tmp_path)
    found = [by_id(ran, HELD[0])]
    for _ in range(9):
        ran.step()
        found.append(by_id(ran, HELD[0]))
    changed = [bool((a != b).any()) for a, b in zip(found, found[1:])]
    assert changed == [True] + 2 * ([False] * 3 + [True])  # the first step is the one after none


def test_momentum_is_kept_to_rounding_and_the_flow_differs_little(tmp_path):
    """In disorder, by rates that push in pairs; the control is that they do differ."""
    ends = {}
    for steps in (1, 4):
        ran = begun(every(steps, FREE), tmp_path)
        mass = by_id(ran, "mass")
        before = mass @ by_id(ran, "velocity")
        for _ in range(40):
            ran.step()
        gained = mass @ by_id(ran, "velocity") - before
        assert np.abs(gained).max() < 1e-13 * mass @ np.linalg.norm(by_id(ran, "velocity"), axis=1)
        ends[steps] = by_id(ran, "velocity")
    apart = np.linalg.norm(ends[4] - ends[1]) / np.linalg.norm(ends[1])
    assert 1e-6 < apart < 0.03


@pytest.mark.parametrize(
    "steps, tables, held",
    [
        (4, STIRRED, 4),
        (8, STIRRED, 4),
        (4, poured({"tank": tank(no_slip=True)}, {"honey": water(viscosity=12.0)}), 1),
        (4, poured({"tank": tank()}, bodies={"chip": {**DISC, "density": 40.0, "no_slip": False}}), 1),
        (4, every(4, STIRRED, step=1e-4), 4),
    ],
)
def test_as_many_steps_as_the_scene_bears(tmp_path, steps, tables, held):
    """Damping in disorder does not bear 8 in 2D; in honey the step would be shorter, and friction stops light bodies within a step or a few."""
    assert make_plan(Scene(draft(tmp_path, tomli_w.dumps(every(steps, tables))))).steps_held == held
