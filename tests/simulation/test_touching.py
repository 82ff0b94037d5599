"""Rigid bodies that meet: they bounce, rest, slide and roll as Signorini and Coulomb have it, by their shapes."""

import math

import numpy as np
import pytest
from drafts import draft
from dry import FLAT, SOLID, Dry, parts, turned

from psph.scene.distance import faces_of


def slope(degrees, shape, dx=0.05, friction=0.0, restitution=0.0):
    """A block or a disc on a slope that falls to the right."""
    floor = turned(-degrees, [(-1.0, -0.3), (9.0, -0.3), (9.0, 0.0), (-1.0, 0.0)])
    return (
        FLAT.format(dx=dx, friction=friction, restitution=restitution)
        + f"""
[walls.floor]
shape.polygon.points = {floor}
[bodies.block]
{shape}
density = 2500.0
"""
    )


def block(degrees, gap=0.0):
    points = turned(-degrees, [(0.0, gap), (0.6, gap), (0.6, 0.3 + gap), (0.0, 0.3 + gap)])
    return f"shape.polygon.points = {points}"


@pytest.mark.parametrize("degrees", [7.0, 25.0, 41.0])
@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_block_slides_down_a_slope_of_any_angle(tmp_path, degrees, friction):
    dry = Dry(draft(tmp_path, slope(degrees, block(degrees), friction=friction)))
    bodies = dry.to(0.6)
    down = np.array([math.cos(math.radians(degrees)), -math.sin(math.radians(degrees))])
    pull = 9.81 * (math.sin(math.radians(degrees)) - friction * math.cos(math.radians(degrees)))
    way = bodies.place[0, :2] - bodies.reference[0, :2]
    assert way @ down == pytest.approx(0.5 * pull * 0.36, rel=0.01)
    assert abs(way @ [-down[1], down[0]]) < 1e-4 and abs(bodies.angle[0]) < 1e-4


def test_a_block_sticks_where_friction_holds_it(tmp_path):
    dry = Dry(draft(tmp_path, slope(25.0, block(25.0), friction=0.48)))
    bodies = dry.to(0.6)
    assert np.abs(bodies.place - bodies.reference).max() < 1e-6 and np.abs(bodies.velocity).max() < 1e-9
    # What a body that rests shows is no acceleration, and its contacts bear its weight.
    assert np.abs(bodies.acceleration).max() < 1e-6
    assert bodies.pressing[0, 1] == pytest.approx(-bodies.weight[0, 1], rel=1e-6)


def test_a_disc_rolls(tmp_path):
    middle = turned(-20.0, [(0.3, 0.25)])[0]  # its particles have theirs elsewhere
    shape = f"shape.disc = {{ center = {middle}, radius = 0.25 }}\ncentre = {middle}"
    rolling, sliding = (
        Dry(draft(tmp_path, slope(20.0, shape, friction=friction))) for friction in (0.5, 0.0)
    )
    way = [np.hypot(*(dry.to(0.6).place - dry.bodies.reference)[0, :2]) for dry in (rolling, sliding)]
    full = 0.5 * 9.81 * math.sin(math.radians(20.0)) * 0.36
    spread = rolling.bodies.inertia[0, 2, 2] / rolling.bodies.mass[0, 0]
    assert way[0] == pytest.approx(full / (1.0 + spread / 0.25**2), rel=0.01)
    assert way[1] == pytest.approx(full, rel=0.01) and abs(sliding.bodies.angle[0]) < 1e-9


PAIR = """
[bodies.a]
shape.box = {{ lower = [0.0, 0.0], upper = [0.48, 0.48] }}
density = {density}
velocity = [{speed}, 0.0]
[bodies.b]
shape.box = {{ lower = [0.8, {up}], upper = [1.28, {top}] }}
density = {density}
velocity = [-{speed}, 0.0]
"""


def pair(dx=0.02, density=19300.0, speed=1.0, up=0.0, restitution=0.3):
    text = FLAT.format(dx=dx, friction=0.0, restitution=restitution).replace("-9.81", "0.0")
    return text + PAIR.format(density=density, speed=speed, up=up, top=round(up + 0.48, 6))


