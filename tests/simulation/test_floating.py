"""Rigid bodies in a fluid and beside walls."""

import math

import gauging
import numpy as np
import pytest
from drafts import draft, refusal

from psph.case import CaseError
from psph.fields import FLUID
from psph.output.gauges import gauges_of
from psph.physics.motion import COUPLE
from psph.physics.rigid.pose import rotation
from psph.scene import Scene, check
from psph.scene.body_parts import bodies_of
from psph.simulation.plan import make_plan

POOL = """
[space]
dimensions = 2
spacing = {dx}
[time]
end = 10.0
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = {{ lower = [0.0, 0.0], upper = [1.0, 0.4] }}
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = {{ lower = [-0.15, -0.15], upper = [1.15, 0.8] }}
shape.difference.minus = [{{ box = {{ lower = [0.0, 0.0], upper = [1.0, 0.8] }} }}]
"""

STIRRED = """
[space]
dimensions = 2
spacing = 0.05
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.0, 1.2]
[time]
end = 1.0
gather_every = 3
[physics]
sound_speed = 30.0
[fluids.heavy]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
density = 1200.0
viscosity = 0.02
velocity = [0.5, -0.4]
jitter = 0.2
[fluids.light]
shape.box = { lower = [0.0, 0.6], upper = [1.0, 1.2] }
density = 900.0
viscosity = 0.01
velocity = [-0.8, 0.3]
jitter = 0.1
[bodies.one]
shape.disc = { center = [0.3, 0.6], radius = 0.19 }
density = 700.0
no_slip = true
velocity = [0.3, 0.2]
spin = 2.0
[bodies.other]
shape.box = { lower = [0.85, 0.3], upper = [1.0, 0.5] }
mass = 50.0
continues = "light"
"""
"""Two fluids in disorder around two bodies, in a domain without ends."""


def started(case):
    """A simulation of a case, its bodies and its scene."""
    simulation, scene = gauging.started(case)
    return simulation, simulation.engine.of("bodies").bodies, scene


def in_pool(folder, body, dx=0.05):
    """The same of the text of a body in the pool."""
    return started(draft(folder, POOL.format(dx=dx) + body))


def momentum(simulation, bodies) -> np.ndarray:
    """Of fluids and bodies, kg m/s."""
    store = simulation.store
    fluid = store.shown("kind") == FLUID
    flowing = (store.shown("mass")[fluid, None] * store.shown("velocity")[fluid]).sum(axis=0)
    return flowing + (bodies.mass * bodies.velocity).sum(axis=0)[:2]


def test_fluids_and_bodies_keep_their_momentum_together(tmp_path):
    simulation, bodies, _ = started(draft(tmp_path, STIRRED))
    begun, own = momentum(simulation, bodies), bodies.velocity.copy()
    size = np.abs(simulation.store.shown("mass")[:, None] * simulation.store.shown("velocity")).sum()
    for _ in range(60):
        simulation.step()
    assert np.abs(bodies.velocity - own).max() > 0.05  # they have been pushed
    assert np.abs(momentum(simulation, bodies) - begun).max() < 1e-12 * size


def test_particles_stay_where_their_body_has_them(tmp_path):
    simulation, bodies, _ = started(draft(tmp_path, STIRRED))
    store = simulation.store
    for _ in range(60):
        simulation.step()
    held = np.flatnonzero(store.shown("group") == 2)
    row = [one.name for one in bodies.bodies].index("one")
    there = [bodies.at(row, np.append(anchor, 0.0))[0][:2] for anchor in store.shown("anchor")[held]]
    apart = simulation.domain.inside(store.shown("position")[held]) - simulation.domain.inside(
        np.array(there)
    )
    assert np.abs(apart).max() < 1e-12


def test_a_body_far_from_all_falls_and_spins_exactly(tmp_path):
    simulation, bodies, _ = in_pool(
        tmp_path,
        """
[bodies.brick]
shape.box = { lower = [0.2, 2.0], upper = [0.4, 2.3] }
density = 400.0
velocity = [0.3, 1.0]
spin = -3.0
""",
    )
    while simulation.time < 0.3:
        simulation.step(0.3)
    assert bodies.place[0, :2] == pytest.approx([0.3 + 0.09, 2.15 + 0.3 - 0.5 * 9.81 * 0.09], rel=1e-12)
    assert bodies.angle[0] == pytest.approx(-0.9, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.8])
