"""Points in the bodies and shells of geometry files."""

import time

import numpy as np
import pytest
import trimesh
from scene.solids import cube, held, lattice, mesh_of, points_of, shape_at, shape_of, winding

from psph.case.shapes import Shape
from psph.scene.meshes.mass import enclosed_by
from psph.scene.meshes.surface import MeshError, surface_of
from psph.scene.shapes import bounds, inside

GRID = lattice(-1.5, 1.5, 24)


def ball(subdivisions=3, radius=1.0):
    return trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)


def turned_face(body, which):
    faces = body.faces.copy()
    faces[which] = faces[which][..., ::-1]
    return trimesh.Trimesh(body.vertices, faces, process=False)


def without(body, which):
    return trimesh.Trimesh(body.vertices, np.delete(body.faces, which, axis=0), process=False)


# Filled bodies


@pytest.mark.parametrize("low", [0.0, -0.7, 0.1])
@pytest.mark.parametrize("ending", ["stl", "obj", "ply"])
def test_a_cube_on_the_sites_keeps_the_low_side_as_a_box_does(tmp_path, low, ending):
    """Sites on its faces, edges and corners: those of the three low faces belong to it."""
    x = low + 0.2 * np.arange(-2, 8)
    grid = [x.reshape(-1, 1, 1), x.reshape(-1, 1), x]
    found = held(shape_of(tmp_path, cube(low, low + 1.0), ending), grid)
    box = Shape.model_validate({"box": {"lower": [low] * 3, "upper": [low + 1.0] * 3}})
    assert found.sum() == 5**3
    assert np.array_equal(found, inside(box, grid, 1e-6 * 0.2))


def test_points_on_slanted_faces_belong_to_one_of_two_bodies(tmp_path):
    """A cube cut along its diagonals, all of whose cuts hold sites: no site in two parts, none in none."""
    x = 0.1 * np.arange(11)
    grid = [x.reshape(-1, 1, 1), x.reshape(-1, 1), x]
    corners = np.array(list(np.ndindex(2, 2, 2)), float)
    total = np.zeros((11, 11, 11), int)
    for part, order in enumerate(((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0))):
        walk = np.cumsum([np.zeros(3), *np.eye(3)[list(order)]], axis=0)  # a tetrahedron of Kuhn's
        body = trimesh.Trimesh(walk, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]], process=False)
        (tmp_path / str(part)).mkdir()
        total += held(shape_of(tmp_path / str(part), body), grid)
    assert len(corners) == 8 and total.max() == 1
    assert np.array_equal(total == 1, held(shape_of(tmp_path, cube()), grid))


def test_sites_on_a_face_that_was_turned_belong_to_one_side_of_it(tmp_path):
    """A box turned by 20° and 25° lies on the long side of a prism: rounding puts no site of that face in both or none."""
    x = 0.1 * np.arange(1, 10)
    diagonal = [x.reshape(-1, 1) + 0.3, x.reshape(-1, 1) + 0.3, 0.1 * np.arange(1, 10)]
    prism = trimesh.creation.extrude_triangulation([[0, 0], [1, 0], [1, 1]], [[0, 1, 2]], 1.0)
    box = trimesh.creation.box(bounds=[[0, 0, 0], [2.0, 0.5, 1.0]])
    turn = [{"axis": [0.0, 0.0, 1.0], "degrees": angle} for angle in (20.0, 25.0)]
    (tmp_path / "box").mkdir()
    one = held(shape_of(tmp_path, prism, move=[0.3, 0.3, 0.0]), diagonal)
    other = held(shape_of(tmp_path / "box", box, rotate=turn, move=[0.3, 0.3, 0.0]), diagonal)
    assert (one ^ other).all() and (one == one[0, 0]).all()