@pytest.mark.parametrize("dx", [0.02, 0.04, 0.08])
@pytest.mark.parametrize(("speed", "restitution"), [(1.0, 0.3), (10.0, 0.8)])
def test_cubes_bounce_alike_at_every_spacing(tmp_path, dx, speed, restitution):
    case = draft(tmp_path, pair(dx=dx, density=7850.0, speed=speed, restitution=restitution))
    dry, nearest = Dry(case, dt=0.04 * dx / speed), np.inf
    while dry.time < 0.4 / speed:
        dry.step()
        nearest = min(nearest, dry.bodies.place[1, 0] - dry.bodies.place[0, 0])
    assert dry.bodies.velocity[:, 0] == pytest.approx([-restitution * speed, restitution * speed], rel=1e-9)
    assert nearest > 0.48 - 1e-9 and nearest < 0.48 + 0.1 * dx


def test_an_impact_off_the_centre_keeps_momentum_and_what_elastic_ones_keep(tmp_path):
    dry = Dry(draft(tmp_path, pair(up=0.2, restitution=1.0)), dt=1e-3)
    bodies = dry.bodies
    spin = bodies.angular_momentum + np.cross(bodies.centre, bodies.mass * bodies.velocity)
    begun = bodies.kinetic_energy().sum()
    dry.to(0.3)
    assert np.abs(bodies.angle).min() > 0.05
    after = bodies.angular_momentum + np.cross(bodies.centre, bodies.mass * bodies.velocity)
    size = 4.0 * bodies.mass[0, 0]
    assert np.abs((bodies.mass * bodies.velocity).sum(axis=0)).max() < 1e-12 * size
    assert np.abs((after - spin).sum(axis=0)).max() < 1e-12 * size
    assert bodies.kinetic_energy().sum() == pytest.approx(begun, rel=1e-8)


STACK = """
[walls.floor]
shape.box = { lower = [-1.0, -0.2], upper = [2.0, 0.0] }
[bodies.low]
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.3] }
density = 2000.0
[bodies.middle]
shape.box = { lower = [0.1, 0.35], upper = [0.5, 0.6] }
density = 8000.0
[bodies.high]
shape.polygon.points = [[0.1, 0.7], [0.55, 0.75], [0.3, 1.1]]
density = 700.0
"""


def test_a_stack_comes_to_rest(tmp_path):
    text = FLAT.format(dx=0.05, friction=0.4, restitution=0.2) + STACK
    bodies = Dry(draft(tmp_path, text), dt=4e-3).to(1.5)
    low, middle, high = (
        [one.name for one in bodies.bodies].index(name) for name in ("low", "middle", "high")
    )
    assert np.abs(bodies.velocity).max() < 1e-6 and np.abs(bodies.angle[[low, middle]]).max() < 1e-3
    assert bodies.place[[low, middle], 1] == pytest.approx([0.15, 0.425], abs=1e-3)
    # The floor bears the weight of all, and each body what lies on it.
    assert bodies.pressing[:, 1] == pytest.approx(-bodies.weight[:, 1], rel=1e-3)
    assert abs(bodies.angle[high]) > 0.1  # it lies on a side now


PERIODIC = """
[bodies.one]
shape.box = { lower = [0.6, 0.0], upper = [0.8, 0.2] }
density = 2000.0
velocity = [1.0, 0.0]
[bodies.other]
shape.box = { lower = [0.1, 0.0], upper = [0.3, 0.2] }
density = 2000.0
free = []
"""


@pytest.mark.parametrize("speed", ["1.0", "-1.0"])
def test_bodies_meet_across_the_seam_of_a_period(tmp_path, speed):
    text = FLAT.format(dx=0.05, friction=0.0, restitution=0.5).replace("-9.81", "0.0")
    text = text.replace(
        "spacing = 0.05", "spacing = 0.05\nperiodic = ['x']\nlower = [0.0, -0.5]\nupper = [1.0, 4.0]"
    )
    text = text.replace("[-3.0, 3.0]", "[0.1, 3.0]").replace("[-2.8, 3.2]", "[0.3, 3.2]")
    dry = Dry(draft(tmp_path, text + PERIODIC.replace("[1.0, 0.0]", f"[{speed}, 0.0]")), dt=1e-3)
    [one] = (row for row, body in enumerate(dry.bodies.bodies) if body.name == "one")
    dry.to(0.4)
    moved = dry.bodies.place[one, 0] - dry.bodies.reference[one, 0]
    assert moved == pytest.approx(0.25 * float(speed), abs=2e-3)
    assert dry.bodies.velocity[one, 0] == pytest.approx(-0.5 * float(speed))


