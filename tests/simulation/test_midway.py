"""Steps with the rate of density at their middle, on sound: v' = −ω r, r' = ω v; and who takes them."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from invariances.running import begun, by_id
from invariances.scenes import BLOCK, DX, PULL, SCENES, WATER, scene, shifts, water
from scipy.spatial import cKDTree
from simulation.test_integrator import RULES, oscillate
from simulation.test_paces import STIRRED
from stores import seen

from psph.case import load
from psph.runs.explain import explain
from psph.runs.hints import plan_warnings
from psph.scene import Scene
from psph.simulation import midway
from psph.simulation.integrator import kick
from psph.simulation.midway import HISTORY, Ahead, drift_to_end, kick_to_middle
from psph.simulation.plan import make_plan
from psph.simulation.rules import Columns


def swing(theta, steps, decay=0.0, lead=0.0, braked=0.0, predicted=0.5):
    """The largest amplitude in ``steps`` steps of ωΔt = ``theta``, from 1, where density also decays by
    ``decay`` of its value a step, as by diffusion, velocity as friction would have it by ``braked``, that
    reads what is ``predicted`` so many steps after the middle, and pressures have a ``lead``; real
    compiled loops."""
    rules = RULES._replace(ahead=Ahead(lead, predicted))
    group = np.zeros(1, np.uint8)
    x, v, seen_v, a = ((np.zeros(1),) for _ in range(4))
    density, rate, volume, pressure = np.ones(1), np.zeros(1), np.ones(1), np.zeros(1)
    v[0][0] = 1.0
    view = seen(position=x, velocity=seen_v, rest_density=1.0, sound_speed=1.0)
    told = group, None, x, v, seen_v, a, density, rate, None, None, volume, pressure
    columns = Columns(*told, coming=(np.zeros(1),))
    largest = 0.0
    for _ in range(steps):
        kick_to_middle(0, 1, 0.0, 1.0, rules, view, columns)
        rate[0] = theta * seen_v[0][0] - decay * (density[0] - 1.0)
        drift_to_end(0, 1, 0.0, 1.0, rules, view, columns)
        a[0][0] = -theta * pressure[0] - braked * seen_v[0][0]
        kick(0, 1, 0.0, 1.0, None, rules, view, columns)
        largest = max(largest, np.hypot(v[0][0], density[0] - 1.0))
    return largest, np.hypot(v[0][0], density[0] - 1.0)


@pytest.mark.parametrize("theta", [0.2, 0.7, 1.44])
def test_sound_neither_grows_nor_fades(theta):
    """Its invariant is v² (1 − θ²/4) + r²: an ellipse."""
    largest, _ = swing(theta, 4000)
    assert 1.0 <= largest < 1.001 / np.sqrt(1.0 - theta**2 / 4.0)


def test_it_is_stable_where_a_step_of_one_pass_is_not():
    assert swing(1.9, 2000)[0] < 4.0
    assert not swing(2.1, 200)[0] < 1e3  # the control
    assert not oscillate(1.2, 400) < 1e3  # and that of one pass


def test_diffusion_has_three_times_the_room_beside_the_fastest_sound():
    assert swing(1.44, 2000, decay=0.9)[1] < 1e-3
    assert not swing(1.44, 2000, decay=1.1)[0] < 1e3  # the control: 2 − θ²/2 = 0.96


@pytest.mark.parametrize("theta, lead", [(0.2, 0.1), (0.2, 0.2), (0.7, 0.1)])
def test_with_a_lead_sound_fades_as_by_a_bulk_viscosity(theta, lead):
    """By √(1 − εθ²) a step, to within the ellipse; without a lead it does not: the test above."""
    steps = 200
    _, left = swing(theta, steps, lead=lead)
    assert left == pytest.approx((1.0 - lead * theta**2) ** (0.5 * steps), rel=0.5 * theta**2)


def test_a_lead_takes_room_from_the_step():
    """4/(1 + 2ε): 1.826 for ε = 0.1, with diffusion 4 − 2d − (1 + 2ε)θ² > 0."""
    assert swing(1.8, 2000, lead=0.1)[1] < 1e-3
    assert not swing(1.9, 400, lead=0.1)[0] < 1e3  # the control
    assert swing(1.44, 2000, decay=0.7, lead=0.1)[1] < 1e-3
    assert not swing(1.44, 2000, decay=0.85, lead=0.1)[0] < 1e3  # the control


def test_friction_has_twice_the_room_where_it_reads_the_middle():
    """(1 + 2ε)θ² < (2 − γ(1 + 2η))(2 − d) for friction that takes γ of the velocity a step.  The controls: by predicted
    velocities, η = ½, and a faster sound."""
    room = {"decay": 0.5, "lead": 0.05, "braked": 0.4}
    assert swing(1.4, 2000, predicted=0.0, **room)[1] < 1e-3
    assert not swing(1.4, 400, predicted=0.5, **room)[0] < 1e3
    assert not swing(1.5, 400, predicted=0.0, **room)[0] < 1e3


@pytest.mark.parametrize("longer, boils", [(midway.AT_A_SURFACE, False), (1.2, True)])
def test_still_water_bears_the_step_that_a_surface_has(tmp_path, monkeypatch, longer, boils):
    """From the sixth step on the control grows at its surface, by 1.2 a step, as linear theory has it
    (tests/theory/test_surface_steps.py)."""
    monkeypatch.setattr(midway, "AT_A_SURFACE", longer)
    still = start(load("run/cases/hard/tank.toml"))
    while still.time < 0.3:
        still.step()
    fastest = np.abs(by_id(still, "velocity")).max()
    assert (
        still.plan.ahead.velocity == 0.0 and (fastest > 0.3) == boils and fastest < (9.0 if boils else 0.02)
    )


def test_a_particle_goes_along_the_chord_and_its_velocity_is_that_of_the_chord():
    group = np.zeros(1, np.uint8)
    x, v, predicted, a = (tuple(np.zeros(1) for _ in range(2)) for _ in range(4))
    for array, value in zip((*x, *v, *a), (0.3, -0.2, 1.0, 2.0, -4.0, 6.0)):
        array[0] = value
    density, rate = np.full(1, 2.0), np.full(1, 3.0)
    view = seen(position=x, velocity=predicted, rest_density=2.0, sound_speed=1.0)
    told = group, None, x, v, predicted, a, density, rate, None, None, np.ones(1), np.zeros(1)
    columns = Columns(*told, coming=tuple(np.zeros(1) for _ in range(2)))
    kick_to_middle(0, 1, 0.0, 0.1, RULES, view, columns)
    half = [c[0] for c in x]
    told_end = [here[0] + left[0] for here, left in zip(x, columns.coming)]
    chord = [c[0] for c in predicted]
    drift_to_end(0, 1, 0.0, 0.1, RULES._replace(ahead=Ahead()), view, columns)
    end = [c[0] for c in x]
    assert chord == pytest.approx([0.8, 2.3]) and density[0] == pytest.approx(2.3)
    assert half == pytest.approx(0.5 * (np.array([0.3, -0.2]) + end)) and told_end == end
    assert [c[0] for c in predicted] == pytest.approx([0.6, 2.6])


def in_passes(tables, passes):
    """The scene in steps of so many passes."""
    return {**tables, "time": {**tables["time"], "passes": passes}}


def in_two(tables):
    """The scene in steps of two passes."""
    return in_passes(tables, 2)


def test_a_body_is_at_the_middle_of_its_chord(tmp_path):
    """A disc that turns and stirs water."""
    ran = begun(in_two(STIRRED), tmp_path)
    for _ in range(3):
        ran.step()
    start, told, honest = by_id(ran, "position"), {}, ran.engine.sum_midway

    def noted(ghosts_are_fresh):
        told.update(x=by_id(ran, "position"), v=by_id(ran, "predicted_velocity"))
        honest(ghosts_are_fresh)

    ran.engine.sum_midway = noted
    ran.step()
    way = by_id(ran, "position") - start
    rigid = np.flatnonzero((by_id(ran, "whirl") != 0.0).any(axis=1))
    assert len(rigid) == 16 and np.linalg.norm(way[rigid], axis=1).max() > 1e-3 * DX
    assert told["x"][rigid] == pytest.approx(start[rigid] + 0.5 * way[rigid], abs=1e-12 * DX)
    assert told["v"][rigid] == pytest.approx(way[rigid] / ran.dt, rel=1e-9)


FALLING = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 0.3
physics = { sound_speed = 30.0, gravity = [0.0, -9.81] }
[fluids.water]
viscosity = 0.01
pressure = 0.0
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.4] }
[bodies.box]
density = 200.0
no_slip = true
shape.box = { lower = [0.2, 0.3], upper = [0.4, 0.5] }
"""