def test_a_turned_and_moved_box_is_the_half_spaces_of_its_faces(tmp_path):
    """Scaled, then turned about z and x, then moved; against six exact inequalities."""
    half, move = np.array([0.9, 0.5, 0.3]), np.array([0.11, -0.23, 0.07])
    body = trimesh.creation.box(extents=2000.0 * half)
    turns = [{"axis": [0.0, 0.0, 2.0], "degrees": 30.0}, {"axis": [1.0, 0.0, 0.0], "degrees": 50.0}]
    found = held(shape_of(tmp_path, body, scale=0.001, rotate=turns, move=move.tolist()), GRID)
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    about_z = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = np.cos(np.radians(50.0)), np.sin(np.radians(50.0))
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    own = (points_of(GRID) - move) @ (about_x @ about_z)
    assert np.array_equal(found.ravel(), (np.abs(own) < half).all(axis=1))
    assert 0 < found.sum() < found.size


def test_the_volume_of_a_sphere(tmp_path):
    body = ball(4)
    found = held(shape_of(tmp_path, body), lattice(-1.0, 1.0, 60))
    assert found.sum() / 30.0**3 == pytest.approx(body.volume, rel=2e-3)
    assert surface_of(mesh_of(tmp_path, body)).volume == pytest.approx(body.volume, rel=1e-6)


def test_a_torus_has_a_hole_in_its_middle(tmp_path):
    body = trimesh.creation.torus(1.0, 0.4)
    found = held(shape_of(tmp_path, body), GRID).ravel()
    x, y, z = points_of(GRID).T
    away = np.hypot(np.hypot(x, y) - 1.0, z)
    assert found[away < 0.38].all() and not found[away > 0.4].any()


@pytest.mark.parametrize(
    "body", [ball(2), trimesh.creation.torus(1.0, 0.4, 12, 8), cube(-0.8, 0.9)], ids="sto"
)
def test_as_the_winding_number_says(body, tmp_path):
    """An independent sum of solid angles; sites nearer to a face than 1e-6 would be left out, there are none."""
    number = winding(points_of(GRID), body.triangles)
    assert np.abs(number - np.rint(number)).max() < 1e-6
    assert np.array_equal(held(shape_of(tmp_path, body), GRID).ravel(), number > 0.5)


def test_a_small_hole_is_closed_as_the_winding_number_closes_it(tmp_path):
    """Two holes opposite each other, so that the lines through both meet no triangle."""
    body = ball(2)
    middle = body.triangles_center
    poles = np.argsort(np.hypot(middle[:, 0], middle[:, 1]))[:4]
    body = without(body, poles)
    shape = shape_of(tmp_path, body)
    assert surface_of(shape.form).body.open_edges > 3
    grid = lattice(-1.5, 1.5, 30)
    number = winding(points_of(grid), body.triangles)
    found = held(shape, grid).ravel()
    assert (number[found != (number > 0.5)] > 0.4).all() and (number[found != (number > 0.5)] < 0.6).all()
    assert np.count_nonzero(found != (number > 0.5)) <= 2  # beside a hole that is not quite flat
    through = np.hypot(*points_of(grid)[:, :2].T) < 0.08
    assert found[through].sum() > 50


@pytest.mark.parametrize("which", [[5], [5, 6, 7, 60, 61, 200], slice(0, 90)])
def test_turned_faces_do_no_harm(which, tmp_path):
    body = ball(2)
    shape = shape_of(tmp_path, turned_face(body, which))
    assert surface_of(shape.form).body.turned == len(np.arange(len(body.faces))[which])
    assert np.array_equal(held(shape, GRID), held(shape_of(tmp_path, body), GRID))


def test_a_body_turned_inside_out_is_the_same(tmp_path):
    body = ball(2)
    shape = shape_of(tmp_path, turned_face(body, slice(None)))
    assert np.array_equal(held(shape, GRID), held(shape_of(tmp_path, body), GRID))
    assert surface_of(shape.form).volume > 0.0


