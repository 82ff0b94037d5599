"""Surfaces in 3D: of the shapes of walls, of bodies that moved, and of the fluid."""

import numpy as np
import pytest
import trimesh

from psph.case.shapes import Shape
from psph.output.pictures import carried
from psph.output.pictures.carried import carried_parts, hull, rigid
from psph.output.pictures.walls import encloses, inwards, surface
from psph.output.pictures.water import SurfaceSums, fluid_surface

FAR = np.full(3, -np.inf), np.full(3, np.inf)


def volume_of(faces):
    """What closed triangles enclose, by Gauss's theorem."""
    return np.einsum("na,na->", faces[:, 0], np.cross(faces[:, 1], faces[:, 2])) / 6


def box(lower, upper):
    return {"box": {"lower": lower, "upper": upper}}


BALL = {"ball": {"center": [0.5, 0.4, 0.3], "radius": 0.3}}
TUBE = {"cylinder": {"center": [0.5, 0.4, 0.3], "axis": "y", "radius": 0.2, "height": 0.6}}


@pytest.mark.parametrize(
    "shape, volume, accuracy",
    [
        (box([0, 0, 0], [1, 2, 3]), 6.0, 1e-9),
        (BALL, 4 / 3 * np.pi * 0.3**3, 0.01),
        (TUBE, np.pi * 0.04 * 0.6, 0.01),
        ({"union": [box([0, 0, 0], [1, 1, 1]), box([0.5, 0.3, 0.2], [1.5, 0.6, 0.9])]}, 1 + 0.105, 1e-9),
        ({"union": [box([0, 0, 0], [1, 1, 1]), box([1, 0, 0], [2, 1, 1])]}, 2.0, 1e-9),  # a common face
        (
            {
                "difference": {
                    "from": box([-0.1, -0.1, -0.1], [1.1, 1.1, 1]),
                    "minus": [box([0, 0, 0], [1, 1, 1])],
                }
            },
            1.44 * 1.1 - 1,
            1e-9,
        ),
        (
            {"difference": {"from": box([0, 0, 0], [1, 1, 1]), "minus": [BALL]}},
            1 - 4 / 3 * np.pi * 0.027,
            0.01,
        ),
        ({"difference": {"from": box([0, 0, 0], [1, 1, 0.3]), "minus": [TUBE]}}, 0.3 - np.pi * 0.012, 0.03),
    ],
)
def test_surface_encloses_the_volume_of_the_shape(shape, volume, accuracy):
    faces = surface(Shape.model_validate(shape), 0.02, *FAR)
    assert volume_of(faces) == pytest.approx(volume, rel=accuracy)


def test_what_is_round_has_no_seam():
    import pyvista

    for shape in (BALL, TUBE):
        faces = surface(Shape.model_validate(shape), 0.02, *FAR).reshape(-1, 3)
        hull = pyvista.PolyData.from_regular_faces(faces, np.arange(len(faces)).reshape(-1, 3)).clean()
        assert hull.n_open_edges == 0


def test_surface_ends_where_the_domain_does():
    faces = surface(
        Shape.model_validate(box([0, 0, 0], [1, 2, 3])), 0.1, np.array([0.5, -9, -9]), np.full(3, 9.0)
    )
    assert faces[..., 0].min() == 0.5 and faces[..., 0].max() == 1.0
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(6 + 2 * 0.5 * 2 + 2 * 0.5 * 3)  # no lid where it was cut


def test_triangles_of_a_file_are_cut_where_the_domain_ends(tmp_path):
    """A bar of two triangles on each side, as long as it: what the domain holds of them has its exact area."""
    trimesh.creation.box(bounds=[[0, 0, 0], [3, 1, 1]]).export(tmp_path / "bar.stl")
    shape = Shape.model_validate({"mesh": {"file": "bar.stl", "scale": 1.0}}, context=tmp_path)
    faces = surface(shape, 0.1, np.array([0.7, -9, -9]), np.array([2.0, 0.6, 9]))
    assert [faces[..., 0].min(), faces[..., 0].max(), faces[..., 1].max()] == pytest.approx([0.7, 2.0, 0.6])
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(1.3 * 1 + 2 * 1.3 * 0.6)