def test_a_cube_slides_turns_and_comes_to_rest_on_a_floor(tmp_path):
    dry = Dry(draft(tmp_path, SOLID), dt=4e-3)
    bodies = dry.to(0.2)
    before = bodies.velocity[0, :2].copy()
    dry.to(0.24)
    # While it slides and turns friction takes less than mu g of its speed, and never speeds it up.
    lost = np.linalg.norm(before) - np.linalg.norm(bodies.velocity[0, :2])
    assert 0.0 < lost < 0.7 * 9.81 * 0.04 * 1.02
    # Nor than the weight gives in all, impacts counted: points that let go kept their friction.
    assert 0.8 < (math.sqrt(5.0) - np.linalg.norm(bodies.velocity[0, :2])) / (0.7 * 9.81 * 0.24) < 1.0
    dry.to(1.0)
    assert np.abs(bodies.velocity).max() < 1e-6 and np.abs(bodies.spin).max() < 1e-6
    assert bodies.place[0, 2] - bodies.reference[0, 2] == pytest.approx(-0.02, abs=2e-4)


DRIVEN = """
[walls.post]
shape.box = { lower = [0.6, -0.5], upper = [1.0, 1.0] }
[bodies.ram]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.4] }
density = 2000.0
free = []
motion.translation = [1.0, 0.0]
"""


def test_what_is_forced_into_another_is_told(tmp_path):
    dry = Dry(draft(tmp_path, FLAT.format(dx=0.05, friction=0.0, restitution=0.0) + DRIVEN))
    told = [dry.floating.contacts.deepest(dry.to(time)) for time in (0.09, 0.2)]
    assert told[0].depth == 0.0
    assert told[1].depth == pytest.approx(0.1, abs=1e-9) and told[1].other == "walls.post"


SLIDER = """
[bodies.block]
shape.box = { lower = [1.5, 0.0], upper = [1.7, 0.2] }
density = 1000.0
velocity = [1.0, 0.0]
"""


@pytest.mark.parametrize("degrees", [0.0, 25.0])
def test_a_floor_in_two_parts_has_no_edge_where_they_meet(tmp_path, degrees):
    """A block met the end of the second part, under the floor, and turned back."""
    two = [(-1.0, 1.9), (1.9, 9.0)]
    boxes = [turned(-degrees, [(a, -0.3), (b, -0.3), (b, 0.0), (a, 0.0)]) for a, b in two]
    floor = "".join(f"[walls.floor{n}]\nshape.polygon.points = {box}\n" for n, box in enumerate(boxes))
    way = turned(-degrees, [(1.0, 0.0)])[0]
    moving = turned(-degrees, [(1.5, 0.0), (1.7, 0.0), (1.7, 0.2), (1.5, 0.2)])
    body = SLIDER.replace("box = { lower = [1.5, 0.0], upper = [1.7, 0.2] }", f"polygon.points = {moving}")
    text = FLAT.format(dx=0.05, friction=0.0, restitution=0.0) + floor
    bodies = Dry(draft(tmp_path, text + body.replace("[1.0, 0.0]", f"{way}"))).to(0.6)
    pull = 9.81 * math.sin(math.radians(degrees))
    assert (bodies.place - bodies.reference)[0, :2] @ way == pytest.approx(0.6 + 0.18 * pull, rel=1e-3)
    assert bodies.velocity[0, :2] @ way == pytest.approx(1.0 + 0.6 * pull, rel=1e-3)


def test_a_floor_that_repeats_has_no_edge_at_the_seam(tmp_path):
    """The block met the end of the floor's next image."""
    text = FLAT.format(dx=0.05, friction=0.0, restitution=0.0)
    seam = 'spacing = 0.05\nperiodic = ["x"]\nlower = [0.0, -0.3]\nupper = [2.0, 3.3]'
    text = text.replace("spacing = 0.05", seam).replace("[-3.0, 3.0]", "[0.1, 3.0]").replace("-2.8", "0.3")
    bodies = Dry(draft(tmp_path, text + parts(0.0, 2.0) + SLIDER)).to(0.6)
    assert (bodies.place - bodies.reference)[0, 0] == pytest.approx(0.6, abs=1e-6)


@pytest.mark.parametrize("upper", [1.0, 0.1])
def test_a_wall_that_stands_on_such_a_floor_still_stops(tmp_path, upper):
    """And a step in it."""
    post = f"[walls.post.shape.box]\nlower = [2.1, 0.0]\nupper = [2.4, {upper}]\n"
    text = FLAT.format(dx=0.05, friction=0.0, restitution=0.0)
    bodies = Dry(draft(tmp_path, text + parts(0.0, 1.9, 3.0) + post + SLIDER)).to(0.6)
    assert (bodies.place - bodies.reference)[0, 0] == pytest.approx(0.4, abs=2e-2)
    assert bodies.velocity[0, 0] < 0.05