def test_a_part_turned_inside_out_beside_another_is_filled(tmp_path):
    one, other = ball(2, 0.7), turned_face(ball(2, 0.4), slice(None))
    grid, apart = points_of(GRID).T, [1.1, 0.0, 0.0]
    other.apply_translation(apart)
    meant = held(shape_of(tmp_path, one), grid) | held(shape_of(tmp_path, ball(2, 0.4), move=apart), grid)
    assert np.array_equal(held(shape_of(tmp_path, trimesh.util.concatenate([one, other])), grid), meant)


def test_parts_that_overlap_are_joined_and_an_inner_surface_is_a_room(tmp_path):
    one, other = ball(2), ball(2)
    other.apply_translation([0.5, 0.0, 0.0])
    room = turned_face(ball(2, 0.6), slice(None))
    grid = points_of(GRID).T
    in_one, in_other = (held(shape_of(tmp_path, body), grid) for body in (one, other))
    joined = held(shape_of(tmp_path, trimesh.util.concatenate([one, other])), grid)
    assert (in_one & in_other).any() and np.array_equal(joined, in_one | in_other)
    hollow = held(shape_of(tmp_path, trimesh.util.concatenate([one, room])), grid)
    inner = held(shape_of(tmp_path, ball(2, 0.6)), grid)
    assert inner.any() and np.array_equal(hollow, in_one & ~inner)


def test_an_edge_of_four_faces(tmp_path):
    """Two cubes that share an edge alone: not a manifold, and no trouble."""
    both = trimesh.util.concatenate([cube(), trimesh.creation.box(bounds=[[-1, -1, 0], [0, 0, 1]])])
    shape = shape_of(tmp_path, both)
    x, y, z = points_of(GRID).T
    meant = (z > 0) & (z < 1) & (np.abs(x) < 1) & (np.abs(y) < 1) & ((x > 0) == (y > 0))
    assert surface_of(shape.form).body.open_edges == 0
    assert np.array_equal(held(shape, GRID).ravel(), meant)


# The same whoever asks, and however


@pytest.mark.parametrize("keys", [{}, {"shell": 0.2}, {"shell": 0.2, "side": "outside"}])
def test_the_same_in_any_chunk_and_for_points_one_by_one(tmp_path, keys):
    shape = shape_of(tmp_path, without(ball(3), [3, 4]), **keys)
    whole = held(shape, GRID)
    assert whole.any() and not whole.all()
    x, y, z = GRID
    assert np.array_equal(np.concatenate([held(shape, [x[k : k + 1], y, z]) for k in range(24)]), whole)
    assert np.array_equal(
        np.concatenate([held(shape, [x, y, z[k : k + 5]]) for k in range(0, 24, 5)], 2), whole
    )
    turned = [x.reshape(-1), y.reshape(1, -1, 1), z.reshape(-1, 1, 1)]  # the slowest axis is z
    assert np.array_equal(held(shape, turned), whole.transpose(2, 1, 0))
    points = points_of(GRID).T
    assert np.array_equal(held(shape, points), whole.ravel())
    assert np.array_equal(held(shape, points[:, ::-1]), whole.ravel()[::-1])
    assert held(shape, points[:, :0]).shape == (0,)
    assert bool(held(shape, [np.array(0.0), np.array(0.0), np.array(0.9)])) == (keys.get("side") is None)


@pytest.mark.parametrize("keys", [{}, {"shell": 0.2}])
def test_the_order_of_triangles_and_corners_does_not_matter(tmp_path, keys):
    body, random = without(ball(3), [3, 4, 50]), np.random.default_rng(0)
    first = held(shape_of(tmp_path, body, **keys), GRID)
    corners = body.triangles[random.permutation(len(body.faces))]
    corners = np.stack([np.roll(t, k, axis=0) for t, k in zip(corners, random.integers(0, 3, len(corners)))])
    (tmp_path / "other").mkdir()
    assert np.array_equal(held(shape_of(tmp_path / "other", corners, **keys), GRID), first)