@pytest.mark.parametrize("ahead, lag", [(0.0, 0.4e-3), (1e-300, 1.2e-3)])
def test_what_falls_with_water_is_not_braked_by_it(tmp_path, monkeypatch, ahead, lag):
    """0.27 mm behind free fall after 0.3 s, as in one pass.  The control: with friction between water in the middle of the
    step and bodies at its end it is 1.5 mm."""
    monkeypatch.setattr("psph.simulation.plan.ahead_of", lambda scene: Ahead(scene.case.time.lead, ahead))
    falls = start(draft(tmp_path, FALLING))
    assert falls.plan.midway
    body = by_id(falls, "kind") == 1
    y = by_id(falls, "position")[body, 1].mean()
    while falls.time < 0.3:
        falls.step()
    behind = by_id(falls, "position")[body, 1].mean() - y + 0.5 * 9.81 * falls.time**2
    assert (behind < lag) == (ahead == 0.0) and behind < 2e-3, behind


def test_what_is_written_changes_no_bit(tmp_path):
    """Nor does it where a surface resets the density: what is read at the middle of the next step is what stood
    when ghosts were brought, not what a kick has made of it."""
    surface = {"free_surface": 0.9, "density_diffusion": 0.1, "gravity": PULL}
    tables = in_two(
        scene(scheme="sph", fluids={"water": water()}, physics=surface, perturbations=shifts(*WATER))
    )
    unseen, shown = begun(tables, tmp_path), begun(tables, tmp_path)
    for _ in range(25):
        unseen.step()
        shown.step()
        shown.settle_pressure()
    assert (by_id(shown, "kernel_sum") < 0.9).any() and unseen.plan.midway
    assert np.array_equal(by_id(unseen, "velocity"), by_id(shown, "velocity"))