def test_a_floating_box_comes_to_its_draft(tmp_path, ratio):
    side = 0.2
    afloat = 0.4 - ratio * side  # its lower face, before the water that it displaces rises
    text = (
        POOL.format(dx=0.025)
        + f"""
[bodies.box]
shape.box = {{ lower = [0.4, {0.025 * round(afloat / 0.025)}], upper = [0.6, {0.025 * round(afloat / 0.025) + side}] }}
density = {1000.0 * ratio}
free = ["x", "y"]
[gauges.box.motion]
of = "box"
[gauges.left.level]
foot = [0.15, 0.0]
top = [0.15, 0.7]
[gauges.push.force]
on = ["box"]
"""
    )
    simulation, bodies, scene = started(draft(tmp_path, text))
    bottoms, levels, pushes = [], [], []
    while simulation.time < 1.5:
        simulation.step()
        if simulation.time > 0.9 and simulation.steps % 8 == 0:
            simulation.settle_pressure()
            read = {}
            for gauge in gauges_of(scene).values():
                read |= dict(zip(gauge.columns(scene), map(float, gauge.row(simulation)), strict=True))
            bottoms.append(read["box.centre_y"] - 0.5 * side)
            levels.append(read["left.level"])
            pushes.append(read["push.force_y"])
    draught = np.mean(levels) - np.mean(bottoms)
    assert draught == pytest.approx(ratio * side, abs=0.5 * 0.025 + 0.01 * side)
    assert np.mean(pushes) == pytest.approx(1000.0 * ratio * side**2 * 9.81, rel=0.03)


def test_what_holds_a_body_under_water_bears_its_weight_less_that_of_the_water(tmp_path):
    text = (
        POOL.format(dx=0.025)
        + """
[bodies.block]
shape.box = { lower = [0.4, 0.1], upper = [0.6, 0.3] }
density = 1700.0
held = 9.0
[gauges.block.motion]
of = "block"
"""
    )
    simulation, _, scene = started(draft(tmp_path, text))
    [gauge] = gauges_of(scene).values()
    read = []
    while simulation.time < 0.6:
        simulation.step()
        if simulation.time > 0.2:
            read.append(dict(zip(gauge.columns(scene), gauge.row(simulation), strict=True)))
    mean = {column: np.mean([one[column] for one in read]) for column in read[0]}
    weight, water = (density * 0.04 * 9.81 for density in (1700.0, 1000.0))
    assert mean["block.reaction_y"] == pytest.approx(weight - water, rel=0.02)
    assert mean["block.force_y"] == pytest.approx(-mean["block.reaction_y"])
    assert abs(mean["block.reaction_x"]) < 0.01 * water
    assert abs(mean["block.reaction_moment_z"]) < 0.01 * water * 0.2
    free = Scene(draft(tmp_path, text.replace("held = 9.0", "")))
    [gauge] = gauges_of(free).values()
    assert not [column for column in gauge.columns(free) if "reaction" in column]


def test_bodies_rest_on_each_other_and_on_the_floor(tmp_path):
    simulation, bodies, scene = in_pool(
        tmp_path,
        """
[walls.table]
shape.box = { lower = [1.15, -0.15], upper = [2.5, 0.0] }
[bodies.low]
shape.box = { lower = [1.7, 0.1], upper = [2.0, 0.3] }
density = 2000.0
[bodies.high]
shape.box = { lower = [1.6, 0.4], upper = [2.1, 0.6] }
density = 800.0
[gauges.table.force]
on = ["table"]
[gauges.low.force]
on = ["low"]
""",
    )
    while simulation.time < 1.2:
        simulation.step()
    low, high = ([one.name for one in bodies.bodies].index(name) for name in ("low", "high"))
    assert bodies.place[low, 1] == pytest.approx(0.1, abs=0.005)
    assert bodies.place[high, 1] == pytest.approx(0.3, abs=0.01)
    assert np.abs(bodies.velocity).max() < 0.02 and np.abs(bodies.angle).max() < 1e-3
    # Newton's third law: what the floor bears is the weight of both, and the upper rests on the lower.
    assert bodies.pushed[high, 1] == pytest.approx(0.0, abs=0.05 * 80.0 * 9.81)
    # A gauge tells the fluid's push on a wall, which is dry here, and of a body its contacts too.
    table, own = (gauge.row(simulation) for gauge in gauges_of(scene).values())
    assert not table.any() and own[1] == pytest.approx(120.0 * 9.81, rel=0.05)


