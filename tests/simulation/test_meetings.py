"""Which points of rigid bodies and walls meet which faces: no edge where faces go on, and corners everywhere."""

import numpy as np
import pytest
from drafts import draft
from dry import FLAT, SOLID, Dry, parts, turned
from scene.solids import cube, shape_of

from psph.case.shapes import Shape
from psph.scene.distance import corners_of

FALLEN = 1e-6
"""Speed that an impact without restitution may leave, m/s; a step falls 0.02."""

SMOOTH = FLAT.format(dx=0.05, friction=0.0, restitution=0.0)


def box(name, lower, upper, more=""):
    return f"[{name}]\nshape.box = {{ lower = {[*lower]}, upper = {[*upper]} }}\n{more}\n"


def block(lower, upper, speed=1.0, name="block", more=""):
    return box(f"bodies.{name}", lower, upper, f"density = 1000.0\nvelocity = [{speed}, 0.0]\n{more}")


def row(dry, name="block"):
    return [one.name for one in dry.bodies.bodies].index(name)


SIDE_BY_SIDE = {
    "bodies": block((0.0, 0.0), (0.5, 0.2), 0.0, "p").replace("1000.0", "5000.0")
    + block((0.5, 0.0), (1.0, 0.2), 0.0, "q").replace("1000.0", "7000.0")
    + parts(-0.5, 0.5, 3.0),
    "a wall that moves": parts(-0.5, 0.5, bottom=0.0, height=0.2)
    + box("walls.other", (0.5, 0.0), (3.0, 0.2), "motion.translation = { velocity = [0.0, 0.0] }"),
    "a body and a wall": block((0.0, 0.0), (0.5, 0.2), 0.0, "p", "free = []").replace(
        "velocity = [0.0, 0.0]\n", ""
    )
    + box("walls.other", (0.5, 0.0), (3.0, 0.2)),
}


@pytest.mark.parametrize("floor", SIDE_BY_SIDE)
def test_things_side_by_side_have_no_edge_where_they_meet(tmp_path, floor):
    """The block met the end of the second, below its face, and kept 0.05 to 0.13 m/s."""
    dry = Dry(draft(tmp_path, SMOOTH + SIDE_BY_SIDE[floor] + block((0.34, 0.2), (0.49, 0.35))))
    bodies, own = dry.to(0.2), row(dry)
    assert bodies.velocity[own, :2] == pytest.approx([1.0, 0.0], abs=1e-6)
    assert (bodies.place - bodies.reference)[own, :2] == pytest.approx([0.2, 0.0], abs=1e-6)


def test_a_block_slides_back_onto_the_table(tmp_path):
    """The points of its foot beyond the end of the table met that end."""
    text = SMOOTH + box("walls.table", (-1.0, -0.3), (0.48, 0.0)) + block((0.35, 0.0), (0.55, 0.2), -1.0)
    bodies = Dry(draft(tmp_path, text)).to(0.2)
    assert bodies.velocity[0] == pytest.approx([-1.0, 0.0, 0.0], abs=1e-6)
    assert abs(bodies.spin[0, 2]) < 1e-6


@pytest.mark.parametrize("dx", [0.05, 0.025])
def test_a_block_stops_at_a_step_of_half_its_height(tmp_path, dx):
    """It met the step with the next of its own points, and pitched: -0.035 and +0.008 m/s were left."""
    text = FLAT.format(dx=dx, friction=0.0, restitution=0.0) + parts(-0.5, 0.5)
    text += box("walls.step", (0.5, -0.3), (1.0, 0.1)) + block((0.25, 0.0), (0.45, 0.2), 1.01)
    bodies = Dry(draft(tmp_path, text)).to(0.2)
    assert np.abs(bodies.velocity[0]).max() < FALLEN
    assert abs(bodies.spin[0, 2]) < 1e-6 and bodies.place[0, 1] == pytest.approx(0.1, abs=1e-4)


SPIKE = "[walls.spike]\nshape.polygon.points = [[0.13, -1.0], [0.17, -1.0], [0.15, 0.0]]\n"