def test_the_outside_of_a_tank_is_left_out():
    tank = {"difference": {"from": box([-0.1] * 3, [1.1, 1.1, 1]), "minus": [box([0, 0, 0], [1, 1, 1])]}}
    shape = Shape.model_validate(tank)
    assert encloses(shape, np.array([0.0, 0.0, 0.0]), np.array([1.0, 1.0, 0.5]))
    assert not encloses(shape, np.array([0.0, 0.0, 0.0]), np.array([1.0, 1.0, 1.5]))
    inner = inwards(surface(shape, 0.1, *FAR), shape)
    assert (inner.min(), inner.max()) == (0.0, 1.0)
    assert volume_of(inner) == pytest.approx(-2 / 3)  # a third is missing: the top is open


def test_motion_without_deformation_is_found():
    rng = np.random.default_rng(2)
    before = rng.normal(size=(40, 3))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    found, shift = rigid(before, before @ turn.T + [1, 2, 3])
    assert found == pytest.approx(turn) and shift == pytest.approx([1, 2, 3])


def test_a_body_goes_where_its_particles_go(tank3d):
    import tomllib

    case = tomllib.loads(tank3d.case_text)
    tank, block = carried_parts(case, tank3d.frame(0), 0.1, tank3d.folder)
    assert (tank.around, block.around) == (True, False)
    assert np.array_equal(tank.at(tank3d.frame(2)), tank.faces)
    here, there = block.at(tank3d.frame(0)), block.at(tank3d.frame(2))
    assert volume_of(here) == pytest.approx(0.008) and volume_of(there) == pytest.approx(0.008)
    assert there.reshape(-1, 3).mean(axis=0) == pytest.approx([1.0, 0.3, 0.14])
    corner = np.array([0.1 * (np.cos(0.6) - np.sin(0.6)), 0.1 * (np.sin(0.6) + np.cos(0.6)), 0.1]) + [
        1.0,
        0.3,
        0.14,
    ]
    assert np.linalg.norm(there.reshape(-1, 3) - corner, axis=1).min() < 1e-12


def test_a_body_that_was_bent_gets_a_surface_around_its_particles(tank3d):
    import tomllib

    block = list(carried_parts(tomllib.loads(tank3d.case_text), tank3d.frame(0), 0.1, tank3d.folder))[1]
    frame = tank3d.frame(0)
    frame["position"][(frame["group"] == 3) & (frame["position"][:, 2] > 0.1)] += [0.1, 0, 0]
    bent = block.at(frame)
    assert bent[..., 0].max() > 1.05 and len(bent) > 100


def test_what_has_no_shape_gets_a_surface_around_its_particles(tank3d, monkeypatch):
    import tomllib

    monkeypatch.setattr(carried, "standing_of", lambda case: [])
    found = list(carried_parts(tomllib.loads(tank3d.case_text), tank3d.frame(0), 0.1, tank3d.folder))
    assert [body.group for body in found] == [2, 3]
    assert all(len(body.faces) > 100 for body in found)


def cube(count, spacing):
    return (np.stack(np.meshgrid(*[np.arange(count)] * 3), -1).reshape(-1, 3) + 0.5) * spacing


def test_the_sum_of_kernels_is_one_inside_and_keeps_the_volume():
    places = cube(12, 0.05)
    sums = SurfaceSums(places, 0.05)
    grid = sums.of()
    middle = tuple(np.round((0.3 - sums.origin) / sums.step).astype(int))
    assert grid[middle] == pytest.approx(1.0, abs=0.05)  # between the particles of a lattice
    assert grid.sum() * sums.step**3 == pytest.approx(0.6**3, rel=1e-4)


def test_surface_of_a_fluid_lies_at_its_particles():
    places = cube(12, 0.05)
    water = fluid_surface(places, 0.05, places[:, 2])
    assert water.bounds == pytest.approx([0, 0.6] * 3, abs=0.02)
    assert np.abs(water["values"] - water.points[:, 2]).max() < 0.05
    assert 0.6**3 < water.volume < 1.2 * 0.6**3


def test_a_drop_of_one_particle_is_seen_and_no_fluid_is_nothing():
    drop = fluid_surface(np.array([[1.0, 2.0, 3.0], [np.nan, 0, 0]]), 0.1)
    assert drop.center == pytest.approx([1, 2, 3], abs=0.03) and 0.05 < drop.length < 0.3
    assert fluid_surface(np.full((3, 3), np.nan), 0.1) is None
    assert hull(np.empty((0, 3)), 0.1).shape == (0, 3, 3)


def test_a_grid_of_many_nodes_is_made_coarser(monkeypatch):
    monkeypatch.setattr("psph.output.pictures.water.LARGEST", 5000)
    sums = SurfaceSums(cube(12, 0.05), 0.05)
    assert np.prod(sums.shape) < 10_000 and sums.of().shape == sums.shape
