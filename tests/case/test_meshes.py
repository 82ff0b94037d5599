"""The shape of a geometry file in a case: its keys, its file, and what is refused."""

import os

import pytest
from drafts import POOL, WATER, draft, refusal

FILE = "walls.post.shape.mesh.file"


@pytest.fixture(autouse=True)
def post(tmp_path):
    """A file of that name; what stands in it is nobody's concern yet."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/post.stl").write_bytes(b"nothing")


def with_keys(keys):
    """POOL with other keys in the wall's mesh."""
    head, _, tail = POOL.rpartition("move = [0.5, 0.3, 0.0]")
    return head + keys + tail


def test_what_a_mesh_says(tmp_path):
    keys = (
        "move = [1.0, 2.0, 3.0], rotate = [{ axis = [0, 0, 1], degrees = 90 }], shell = 0.3, side = 'outside'"
    )
    mesh = draft(tmp_path, with_keys(keys)).walls["post"].shape.form
    assert (mesh.file, mesh.scale, mesh.move) == ("parts/post.stl", 0.001, (1.0, 2.0, 3.0))
    assert (mesh.shell, mesh.side, mesh.fill) == (0.3, "outside", None)
    [turn] = mesh.rotate
    assert (turn.axis, turn.degrees) == ((0.0, 0.0, 1.0), 90.0)
    assert mesh.found.path == tmp_path / "parts/post.stl" and len(mesh.found.digest) == 16


def test_a_case_knows_its_meshes_and_what_stands_in_them(tmp_path):
    case = draft(tmp_path, POOL)
    assert list(case.meshes) == ["fluids.water.shape.difference.minus[0].mesh", "walls.post.shape.mesh"]
    assert draft(tmp_path, POOL).versions == case.versions != []
    (tmp_path / "parts/post.stl").write_bytes(b"something")
    assert draft(tmp_path, POOL).versions != case.versions
    assert draft(tmp_path, WATER).versions == [] and draft(tmp_path, WATER).meshes == {}


def test_the_resolved_case_reads_back_equal(tmp_path):
    for text in (POOL, with_keys("rotate = [{ axis = [0.0, 1.0, 1.0], degrees = 30.0 }], fill = true")):
        case = draft(tmp_path, text)
        assert draft(tmp_path, case.to_toml()) == case


@pytest.mark.parametrize(
    "keys, where, says",
    [
        ("shell = 0.1, fill = true", "", "fill and shell: a body is full or a shell; remove one of the two"),
        ("fill = false", "", "fill = false leaves nothing; give shell = its thickness in m"),
        ("side = 'inside'", "", "side is that of a shell; give shell ="),
        ("shell = 0.1, side = 'left'", ".side", '"left" is not known; known here: inside, outside'),
        ("shell = 0.0", ".shell", "0.0 is out of range; it must be above 0"),
        ("move = [1.0, 2.0]", ".move", "[1.0, 2.0]: 2 numbers in a case with space.dimensions = 3; give 3"),
        ("rotate = [{ axis = [0.0, 0.0, 0.0], degrees = 9.0 }]", ".rotate[0]", "an axis of zeros has no"),
        ("rotate = [{ axis = [0.0, 1.0], degrees = 9.0 }]", ".rotate[0].axis", "[0.0, 1.0]: 2 numbers"),
        ("rotate = [{ axis = [0.0, 0.0, 1.0] }]", ".rotate[0].degrees", "missing; add degrees ="),
        ("size = 2.0", ".size", "unknown key"),
    ],
)
def test_keys_that_do_not_fit(tmp_path, keys, where, says):
    [line] = refusal(tmp_path, with_keys(keys))
    assert line.startswith(f"case.toml: walls.post.shape.mesh{where}: {says}")


def test_a_file_has_no_unit_so_the_case_gives_one(tmp_path):
    [line] = refusal(tmp_path, POOL.replace("scale = 0.001, ", "", 1))
    says = "missing; add scale = ... (metres per unit of the file: 0.001 where it is in mm, 1 where in m, m)"
    assert line == f"case.toml: fluids.water.shape.difference.minus[0].mesh.scale: {says}"


def test_in_two_dimensions_a_polygon_takes_its_place(tmp_path):
    text = WATER + "[walls.post]\nshape.mesh = { file = 'parts/post.stl', scale = 1.0 }\n"
    [line] = refusal(tmp_path, text)
    assert line == (
        "case.toml: walls.post.shape.mesh: a mesh needs space.dimensions = 3, here it is 2; use a polygon"
    )


@pytest.mark.parametrize(
    "name, says",
    [
        (
            "../post.stl",
            "../post.stl is not an STL, OBJ or PLY file in the case's folder or below; put it there",
        ),
        ("/etc/post.stl", "/etc/post.stl is not an STL, OBJ or PLY file in the case's folder"),
        ("parts/post.step", "parts/post.step is not an STL, OBJ or PLY file"),
        ("post", "post is not an STL, OBJ or PLY file"),
        ("none.stl", "none.stl: No such file or directory; give a file that is there"),
        ("pipe.stl", "pipe.stl is not a regular file; give an STL, OBJ or PLY file"),
        ("away.stl", "away.stl is a link to a file outside the case's folder; put the file itself there"),
        ("ring.stl", "ring.stl: "),
        ("{0}.ply", "{0}.ply: No such file"),
        ("a" * 300 + ".obj", "File name too long; give a file that is there"),
    ],
)
def test_files_that_are_not_taken(tmp_path, name, says):
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "away.stl").symlink_to("/etc/hostname")
    (tmp_path / "ring.stl").symlink_to(tmp_path / "ring.stl")
    text = f'"{name}"'.join(POOL.rsplit('"parts/post.stl"', 1))
    [line] = refusal(tmp_path, text)
    assert line.startswith(f"case.toml: {FILE}: ") and says in line


def test_an_override_is_named(tmp_path):
    [line] = refusal(tmp_path, POOL, "walls.post.shape.mesh.file=gone.stl")
    assert line.startswith(f"case.toml with --set walls.post.shape.mesh.file=gone.stl: {FILE}: ")