DAM = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 0.5
physics.sound_speed = 45.0
physics.gravity = [0.0, -9.8]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 1.0] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.15, -0.15], upper = [2.15, 2.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 2.0] } }]
"""


def test_nor_does_it_where_pressures_are_ahead(tmp_path):
    """Walls give no density to where they bear no pressure: by that of the density, and not that ahead of it, water
    went elsewhere by a spacing and a half in half a second, and on other ranks."""
    unseen, shown = (start(draft(tmp_path, DAM)) for _ in range(2))
    assert unseen.plan.midway and unseen.plan.ahead.pressure > 0.0
    while unseen.time < 0.45:
        unseen.step()
        shown.step()
        shown.settle_pressure()
    assert np.array_equal(by_id(unseen, "velocity"), by_id(shown, "velocity"))
    assert np.abs(by_id(unseen, "velocity")).max() > 2.0  # it falls


def test_the_default_takes_two_passes_where_they_pay(tmp_path):
    """Not where friction limits a step, where a fixed one is short, or where rates of friction are held."""
    for why, *sets in (
        ("",),
        ("since with two a step is 1.", "fluids.water.viscosity=0.5"),
        ("since time.step is no longer than one bears", "time.step=1e-4"),
        ("", "time.step=1.2e-3"),
        ("since friction is summed in some steps alone", "time.damping_every=4"),
        ("", "time.damping_every=4", "time.passes=2"),
    ):
        scene = Scene(draft(tmp_path, DAM, *sets))
        plan = make_plan(scene)
        assert plan.rate_passes == (1 if why else 2), sets
        assert (plan.ahead is None) == bool(why) and why in "\n".join(explain(scene, 1))


def test_a_given_step_is_told_beside_what_it_does_not_heed(tmp_path):
    """The control: one that is no longer than that."""
    for step, told in (("0.002", True), ("1e-3", False)):
        scene = Scene(draft(tmp_path, DAM, f"time.step={step}"))
        plan = make_plan(scene)
        warned = [line for line in plan_warnings(scene, plan, 1) if "time.step: " in line]
        assert bool(warned) == told and all("sound (CFL) allows; remove it" in line for line in warned)
        assert "not heeded: sound (CFL)" in "\n".join(explain(scene, 1))


STILL = (
    "fluids.water.shape.box={ lower=[0.0, 0.0], upper=[2.0, 1.0] }",
    "space.kernel=wendland-c4",
    "space.smoothing=1.6",
)
DEEP = (
    "walls.tank.shape.difference.from.box={ lower=[-0.3, -0.3], upper=[2.3, 2.0] }",
    "walls.tank.shape.difference.minus=[{ box={ lower=[0.0, 0.0], upper=[2.0, 2.0] } }]",
)


def test_a_lead_asks_for_shorter_steps_where_sound_is_faster_on_the_lattice(tmp_path, monkeypatch):
    """Still water, by Wendland C4, whose fastest sound is a sixth faster than C2's.  The control: as long steps as
    C2 bears, and it boils."""
    speeds = []
    for fastest in (midway.FASTEST, 10.0):
        monkeypatch.setattr(midway, "FASTEST", fastest)
        still = start(draft(tmp_path, DAM, *STILL, *DEEP))
        while still.time < 2.0:
            still.step()
        speeds.append(np.abs(by_id(still, "velocity")).max())
    assert speeds[0] < 0.05 and speeds[1] > 0.2


def test_lists_made_at_the_middle_of_a_step_stand_shifts_to_its_end(tmp_path):
    """In disorder that drifts, where shifts are what moves neighbours apart; 1.2 of the skin where the whole shift
    came in the second half of a step."""
    drifting = {"shape": BLOCK, "density": 1000.0, "velocity": [1.0, 0.0], "jitter": 0.3}
    tables = scene(fluids={"water": drifting}, time={"cfl": 0.5, "passes": 2}, neighbours={"skin": 0.02})
    ran, apart = begun(tables, tmp_path), []
    skin, honest = ran.neighbourhood.skin, ran.engine.sum

    def watched(*args, **keys):
        listed, moved = by_id(ran, "listed_position"), by_id(ran, "position") - by_id(ran, "listed_position")
        one, other = cKDTree(listed).query_pairs(skin.domain.cutoff, output_type="ndarray").T
        apart.append(np.linalg.norm(moved[one] - moved[other], axis=1).max() / skin.width)
        honest(*args, **keys)

    ran.engine.sum = watched
    for _ in range(60):
        ran.step()
    assert 0.5 < max(apart) < 1.0 and 2 < ran.domain.rebuilds < 40


@pytest.mark.parametrize(("passes", "of_walls"), [(2, False), (1, True)])
def test_forces_are_summed_on_what_moves_alone(tmp_path, passes, of_walls):
    """The control: in one pass with the rate of density they are summed on walls too, where nobody reads them."""
    tank = start(draft(tmp_path, DAM, f"time.passes={passes}"))
    tank.step()
    size = np.abs(tank.store.shown("acceleration")).max(axis=1)
    walls = tank.store.shown("kind") == 1
    assert (size[walls].max() > 0.0) == of_walls and size[~walls].max() > 0.0


def test_it_asks_for_no_history_and_sends_no_more_than_what_has_moved(tmp_path):
    one, two = (begun(in_passes(STIRRED, passes), tmp_path).plan for passes in (1, 2))
    assert one.midway is None and two.midway is two.passes[0]
    assert {f.name for f in HISTORY} == set(one.arrays) - set(two.arrays)
    assert two.midway.moved == ("position", "predicted_velocity")
    assert one.refreshed == two.refreshed
    assert two.cfl == pytest.approx(2.0 * midway.AT_A_SURFACE * one.cfl) and two.midway.gives == (
        None,
        "density_rate",
    )
    assert two.passes[-1].gives == ("acceleration", None)


@pytest.mark.parametrize("name", ["solid", "soil"])
def test_what_moves_by_more_than_rates_and_poses_keeps_one_pass(tmp_path, name):
    plan = begun(in_two(SCENES[name]), tmp_path).plan
    scene = Scene(load(tmp_path / "case.toml"))
    [told] = plan_warnings(scene, plan, 1)
    assert "time.passes: 2 does nothing: not all that is in the scene bears it" in told
    why = f"one a step, since beside {name}"
    assert (why in "\n".join(explain(scene, 1))) == (name == "soil")  # solids alone have no pass in space
    assert plan.midway is None and plan.cfl == SCENES[name]["time"].get("cfl", plan.cfl)