def test_a_cube_slides_over_the_joint_of_a_floor_in_3d(tmp_path):
    text = SOLID.replace("friction = 0.7", "friction = 0.0").replace("0.02]", "0.0]").replace("0.42]", "0.4]")
    text = text.replace("spin = [0.0, 0.0, 3.0]", "").replace("y = [2.0, 1.0, 0.0]", "y = [1.0, 0.1, 0.0]")
    text = text.replace("upper = [2.0, 1.0, 0.0]", "upper = [0.5, 1.0, 0.0]").replace(
        "[bodies.cube]",
        "[walls.other]\nshape.box = { lower = [0.5, -1.0, -0.3], upper = [3.0, 1.0, 0.0] }\n[bodies.cube]",
    )
    bodies = Dry(draft(tmp_path, text)).to(1.0)
    assert bodies.velocity[0] == pytest.approx([1.0, 0.1, 0.0], abs=1e-6)
    assert np.abs(bodies.spin).max() < 1e-6


TANKS = {
    "box": "{ box = { lower = [0.0, 0.0], upper = [1.0, 0.6] } }",
    "polygon": "{ polygon = { points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.6], [0.5, 0.7], [0.0, 0.6]] } }",
    "two": "{ box = { lower = [0.0, 0.0], upper = [0.9, 0.6] } },"
    "{ box = { lower = [0.0, 0.0], upper = [1.0, 0.6] } }",
}
RIM = """
[walls.tank.shape.difference]
from.box = { lower = [-0.3, -0.3], upper = [1.3, 0.6] }
"""
DISC = """
[bodies.disc]
shape.disc = { center = [0.5, 0.9], radius = 0.2 }
density = 2500.0
"""


@pytest.mark.parametrize("taken", TANKS)
def test_a_tank_is_open_where_what_is_taken_out_ends_with_it(tmp_path, taken):
    """The control: one whose opening is drawn lower than its rim has a lid, on which the disc lands."""
    flat = FLAT.format(dx=0.05, friction=0.0, restitution=0.0)
    found = []
    for minus in (TANKS[taken], TANKS["box"].replace("0.6", "0.5")):
        dry = Dry(draft(tmp_path, flat + RIM + f"minus = [{minus}]\n" + DISC), dt=1e-3)
        found.append([dry.to(time).place[0, 1] for time in (0.3, 1.0)])
    assert found[0] == pytest.approx([0.9 - 0.5 * 9.81 * 0.09, 0.2], abs=3e-3)
    assert found[1] == pytest.approx([0.8, 0.8], abs=1e-3)


def test_before_a_rim_the_distance_is_that_of_its_edge(tmp_path):
    flat = FLAT.format(dx=0.05, friction=0.0, restitution=0.0)
    case = draft(tmp_path, flat + RIM + f"minus = [{TANKS['box']}]\n" + DISC)
    found = faces_of(
        case.walls["tank"].shape, np.array([[0.03, 0.64], [0.5, 0.55], [1.31, 0.3], [-0.1, 0.3]])
    )
    assert found.away == pytest.approx([0.05, 0.5, 0.01, -0.1])
    assert found.normal[0] == pytest.approx([0.6, 0.8]) and found.normal[2] == pytest.approx([1.0, 0.0])


def test_a_body_does_not_meet_the_plane_that_cuts_it(tmp_path):
    plane = 'symmetry = ["x.lower"]\nlower = [0.0, -1.0]\nupper = [3.0, 4.0]\n[time]'
    text = FLAT.format(dx=0.05, friction=0.3, restitution=0.0).replace("[time]", plane)
    text = text.replace("[-3.0, 3.0]", "[2.0, 3.0]").replace("[-2.8, 3.2]", "[2.2, 3.2]")
    dry = Dry(draft(tmp_path, text + DISC.replace("[0.5, 0.9]", "[0.0, 0.9]") + 'free = ["y"]\n'), dt=1e-3)
    assert dry.to(0.3).place[0, 1] == pytest.approx(0.9 - 0.5 * 9.81 * 0.09, abs=3e-3)
    assert dry.floating.contacts.deepest(dry.bodies).depth == 0.0