def test_a_dry_body_lands_on_a_mirror(tmp_path):
    # The water does not reach it so soon.
    text = (
        POOL.format(dx=0.05).replace("upper = [1.0, 0.4]", "upper = [0.3, 0.1]").replace(".15", ".2")
        + """
condition = "mirror"
[bodies.block]
shape.box = { lower = [0.6, 0.1], upper = [0.8, 0.3] }
density = 2000.0
"""
    )
    # In steps that are short beside the time of the contact.
    simulation, bodies, _ = started(draft(tmp_path, text, "time.cfl=0.25"))
    heights, speeds = [], []
    while simulation.time < 0.25:
        simulation.step()
        heights.append(bodies.place[0, 1])
        speeds.append(bodies.velocity[0, 1])
    assert 0.1 - 1e-6 < min(heights) < 0.101 and max(speeds) > 0.1  # it springs back
    assert abs(bodies.place[0, 0] - 0.7) < 1e-9 and abs(bodies.angle[0]) < 1e-9


def test_a_gate_on_a_hinge_turns_about_its_hinge(tmp_path):
    simulation, bodies, _ = in_pool(
        tmp_path,
        """
[bodies.gate]
shape.box = { lower = [0.6, 0.15], upper = [0.7, 0.75] }
density = 1500.0
pivot = [0.65, 0.7]
spin = 1.5
""",
    )
    for _ in range(150):
        simulation.step()
    assert np.array_equal(bodies.place[0], [0.65, 0.7, 0.0]) and abs(bodies.angle[0]) > 0.02
    held = np.flatnonzero(simulation.store.shown("group") == 2)
    far = simulation.store.shown("position")[held] - [0.65, 0.7]
    begun = simulation.store.shown("anchor")[held] - [0.65, 0.7]
    assert np.linalg.norm(far, axis=1) == pytest.approx(np.linalg.norm(begun, axis=1), rel=1e-12)


def test_mass_and_inertia_are_those_of_the_shape(tmp_path):
    text = (
        POOL.format(dx=0.05)
        + """
[bodies.plate]
shape.box = { lower = [0.2, 0.5], upper = [0.5, 0.6] }
density = 700.0
[bodies.ring]
shape.disc = { center = [0.7, 0.6], radius = 0.1 }
mass = 3.0
inertia = 0.25
centre = [0.71, 0.6]
"""
    )
    plate, ring = bodies_of(Scene(draft(tmp_path, text)).census)
    assert plate.mass == pytest.approx(700.0 * 0.03)
    assert plate.centre == pytest.approx((0.35, 0.55, 0.0))
    assert plate.inertia[8] == pytest.approx(21.0 * (0.09 + 0.01) / 12.0)
    assert (ring.mass, ring.inertia[8], ring.centre) == (3.0, 0.25, (0.71, 0.6, 0.0))


def test_scenes_without_bodies_have_nothing_of_them(tmp_path):
    plain = make_plan(Scene(draft(tmp_path, POOL.format(dx=0.05))))
    asked = make_plan(Scene(draft(tmp_path, STIRRED)))
    assert plain.of("bodies") is None
    assert not {"load", "anchor"} & set(plain.arrays)
    assert asked.of("bodies") and {"load", "anchor"} <= set(asked.arrays)


SYMMETRIC = (
    "walls.tank.shape={box={lower=[0.0,-0.15],upper=[1.15,0.0]}}",
    "space.symmetry=['x.lower']",
    "space.lower=[0.0,-0.15]",
    "space.upper=[1.15,0.8]",
)

