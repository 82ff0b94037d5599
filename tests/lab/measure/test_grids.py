"""Fields between particles: straight ones come out as they are, and beyond the fluid there are none."""

import numpy as np
import pytest
from drafts import CHANNEL, TANK, draft

from psph.__main__ import main
from psph.errors import Refused
from psph.lab.measure.fields import Gridding
from psph.output.grids import Cloud, Weighing, at_points
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import run
from psph.smoothing import kernel

DX = 0.05


def scattered(dimensions, periods):
    """Particles of a unit box off their lattice, and points in it and on its faces."""
    random = np.random.default_rng(7)
    axis = (np.arange(20) + 0.5) * DX
    grid = np.meshgrid(*[axis] * dimensions, indexing="ij")
    position = np.column_stack([x.ravel() for x in grid])
    position = position + random.uniform(-0.15, 0.15, position.shape) * DX
    points = random.uniform(0.0, 1.0, (400, dimensions))
    points[:50, 0] = 0.0
    volume = np.full(len(position), DX**dimensions) * random.uniform(0.9, 1.1, len(position))
    around = Weighing(kernel("wendland-c2", 1.4 * DX, dimensions), (0.0,) * dimensions, periods)
    return Cloud(position, volume), Cloud(np.zeros((0, dimensions)), np.zeros(0)), around, points


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_constant_and_straight_fields_are_exact_also_at_walls(dimensions):
    fluid, none, around, points = scattered(dimensions, (None,) * dimensions)
    axis = (np.arange(20) + 0.5) * DX
    beside = np.column_stack([x.ravel() for x in np.meshgrid(axis[:3] - 3 * DX, *[axis] * (dimensions - 1))])
    walls = Cloud(beside, np.full(len(beside), DX**dimensions))  # behind x = 0
    slope = np.array([3.0, -2.0, 0.5])[:dimensions]
    values = {
        "one": np.full(len(fluid.position), 7.0),
        "straight": 1e5 + fluid.position @ slope,
        "vector": np.outer(fluid.position @ slope, [1.0, -4.0]),
    }
    found, share = at_points(fluid, walls, around, values, points)
    within = np.isfinite(found["one"])
    assert within.mean() > 0.8 and (share[within] >= 0.5).all()
    assert found["one"][within] == pytest.approx(7.0, rel=1e-13)
    exact = points[within] @ slope
    assert np.abs(found["straight"][within] - 1e5 - exact).max() < 1e-8
    assert np.abs(found["vector"][within] - np.outer(exact, [1.0, -4.0])).max() < 1e-10
    # The control: the mean alone is not straight at a face.
    at_face = np.flatnonzero(within & (points[:, 0] == 0.0))
    near = np.linalg.norm(fluid.position - points[at_face[0]], axis=1) < 2.0 * DX
    assert abs(values["straight"][near].mean() - 1e5 - points[at_face[0]] @ slope) > 0.02


def test_across_a_seam_nothing_is_lost():
    fluid, walls, around, points = scattered(2, (1.0, 1.0))
    wave = {"wave": np.sin(2.0 * np.pi * fluid.position[:, 0])}
    found, share = at_points(fluid, walls, around, wave, points)
    assert share.min() > 0.8
    assert np.abs(found["wave"] - np.sin(2.0 * np.pi * points[:, 0])).max() < 0.05
    same, again = at_points(fluid, walls, around, wave, points + np.array([3.0, -2.0]))
    assert np.abs(same["wave"] - found["wave"]).max() < 1e-9 and np.abs(again - share).max() < 1e-9


def test_still_water_in_a_tank_has_its_pressure_and_ends_at_its_surface(tmp_path):
    folder = tmp_path / "run"
    run(draft(tmp_path, TANK, "time.end=0.001"), folder, alone(), say=lambda *_: None)
    [first] = Gridding(folder, 0.025).frames([0.0])
    x, y = np.meshgrid(*first.axes, indexing="ij")
    inner = (x > -0.01) & (x < 1.01) & (y > -0.01) & (y <= 0.47)  # on the faces too
    pressure = first.fields["pressure"]
    assert np.abs(pressure[inner] - 1000.0 * 9.8 * (0.5 - y[inner])).max() < 1e-6
    outside = (x < -0.03) | (x > 1.03) | (y < -0.03) | (y > 0.53)
    assert np.isnan(pressure[outside]).all()
    assert (first.fields["velocity"][inner] == 0.0).all()


def test_files_for_numpy_and_for_viewers(tmp_path, capsys):
    pyvista = pytest.importorskip("pyvista")
    folder = tmp_path / "run"
    case = draft(tmp_path, BASIN)
    run(case, folder, alone(), say=lambda *_: None)
    asked = ["measure", str(folder), "--plane", "y=0.5", "--step", "0.05", "--fields", "pressure", "velocity"]
    assert main([*asked, "--from", "0", "0", "0", "--to", "1.5", "1.0", "0.5"]) == 0
    index = folder / "grid" / "case-y0.5.pvd"
    assert capsys.readouterr().out.splitlines() == [str(index)]
    reader = pyvista.get_reader(index)
    assert len(reader.time_values) == len(Run(folder).times)
    block = reader.read()[0]
    assert block.dimensions == (31, 1, 11)
    stored = np.load(folder / "grid" / "case-y0.5_00000.npz")
    assert stored["pressure"].shape == (31, 1, 11) and stored["velocity"].shape == (31, 1, 11, 3)
    there = np.array(block["pressure"]).reshape(11, 1, 31).transpose(2, 1, 0)
    assert np.array_equal(there, stored["pressure"], equal_nan=True)
    assert stored["pressure"][15, 0, 4] == pytest.approx(1000.0 * 9.8 * 0.3, rel=0.02)
    assert stored["z"][4] == pytest.approx(0.2) and list(stored["y"]) == [0.5]
    there = {*(folder / "grid").iterdir()}
    with pytest.raises(Refused, match="no point is in the fluid; the domain at the start is"):
        Gridding(folder, plane=(1, 5.0)).written(folder / "grid")
    assert {*(folder / "grid").iterdir()} == there


BASIN = """
space = { dimensions = 3, spacing = 0.1 }
time.end = 0.02
physics.gravity = [0.0, 0.0, -9.8]
[fluids.water]
pressure = "hydrostatic"
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.5, 1.0, 0.5] }
[walls.floor]
shape.box = { lower = [0.0, 0.0, -0.3], upper = [1.5, 1.0, 0.0] }
"""


@pytest.mark.parametrize(
    "options, says",
    [
        ({"fields": ("presure",)}, "--fields presure: not saved; give some of .*pressure"),
        ({"plane": (2, 0.5)}, "no such axis in 2D"),
        ({"step": -1.0}, "no points from"),
        ({"step": 1e-6}, "points; give a larger --step"),
        ({"lower": (0.0,)}, "--from: 1 numbers, not 2"),
        ({"lower": (3.0, 0.0)}, "no points from"),
        ({"of": "oil"}, "no fluid has this name; there are water"),
    ],
)
def test_grids_that_are_none_are_refused(tmp_path_factory, options, says):
    base = tmp_path_factory.getbasetemp() / "gridding"
    if not base.exists():
        base.mkdir()
        run(draft(base, CHANNEL, "time.end=0.001"), base / "run", alone(), say=lambda *_: None)
    with pytest.raises(Refused, match=says):
        Gridding(base / "run", **options)
