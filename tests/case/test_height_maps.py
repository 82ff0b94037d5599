"""Grounds from files: what is read, what is refused in one line, and what lies below."""

import numpy as np
import pytest
from drafts import draft, refusal

from psph.case import load
from psph.scene import Scene
from psph.scene.forms.make import form_of
from psph.scene.shapes import bounds, inside

CASE = """
[space]
dimensions = 3
spacing = 0.1
[time]
end = 1.0
[physics]
gravity = [0.0, 0.0, -9.81]
[fluids.water]
density = 1000.0
shape.difference = { from = { box = { lower = [0, 0, 0.0], upper = [2, 1, 1] } }, minus = [{ height_map = MAP }] }
[walls.bed]
shape.height_map = MAP
"""
FLAT_CASE = """
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
[physics]
gravity = [0.0, -9.81]
[fluids.water]
density = 1000.0
shape.difference = { from = { box = { lower = [0, 0], upper = [2, 1] } }, minus = [{ height_map = MAP }] }
[walls.bed]
shape.height_map = MAP
"""
SLOPE = "x,y,z\n" + "".join(f"{x},{y},{0.5 * x}\n" for y in (-1, 2) for x in (3, 0, -1))
GRID = "ncols 4\nnrows 2\nxllcorner -1.5\nyllcorner -1\ncellsize 1.5\nNODATA_value -9999\n9 1 2 3\n9 1 2 3\n"


def case_of(text, name="bed.csv", keys="bottom = -0.5"):
    """A case whose bed is a map."""
    return text.replace("MAP", f'{{ file = "{name}", {keys} }}')


@pytest.mark.parametrize(
    "content, says",
    [
        ("", "is empty; give a CSV file: a line of names, and rows of numbers"),
        (
            "x,y,z\n0,0,1\n1,0,1\n0,1,1\n",
            "a grid of 2 x 2 points has 1 gaps, the first at x = 1, y = 1; fill them",
        ),
        (SLOPE + "0,2,3\n", "line 8: this point was given before; give each once"),
        (SLOPE.replace("1.5", "deep"), "line 2: z is deep; give a number"),
        (SLOPE.replace("1.5", "nan"), "line 2: z is nan; give a number"),
        (SLOPE.replace("1.5", ""), "line 2: z is nothing; give a number"),
        ("x,y,z\n0,0,1\n0,1,1\n", "all points have one x; give two at least along each axis"),
        (
            "x,y,z,t\n0,0,1,1\n0,1,1,1\n",
            "has 4 columns, and a map has x, in 3D y, and the height; name those",
        ),
        (
            "x,y,z\n0,0,-1\n1,0,-1\n0,1,-1\n1,1,-2\n",
            "no height is above bottom = -0.5 m, the largest is -1 m",
        ),
    ],
)
def test_a_bad_map_is_one_line(content, says, tmp_path):
    (tmp_path / "bed.csv").write_text(content)
    first = refusal(tmp_path, case_of(CASE))[0]
    assert "height_map.file: " in first and "bed.csv" in first and says in first


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("9 1 2 3\n9", "9 1 -9999 3\n9", "line 7: -9999 stands for no data; fill the gaps"),
        ("9 1 2 3\n9", "9 1 2\n9", "line 7 has 3 heights, and ncols is 4; fill the hole"),
        ("9 1 2 3\n9", "9 1 2 x\n9", "line 7: x; give a number"),
        ("nrows 2", "nrows 3", "has 2 rows of heights, and nrows is 3; give them all"),
        ("nrows 2", "nrows 1", "a grid of 4 x 1 cells of 1.5 m; give two at least along each axis"),
        ("ncols 4\n", "", "has no ncols at its beginning; give an ESRI ASCII grid"),
    ],
)
def test_a_bad_grid_is_one_line(old, new, says, tmp_path):
    (tmp_path / "bed.asc").write_text(GRID.replace(old, new))
    assert says in refusal(tmp_path, case_of(CASE, "bed.asc"))[0]


def test_a_map_of_another_dimension_is_refused(tmp_path):
    (tmp_path / "bed.csv").write_text(SLOPE)
    [*_, line] = refusal(tmp_path, case_of(FLAT_CASE))
    assert "a height_map needs space.dimensions = 3, here it is 2; use a file with as many columns" in line


def test_a_bed_and_the_water_on_it_share_the_sites(tmp_path):
    """A plane slope, by points in any order: each column of sites is filled up to it by the wall alone."""
    (tmp_path / "bed.csv").write_text(SLOPE)
    scene = Scene(draft(tmp_path, case_of(CASE)))
    x = (np.arange(20) + 0.5) * 0.1
    below = np.ceil(0.5 * x / 0.1 - 0.5).sum() * 10  # sites under z = x / 2
    assert scene.census.sizes[0] == 20 * 10 * 10 - below
    assert scene.case.versions  # another file is another case
    form = form_of(scene.case.walls["bed"].shape)
    assert form.bounds == ((-1.0, -1.0, -0.5), (3.0, 2.0, 1.5))
    away, normal = form.faces(np.array([[1.0, 0.5, 1.0], [1.0, 0.5, 0.0]]))
    assert away == pytest.approx([0.5 / np.sqrt(1.25), -0.5 / np.sqrt(1.25)])
    assert normal == pytest.approx(np.tile([-1 / np.sqrt(5), 0.0, 2 / np.sqrt(5)], (2, 1)))


def test_a_grid_lies_as_maps_do(tmp_path):
    """Rows from north to south, heights in the middles of cells."""
    (tmp_path / "bed.asc").write_text(GRID.replace("9 1 2 3\n9 1 2 3", "4 3 2 1\n8 7 6 5"))
    shape = draft(tmp_path, case_of(CASE, "bed.asc", "bottom = 0.0")).walls["bed"].shape
    assert bounds(shape) == ((-0.75, -0.25, 0.0), (3.75, 1.25, 8.0))
    corners = [(-0.75, -0.25, 8.0), (3.74, -0.25, 5.0), (-0.75, 1.24, 4.0), (3.74, 1.24, 1.0)]
    for x, y, z in corners:
        held = inside(shape, [np.full(2, x), np.full(2, y), np.array([z - 0.1, z + 0.1])], 1e-9)
        assert held.tolist() == [True, False]


def test_a_bed_in_two_dimensions(tmp_path):
    """Straight between its points; the same as the polygon."""
    (tmp_path / "bed.csv").write_text("z,x\n0.2,-1\n0.2,1\n0.7,3\n")
    case = draft(tmp_path, case_of(FLAT_CASE, keys='bottom = -0.5, columns = ["x", "z"]'))
    form = form_of(case.walls["bed"].shape)
    points = np.random.default_rng(3).random((500, 2)) * [5.0, 2.0] - [1.5, 0.8]
    away = form.faces(points).away
    assert np.array_equal(form.holds([*points.T], np.zeros(2), 0.0), away < 0.0)
    assert form.bounds == ((-1.0, -0.5), (3.0, 0.7))
    assert load(tmp_path / "case.toml").walls["bed"].shape == case.walls["bed"].shape