def test_of_two_faces_that_disagree_the_same_one_counts_in_any_order(tmp_path):
    sheet = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [0, 1, 0], [1, 1, 0]]], float)
    found = []
    for k, corners in enumerate((sheet, sheet[::-1])):
        (tmp_path / str(k)).mkdir()
        found.append(held(shape_of(tmp_path / str(k), corners, shell=0.2), GRID))
    assert found[0].any() and np.array_equal(*found)


def test_a_file_is_read_once(tmp_path, monkeypatch):
    shape = shape_of(tmp_path, ball(2))
    first = held(shape, GRID)
    (tmp_path / "body.stl").unlink()
    assert np.array_equal(held(shape, GRID), first)


@pytest.mark.parametrize("ending", ["stl", "obj", "ply"])
def test_all_formats_say_the_same(tmp_path, ending):
    body = ball(2)
    meant = held(shape_of(tmp_path, body), GRID)
    assert np.array_equal(held(shape_of(tmp_path, body, ending), GRID), meant)
    assert np.array_equal(held(shape_of(tmp_path, body, ascii=True), GRID), meant)


def test_quads_of_an_obj_and_corners_that_differ_by_rounding(tmp_path):
    path = tmp_path / "body.obj"
    lines = [f"v {x} {y} {z}" for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
    path.write_text("\n".join([*lines, *(f"f {a} {b} {c} {d}" for a, b, c, d in faces)]))
    surface = surface_of(shape_at(path).form)
    assert len(surface.sheet.faces) == 12 and surface.body.open_edges == 0
    corners = cube().triangles + np.random.default_rng(1).uniform(-2e-7, 2e-7, (12, 3, 3))
    surface = surface_of(mesh_of(tmp_path, corners))
    assert surface.body.open_edges == 0 and surface.volume == pytest.approx(1.0, abs=1e-5)


# Shells


def test_a_shell_of_a_sphere(tmp_path):
    body, grid = ball(4), lattice(-1.5, 1.5, 60)
    away = np.linalg.norm(points_of(grid), axis=1)
    for side, low, high in (("inside", 0.8, 0.997), ("outside", 1.0, 1.197)):
        found = held(shape_of(tmp_path, body, shell=0.2, side=side), grid).ravel()
        assert found[(away > low) & (away < high)].all()
        assert not found[(away < low - 0.003) | (away > high + 0.003)].any()


def test_the_shell_of_a_spike_with_many_narrow_faces_on_one_side(tmp_path):
    """Beyond its tip a normal that is not weighted by angles would point to that side alone."""
    base = [[-0.2, -0.2, 0], [-0.2, 0.2, 0], *([0.2, y, 0] for y in np.linspace(0.2, -0.2, 41))]
    corners, n = np.array([*base, [0, 0, 1], [0, 0, 0]]), len(base)
    rim = [(k, (k + 1) % n) for k in range(n)]
    faces = [(b, a, n) for a, b in rim] + [(a, b, n + 1) for a, b in rim]
    body = trimesh.Trimesh(corners, faces, process=False)
    assert body.volume > 0.0
    grid = lattice(-0.3, 0.3, 30)
    grid[2] = grid[2] + 1.0
    full = held(shape_of(tmp_path, body), grid)
    inner, outer = (held(shape_of(tmp_path, body, shell=0.25, side=s), grid) for s in ("inside", "outside"))
    away = np.linalg.norm(points_of(grid) - [0.0, 0.0, 1.0], axis=1).reshape(full.shape)
    assert full.any() and np.array_equal(inner, full)
    assert outer[(away < 0.25) & ~full].all() and not (outer & full).any()


def test_the_shell_of_a_cube_follows_the_rule_of_boxes(tmp_path):
    """Three sites thick on every side, with sites on all faces."""
    x = 0.1 * np.arange(-5, 16)
    grid = [x.reshape(-1, 1, 1), x.reshape(-1, 1), x]
    found = held(shape_of(tmp_path, cube(), shell=0.3), grid)
    ends = ({"lower": [0.0] * 3, "upper": [1.0] * 3}, {"lower": [0.3] * 3, "upper": [0.7] * 3})
    boxes = [inside(Shape.model_validate({"box": box}), grid, 1e-7) for box in ends]
    assert np.array_equal(found, boxes[0] & ~boxes[1])


def test_a_sheet_has_its_shell_behind_it_and_ends_where_it_ends(tmp_path):
    """Two rectangles at a right angle, normals up and towards +x: behind a convex edge nothing is missing."""
    corners = np.array([[0, -1, 0], [0, 1, 0], [-1, 1, 0], [-1, -1, 0], [0, 1, -1], [0, -1, -1]], float)
    body = trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3], [1, 0, 5], [1, 5, 4]], process=False)
    found = held(shape_of(tmp_path, body, shell=0.25), GRID).ravel()
    x, y, z = points_of(GRID).T
    meant = (np.abs(y) < 1) & (x < 0) & (x > -1) & (z < 0) & (z > -1) & ((x > -0.25) | (z > -0.25))
    assert np.array_equal(found, meant)
    other = held(shape_of(tmp_path, body, shell=0.25, side="outside"), GRID).ravel()
    near = np.hypot(np.maximum(x, 0.0), np.maximum(z, 0.0)) < 0.25
    assert np.array_equal(other, (np.abs(y) < 1) & ((x > 0) | (z > 0)) & near & (x > -1) & (z > -1))


