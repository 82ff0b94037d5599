"""What ``check`` says of geometry files, and what it refuses."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from drafts import POOL, draft
from jobs import clean_environment, mpirun
from scene.solids import cube
from scene.test_checks import checked, refused

from psph.scene import Scene
from psph.scene.meshes.report import described

ROOT = Path(__file__).parents[2]
POST = trimesh.creation.box(bounds=[[0, 0, 0], [400, 400, 600]])
SHEET = trimesh.Trimesh([[0, 0, 0], [400, 0, 0], [400, 400, 9], [0, 400, 9]], [[0, 1, 2], [0, 2, 3]])
NOT = ("fluids.water.shape.difference.minus[0].mesh", "walls.post.shape.mesh")
KEY = NOT[0]


def put(folder, body, ending="stl"):
    """Write a surface where POOL looks for it."""
    (folder / "parts").mkdir(exist_ok=True)
    if isinstance(body, bytes):
        (folder / "parts/post.stl").write_bytes(body)
    else:
        body.export(folder / f"parts/post.{ending}")


def lying(folder, *overrides):
    """The lines that describe the meshes of POOL."""
    return list(described(Scene(draft(folder, POOL, *overrides))))


def changed(faces):
    return trimesh.Trimesh(POST.vertices, faces, process=False)


def test_a_good_mesh_is_silent_and_described(tmp_path):
    put(tmp_path, POST)
    assert checked(tmp_path, POOL) == []
    assert lying(tmp_path) == [
        f"{KEY}: parts/post.stl: 0.4 x 0.4 x 0.6 m from [0.5, 0.3, 0] to [0.9, 0.7, 0.6], 12 triangles, "
        "closed, 0.096 m3, +0.0% on the lattice: 96 sites (also walls.post.shape.mesh)"
    ]
    scene = Scene(draft(tmp_path, POOL))
    assert scene.census.sizes.tolist() == [15 * 10 * 5 - 4 * 4 * 5, 15 * 10 * 3, 4 * 4 * 6]


def test_open_edges_are_told(tmp_path):
    put(tmp_path, changed(POST.faces[1:]))
    [line] = checked(tmp_path, POOL)
    assert line.startswith(
        f"case.toml: {KEY}: 3 open edges around 1 hole: psph closes each towards its middle"
    )
    assert "3 open edges, 0.096 m3" in lying(tmp_path)[0]


def test_turned_faces_are_told(tmp_path):
    faces = POST.faces.copy()
    faces[[2, 3]] = faces[[2, 3], ::-1]
    put(tmp_path, changed(faces))
    [line] = checked(tmp_path, POOL)
    assert line.startswith(f"case.toml: {KEY}: 2 of 12 faces lie the other way than those beside them")
    assert "closed, 0.096 m3, +0.0% on the lattice: 96 sites" in lying(tmp_path)[0]


@pytest.mark.parametrize("width, says", [(360, ""), (340, "encloses 0.06936 m3, its sites 0.054 (-22%)")])
def test_a_volume_that_the_lattice_does_not_hold_is_told(tmp_path, width, says):
    """Of 0.36 m four sites are held, of 0.34 m three: −2 % is silent, −22 % is not."""
    put(tmp_path, trimesh.creation.box(bounds=[[0, 0, 0], [width, 340, 600]]))
    lines = [line for line in checked(tmp_path, POOL) if "the surface encloses" in line]
    assert [line.startswith(f"case.toml: {KEY}: the surface {says}") for line in lines] == [True] * bool(says)


@pytest.mark.parametrize(
    "body, overrides, says",
    [
        (
            POST,
            ("scale=1.0",),
            "is 400 x 400 x 600 m in size, 400 times the rest of the scene; lengths are in m: ",
        ),
        (
            POST,
            ("scale=1e-6",),
            "no lattice site lies in parts/post.stl, 0.0004 x 0.0004 x 0.0006 m in size from",
        ),
        (POST, ("scale=1e29",), "reaches beyond 1e+30 m; make scale or move smaller"),
        (b"", (), "parts/post.stl holds no triangle; export the surface"),
        (b"solid x\nendsolid x\n", (), "parts/post.stl holds no triangle; export the surface"),
        (b"\x89PNG\r\n" + bytes(range(256)), (), "parts/post.stl "),
        (SHEET, (), "encloses nothing: 4 open edges around 1 hole"),
        (
            trimesh.Trimesh([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[0, 1, 1]], process=False),
            (),
            "without an area",
        ),
        (
            trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], process=False),
            (),
            "no numbers",
        ),
        (
            trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], [[0, 1, 2]], process=False),
            (),
            "no numbers",
        ),
    ],
)
def test_what_cannot_be_simulated_is_one_line(tmp_path, body, overrides, says):
    put(tmp_path, body)
    sets = [f"{key}.{change}" for change in overrides for key in (KEY.replace("[0]", ".0"), NOT[1])]
    [line] = refused(tmp_path, POOL, *sets)
    assert line.startswith(f"case.toml: {KEY}") and says in line


def test_a_mesh_in_millimetres_is_refused_before_its_sites_are_visited(tmp_path, monkeypatch):
    """A cube of 0.2 m that is 200 m long: 8e9 sites, which are fewer than a lattice may have."""
    put(tmp_path, trimesh.creation.box(bounds=[[0, 0, 0], [200, 200, 200]]))
    sets = [f"{key}.scale=1.0" for key in (KEY.replace("[0]", ".0"), NOT[1])]
    monkeypatch.setattr("psph.scene.census.sites_in", None)  # nobody asks
    [line] = refused(tmp_path, POOL, *sets)
    assert "is 200 x 200 x 200 m in size, 133 times the rest of the scene; lengths are in m: was" in line
    assert line.endswith("give scale = 0.001")


def test_a_body_in_millimetres_is_refused_before_it_overlaps_all_else(tmp_path):
    """Of 0.06 m, in few sites: it would lie over the fluid and the floor, which is not what is wrong."""
    put(tmp_path, trimesh.creation.box(bounds=[[0, 0, 0], [60, 60, 60]]))
    pool = (
        POOL.split("[fluids")[0]
        + """