BRICK = "bodies.brick.shape.box={lower=[0.2,0.5],upper=[0.4,0.7]}"


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ((), "bodies.brick: give either mass or density"),
        (("bodies.brick.mass=0.0",), "mass: 0.0 is out of range"),
        (("bodies.brick.density=-1.0",), "density: -1.0 is out of range"),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.free=['z']"),
            "there is no such motion in 2D; give x, y, turn_z",
        ),
        (("bodies.brick.mass=1.0", "bodies.brick.free=['x', 'x']"), "stands there twice; remove one"),
        (("bodies.brick.mass=1.0", "bodies.brick.inertia=-2.0"), "is not above zero"),
        (("bodies.brick.mass=1.0", "bodies.brick.spin=[1.0,2.0]"), "give one number in 2D, three in 3D"),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.pivot=[0.3,0.6]", "bodies.brick.free=['x','turn_z']"),
            "what has a pivot moves along no axis",
        ),
        (
            (
                "bodies.brick.mass=1.0",
                "bodies.brick.lines.rope={at=[0.3,0.6],anchor=[0.3,0.0],stiffness=1.0,to='crane'}",
            ),
            "no other body or wall has this name; leave out to for a point in space",
        ),
        (
            ("bodies.brick.mass=1.0", "physics.pressure_gradient=minimum", "scheme=sph"),
            'physics.pressure_gradient: "minimum": does not push back what pushes',
        ),
        (("bodies.brick.mass=1.0", "gauges.g.motion.of=tank"), "no body has this name"),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.free=['y']", "bodies.brick.velocity=[1.0,2.0]"),
            "bodies.brick.velocity: [1.0, 2.0]: the body is not free to move along x",
        ),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.pivot=[0.3,0.6]", "bodies.brick.velocity=[0.0,2.0]"),
            "not free to move along y; give spin instead",
        ),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.free=['x','y']", "bodies.brick.spin=2.0"),
            "the body is not free to do turn_z; give 0 there, or let free hold turn_z",
        ),
        (
            (
                "bodies.brick.mass=1.0",
                "bodies.brick.free=['turn_z']",
                "bodies.brick.motion={rotation={speed=1.0,center=[0.3,0.6]}}",
            ),
            "bodies.brick.motion: rotation: the body is free to do turn_z, where forces move it",
        ),
        (
            (
                "bodies.brick.mass=1.0",
                "bodies.brick.free=['y']",
                "bodies.brick.motion=[{translation=[1.0,0.0]},{sinusoid={amplitude=[0.0,0.1],period=1.0}}]",
            ),
            "bodies.brick.motion: sinusoid: the body is free to do y, where forces move it",
        ),
        (
            (
                "bodies.brick.mass=1.0",
                "bodies.brick.held=0.2",
                "bodies.brick.free=['y']",
                "bodies.brick.motion={translation=[1.0,0.0]}",
            ),
            "bodies.brick.held: 0.2: a body that moves as told is not held; remove held",
        ),
    ],
)
def test_bodies_that_cannot_be_are_refused(tmp_path, overrides, says):
    lines = refusal(tmp_path, POOL.format(dx=0.05), BRICK, *overrides)
    assert len(lines) == 1 and says in lines[0]


ROUND = ("space.periodic=['x']", "space.lower=[0.0,-0.15]", "space.upper=[1.0,0.8]")
PLANK = (*ROUND, "walls={bed={shape={box={lower=[0.0,-0.15],upper=[1.0,0.0]}}}}", "bodies.brick.mass=1.0")
SEAM = "bodies.brick.shape={union=[{box={lower=[0.0,0.5],upper=[0.1,0.7]}},{box={lower=[0.9,0.5],upper=[1.0,0.7]}}]}"
LONG_ONE = "bodies.brick.shape={box={lower=[0.2,0.5],upper=[0.75,0.7]}}"


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ((SEAM,), "reaches 0.5 m from the centre that it turns about along x, half of the period of 1 m"),
        ((LONG_ONE, "bodies.brick.pivot=[0.2,0.6]"), "reaches 0.55 m from the pivot that it turns about"),
        ((LONG_ONE,), None),
        ((LONG_ONE, "bodies.brick.pivot=[0.3,0.6]"), None),
        ((SEAM, "bodies.brick.free=['x','y']"), None),
    ],
)
def test_bodies_that_turn_reach_less_than_half_a_period(tmp_path, overrides, says):
    case = draft(tmp_path, POOL.format(dx=0.05), *PLANK, *overrides)
    try:
        lines = check(Scene(case))
    except CaseError as error:
        lines = error.lines
    found = [line for line in lines if "period of" in line]
    assert len(found) == (says is not None) and all(says in line for line in found), lines