def test_a_sheet_encloses_nothing(tmp_path):
    body = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    with pytest.raises(MeshError, match="encloses nothing: 4 open edges around 1 hole as.* give shell"):
        held(shape_of(tmp_path, body), GRID)


def test_bounds(tmp_path):
    body, near = cube(), 1e-5
    for keys, more in (({}, 0.0), ({"shell": 0.2}, 0.0), ({"shell": 0.2, "side": "outside"}, 0.2)):
        lower, upper = bounds(shape_of(tmp_path, body, move=[1.0, 2.0, 3.0], **keys))
        assert lower == pytest.approx(np.array([1.0, 2.0, 3.0]) - more, abs=near)
        assert upper == pytest.approx(np.array([2.0, 3.0, 4.0]) + more, abs=near)
    assert bounds(shape_of(tmp_path, without(body, 0), shell=0.2))[0] == pytest.approx([-0.2] * 3, abs=near)


# Mass, and speed


def test_volume_centre_and_inertia_of_a_box(tmp_path):
    """Against the formulas of a box, turned and moved; the shell of a body has the body's."""
    sides, move = np.array([1.0, 2.0, 3.0]), [0.5, -1.0, 2.0]
    body = trimesh.creation.box(extents=1000.0 * sides)
    quarter = [{"axis": [0.0, 0.0, 1.0], "degrees": 90.0}]
    for keys in ({}, {"shell": 0.1}):
        found = enclosed_by(mesh_of(tmp_path, body, scale=0.001, rotate=quarter, move=move, **keys))
        a, b, c = 2.0, 1.0, 3.0
        assert found.volume == pytest.approx(6.0, rel=1e-6)
        assert found.center == pytest.approx(move, abs=1e-6)
        inertia = 0.5 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
        assert found.inertia == pytest.approx(np.diag(inertia), rel=1e-6, abs=1e-5)


@pytest.mark.alone
def test_a_million_sites_and_eighty_thousand_triangles_in_seconds(tmp_path):
    shape, grid = shape_of(tmp_path, ball(6)), lattice(-1.0, 1.0, 100)
    held(shape_of(tmp_path, cube()), grid)  # compiles
    shape = shape_of(tmp_path, ball(6))
    begun = time.process_time()
    found = held(shape, grid)
    assert time.process_time() - begun < 5.0 and found.sum() / 50.0**3 == pytest.approx(4.18, abs=0.02)