fluids.water.shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.5, 1.0, 0.5] }
bodies.float = { shape.mesh = { file = "parts/post.stl", scale = 1.0 }, density = 500.0 }
"""
    )
    [line] = refused(tmp_path, pool)
    assert "60 x 60 x 60 m in size, 40 times the rest of the scene" in line and "scale = 0.001" in line


@pytest.mark.parametrize("count", [0, 11, 13])
def test_a_binary_file_with_a_wrong_count_is_damaged(tmp_path, count):
    put(tmp_path, POST)
    whole = (tmp_path / "parts/post.stl").read_bytes()
    put(tmp_path, whole[:80] + count.to_bytes(4, "little") + whole[84:])
    [line] = refused(tmp_path, POOL)
    says = f"parts/post.stl is damaged: its header counts {count} triangles, and it has room for 12; export"
    assert line.startswith(f"case.toml: {KEY}.file: ") and says in line


def test_a_mesh_away_from_what_it_is_taken_from_is_one_line(tmp_path):
    put(tmp_path, POST)
    [line] = refused(tmp_path, POOL, "fluids.water.shape.difference.minus.0.mesh.move=[50.0, 0.0, 0.0]")
    assert line.startswith(
        f"case.toml: {KEY}: no lattice site lies in parts/post.stl, 0.4 x 0.4 x 0.6 m in size"
    )


def test_a_mesh_far_from_all_else_is_told(tmp_path):
    put(tmp_path, POST)
    [line] = checked(tmp_path, POOL, "walls.post.shape.mesh.move=[0.5, 0.3, 99.0]")
    assert line.startswith("case.toml: walls.post.shape.mesh: it lies 98.5 m from the rest of the scene")
    assert not checked(tmp_path, POOL, "walls.post.shape.mesh.move=[0.5, 0.3, 2.0]")


def test_a_cut_off_file_is_one_line(tmp_path):
    put(tmp_path, POST)
    whole = (tmp_path / "parts/post.stl").read_bytes()
    put(tmp_path, whole[:300])
    [line] = refused(tmp_path, POOL)
    assert line.startswith(f"case.toml: {KEY}.file: ") and "export" in line
    text = trimesh.exchange.stl.export_stl_ascii(POST)
    put(tmp_path, text.replace("4.0", "4,0", 1).replace("400", "4oo", 1).encode())
    [line] = refused(tmp_path, POOL)
    assert "cannot be read as STL (" in line and line.endswith("); export it again")


def test_a_wall_in_the_fluid_is_told(tmp_path):
    put(tmp_path, POST)
    [line] = refused(tmp_path, POOL, "fluids.water.shape.difference.minus.0.mesh.move=[0.9, 0.3, 0.0]")
    assert line.startswith(
        "case.toml: walls.post.shape: overlaps fluids.water at [0.55, 0.35, 0.05]; subtract"
    )
    assert line.endswith("; parts/post.stl is 0.4 x 0.4 x 0.6 m")


def test_a_thin_shell_is_told(tmp_path):
    put(tmp_path, cube(0.0, 1000.0))
    keys = ("walls.post.shape.mesh.shell=0.1", "walls.post.shape.mesh.move=[5.0, 0.0, 0.0]")
    lines = checked(tmp_path, POOL, *keys, "fluids.water.shape.difference.minus.0.mesh.scale=4e-4")
    assert lines == [
        "case.toml: walls.post.shape: 1 layer of particles at [5.05, 0.15, 0.15], the kernel reaches over 2.4; "
        "make the wall at least 3 spacings (0.3 m) thick"
    ]
    lines = checked(
        tmp_path,
        POOL,
        *keys,
        keys[0].replace("0.1", "0.3"),
        "fluids.water.shape.difference.minus.0.mesh.scale=4e-4",
    )
    assert lines == []


def test_a_file_far_from_its_origin_is_told(tmp_path):
    body = POST.copy()
    body.apply_translation([1e8, 0.0, 0.0])
    put(tmp_path, body, "obj")
    text = POOL.replace("post.stl", "post.obj").replace("[0.5,", "[-99999.5,")
    assert any(
        "taken as equal within 0.048 m; move the body to the origin" in line
        for line in checked(tmp_path, text)
    )


def test_many_ranks_end_with_one_line(tmp_path):
    put(tmp_path, b"no surface")
    draft(tmp_path, POOL)
    job = mpirun(3, ["-m", "psph", tmp_path / "case.toml", "--out", tmp_path / "run"])
    assert job.returncode == 2 and job.stderr.count("parts/post.stl") == 1
    assert not (tmp_path / "run").exists() and "Traceback" not in job.stderr


def test_a_scene_without_a_mesh_loads_nothing_for_it():
    """Neither the reader nor the loops: what a scene does not need costs nothing."""
    script = (
        "import sys; from psph.case import load; from psph.scene import Scene, check; "
        "check(Scene(load('run/cases/minimal.toml'))); "
        "print([name for name in sys.modules if name.startswith(('trimesh', 'psph.scene.meshes.', 'scipy.spatial'))])"
    )
    job = subprocess.run(
        [sys.executable, "-c", script],
        cwd=ROOT,
        env=clean_environment(),
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert job.stdout.strip() == "['psph.scene.meshes.drawn', 'psph.scene.meshes.report']", job.stderr


def test_a_hull_whose_faces_go_through_sites_is_told(tmp_path):
    """Its sides meet sites, and those on the high side are not its own; higher up they do not, and a shift
    of the whole body by half a spacing makes it lean no more."""
    sides = [(half, height) for half, height in ((150.0, 0.0), (350.0, 400.0))]
    corners = [(x, s * half, z) for half, z in sides for s in (-1.0, 1.0) for x in (-300.0, 300.0)]
    put(tmp_path, trimesh.convex.convex_hull(np.array(corners)))
    text = POOL.replace("[walls.post]", "[bodies.post]\ndensity = 400.0")
    told = []
    for place in ([0.7, 0.5, 0.25], [0.7, 0.5, 0.3], [0.75, 0.5, 0.3]):
        lines = checked(tmp_path, text, f"bodies.post.shape.mesh.move={place}")
        told.append([line for line in lines if "aslant" in line])
    assert [len(lines) for lines in told] == [1, 0, 0]
    assert told[0][0].startswith("case.toml: bodies.post.shape.mesh: its particles lean along y, by ")