def test_the_moment_on_a_body_has_no_jump_at_the_seam(tmp_path):
    """A box beyond the seam by half: its moment about a point is that of the whole box."""
    text = STIRRED + '[gauges.push.force]\non = ["other"]\nabout = [0.4, 0.1]\n'
    simulation, bodies, scene = started(draft(tmp_path, text))
    store, poses = simulation.store, simulation.engine.poses
    group = list(scene.species).index(next(one for one in scene.species if one.name == "other"))
    own = np.flatnonzero(store.shown("group") == group)
    anchors, load = store.shown("anchor")[own], np.random.default_rng(5).normal(size=(len(own), 2))
    couple = np.linspace(-1.0, 2.0, len(own))  # of a viscous fluid, m²/s²
    store[COUPLE.name][0][store.low + own] = couple
    row = [one.name for one in bodies.bodies].index("other")
    for way in (0.0, 0.075, 1.05):  # 1.3 would be inside of the other body
        bodies.place[row, 0] = bodies.reference[row, 0] + way
        poses.turn_to(0.0)
        x = anchors + [way, 0.0]
        for d in range(2):
            store["position"][d][store.low + own] = simulation.domain.inside(x)[:, d]
            store["load"][d][store.low + own] = load[:, d]
        assert way == 0.0 or (store.shown("position")[own, 0] < 0.5).any()
        force = store.shown("mass")[own, None] * load
        wanted = ((x[:, 0] - 0.4) * force[:, 1] - (x[:, 1] - 0.1) * force[:, 0]).sum()
        wanted += (store.shown("mass")[own] * couple).sum()
        [gauge] = gauges_of(scene).values()
        assert gauge.row(simulation)[2] == pytest.approx(wanted, rel=1e-9)


def test_a_byte_counts_all_parts(tmp_path):
    few = "bodies.brick.mass=1.0"
    walls = (f"walls.w{n}.shape.box={{lower=[{n}.0,-1.0],upper=[{n}.5,-0.5]}}" for n in range(98))
    fluids = (f"fluids.f{n}.shape.box={{lower=[{n}.0,5.0],upper=[{n}.5,5.5]}}" for n in range(98))
    bodies = (
        f"bodies.b{n}={{shape={{box={{lower=[{n}.0,9.0],upper=[{n}.5,9.5]}}}},mass=1.0}}" for n in range(60)
    )
    lines = refusal(tmp_path, POOL.format(dx=0.05), BRICK, few, *walls, *fluids, *bodies)
    assert len(lines) == 1 and "259 fluids, walls and bodies; a case holds 250 at most" in lines[0]


def test_a_turn_is_told_as_axis_times_angle(tmp_path):
    _, bodies, _ = in_pool(
        tmp_path,
        """
[bodies.brick]
shape.box = { lower = [0.2, 2.0], upper = [0.4, 2.3] }
mass = 1.0
""",
    )
    for axis, angle in (((0.6, 0.0, 0.8), 2.5), ((0.0, -1.0, 0.0), math.pi), ((0.0, 0.0, 1.0), 1e-9)):
        bodies.hinged = np.array([], int)
        bodies.turn[0] = np.reshape(rotation(axis, angle), (3, 3))
        told = bodies.turned(0)
        told = told if told @ np.array(axis) > 0.0 else -told  # half a turn has no sign
        assert told == pytest.approx(angle * np.array(axis), rel=1e-6, abs=1e-15)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (("bodies.brick.mass=1.0", "bodies.brick.shape.box.lower=[0.2,-0.1]"), "overlaps walls.tank at"),
        (
            ("bodies.brick.mass=1.0", "bodies.b={shape={disc={center=[0.4,0.6],radius=0.1}},mass=1.0}"),
            "bodies.b.shape: overlaps bodies.brick at",
        ),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.shape.box.upper=[0.201,0.501]"),
            "no lattice site lies in it",
        ),
        (
            ("bodies.brick.mass=1.0", "bodies.brick.shape.box.lower=[0.0,0.5]", *SYMMETRIC),
            "bodies.brick.free: x, turn_z would take it off the mirror at x = 0 m",
        ),
        (("bodies.brick.density=1e6",), "1e+03 times the density of its fluid; give mass in kg per metre"),
        (
            (
                "bodies.brick.density=500.0",
                "bodies.brick.lines.a={at=[0.2,0.5],anchor=[0.0,0.0],stiffness=1e12}",
            ),
            "times shorter than sound does; make lines softer",
        ),
    ],
)
def test_check_tells_of_bodies_that_fit_nowhere(tmp_path, overrides, says):
    try:
        lines = check(Scene(draft(tmp_path, POOL.format(dx=0.05), BRICK, *overrides)))
    except CaseError as error:
        lines = error.lines
    assert len([line for line in lines if says in line]) == 1, lines