def test_a_block_rests_on_a_spike_between_its_points(tmp_path):
    """The spike ran half a metre into it."""
    text = FLAT.format(dx=0.1, friction=0.0, restitution=0.0) + SPIKE
    bodies = Dry(draft(tmp_path, text + block((0.0, 0.02), (0.3, 0.3), 0.0))).to(0.4)
    assert bodies.place[0, 1] - bodies.reference[0, 1] == pytest.approx(-0.02, abs=1e-3)


def test_a_spike_that_is_forced_into_a_block_is_told(tmp_path):
    forced = box("bodies.block", (0.0, 0.02), (0.3, 0.32), "density = 1000.0\nfree = []")
    text = FLAT.format(dx=0.1, friction=0.0, restitution=0.0) + SPIKE + forced
    dry = Dry(draft(tmp_path, text + "motion.translation = [0.0, -0.5]\n"))
    told = dry.floating.contacts.deepest(dry.to(0.2))
    assert told.depth == pytest.approx(0.08, abs=1e-9) and told.other == "walls.spike"


def test_a_disc_of_a_wall_meets_a_face_between_its_points(tmp_path):
    round_one = "[walls.ball]\nshape.disc = { center = [0.15, -0.05], radius = 0.05 }\n"
    text = FLAT.format(dx=0.1, friction=0.0, restitution=0.0) + round_one
    bodies = Dry(draft(tmp_path, text + block((0.0, 0.02), (0.3, 0.32), 0.0))).to(0.2)
    assert bodies.place[0, 1] - bodies.reference[0, 1] == pytest.approx(-0.02, abs=1e-4)


def test_a_tilted_block_stands_in_the_corner_of_two_walls(tmp_path):
    """Both stay walls to a corner that is where their own corners are."""
    tilted = turned(30.0, [(0.0, 0.0), (0.2, 0.0), (0.2, 0.2), (0.0, 0.2)], about=(0.75, 0.0))
    body = f"[bodies.block]\nshape.polygon.points = {tilted}\ndensity = 1000.0\n"
    wall = box("walls.side", (0.9, -0.3), (1.2, 1.0))
    dry = Dry(draft(tmp_path, SMOOTH + parts(-1.0, 0.9) + wall + body))
    bodies = dry.to(0.6)
    assert dry.floating.contacts.deepest(bodies).depth < 1e-3
    assert abs(bodies.spin[0, 2]) < 1e-3 and np.abs(bodies.velocity[0]).max() < 0.02


def test_a_cube_stops_at_the_edge_of_a_step_in_3d(tmp_path):
    """The corners of the step are far from it."""
    text = SOLID.replace("friction = 0.7", "friction = 0.0").replace("0.02]", "0.0]").replace("0.42]", "0.4]")
    text = text.replace("spin = [0.0, 0.0, 3.0]", "").replace("y = [2.0, 1.0, 0.0]", "y = [1.01, 0.0, 0.0]")
    text += box("walls.step", (0.5, -1.0, -0.3), (2.0, 1.0, 0.23))
    bodies = Dry(draft(tmp_path, text)).to(0.2)
    assert np.abs(bodies.velocity).max() < FALLEN and np.abs(bodies.spin).max() < 1e-6


def test_corners_and_edges_of_boxes_and_meshes(tmp_path):
    """A round face in pieces has none."""
    import trimesh

    drawn = Shape.model_validate({"box": {"lower": [0.0] * 3, "upper": [1.0] * 3}})
    for shape in (drawn, shape_of(tmp_path, cube())):
        found = corners_of(shape, 0.26)
        ends = np.isclose(found, 0.0, atol=1e-6) | np.isclose(found, 1.0, atol=1e-6)
        assert len(found) == 8 + 12 * 3 and (np.count_nonzero(ends, axis=1) >= 2).all()
        assert len(np.unique(np.round(found, 6), axis=0)) == len(found)
    assert not len(corners_of(shape_of(tmp_path, trimesh.creation.icosphere(subdivisions=3)), 0.1))
