"""Rows behind an open end under a surface: which a level fills, who is born there and who dies."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.scene import Scene
from psph.scene.ends import faces_of
from psph.simulation.end_levels import EndLevel, fit_strips, rows_full

DX = 0.1
BASIN = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 9.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 25.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
pressure = "hydrostatic"
[walls.basin]
shape.difference.from.box = { lower = [-0.5, -0.4], upper = [1.4, 1.6] }
shape.difference.minus = [{ box = { lower = [-0.5, 0.0], upper = [1.0, 1.6] } }]
[ends.sea]
at = 0.0
inward = "+x"
level = 0.6
"""


def surface_of(folder, text=BASIN, *more):
    """The rows behind the only end of a case."""
    [face] = faces_of(Scene(draft(folder, text, *more)))
    return face.surface


def test_rows_are_those_that_walls_leave_open(tmp_path):
    """From the bed up, beyond the domain; a sill at the plane takes the lowest two.  A second basin below the
    bed is not of it."""
    rows = surface_of(tmp_path)
    assert rows.wet == 6 and rows.level == pytest.approx(0.6)
    assert rows.heights[:3] == pytest.approx([0.05, 0.15, 0.25]) and rows.heights[-1] > 1.6
    assert rows.level_of(2.5) == pytest.approx(0.25)
    sill = BASIN + "[walls.sill]\nshape.box = { lower = [-0.5, 0.0], upper = [0.4, 0.2] }\n"
    assert surface_of(tmp_path, sill).heights[0] == pytest.approx(0.25)
    deep = BASIN.replace("lower = [-0.5, -0.4]", "lower = [-0.5, -1.4]")
    deep = deep.replace("minus = [{", "minus = [{ box = { lower = [-0.5, -1.0], upper = [1.0, -0.6] } }, {")
    assert surface_of(tmp_path, deep).heights[0] == pytest.approx(0.05)


def test_rows_of_a_channel_with_sloping_banks(tmp_path):
    """In 3D rows have as many sites as the banks leave; a level is that of as many full sites."""
    text = BASIN.replace("dimensions = 2", "dimensions = 3")
    for old, new in (("0.0]", "0.0, 0.0]"), ("-9.81]", "-9.81, 0.0]"), ("0.6]", "0.6, 0.6]")):
        text = text.replace(old, new)
    text = (
        text.replace("0.0, 0.0, -9.81", "0.0, -9.81")
        .replace("-0.4]", "-0.4, -0.4]")
        .replace("1.6]", "1.6, 1.0]")
    )
    banks = "[walls.bank]\nshape.box = { lower = [-0.5, 0.0, 0.0], upper = [1.0, 0.3, 0.2] }\n"
    rows = surface_of(tmp_path, text + banks)
    assert rows.counts[:5].tolist() == [8, 8, 8, 10, 10]
    assert rows.level_of(24.0 + 5.0) == pytest.approx(0.35)


def test_a_level_has_to_pass_the_middle_of_a_row(tmp_path):
    """By a quarter of a spacing, either way, so that ripples fill and empty nothing."""
    rows = surface_of(tmp_path)
    assert [rows_full(rows, 6, level, DX) for level in (0.6, 0.67, 0.68, 0.81)] == [6, 6, 7, 8]
    assert [rows_full(rows, 7, level, DX) for level in (0.65, 0.63, 0.62, 0.41, -1.0)] == [7, 7, 6, 4, 0]


def fitted(depth, across, layers=4):
    """Of particles in spacings, with strips at 0, 1 and 2: how many lack, from where, who is too many."""
    surplus, begins = np.zeros(len(depth), np.bool_), np.full(3, np.nan)
    sites, standing = DX * np.arange(3.0)[:, None], np.ones(len(depth), np.bool_)
    places = DX * np.array(depth, float), DX * np.array([across], float)
    lacking = fit_strips(sites, *places, np.zeros(1), DX, layers, standing, surplus, begins)
    return lacking.tolist(), begins / DX, surplus.tolist()


def test_strips_are_filled_and_emptied():
    """A strip that is short gets those that lack behind its last, an empty one all; one that is too full
    loses its deepest; none is put beside one that is nearer than 0.7 spacings."""
    lacking, begins, surplus = fitted([0.2, 1.2, *range(5)], [0.0, 0.0, *[1.1] * 5])
    assert lacking == [2, 0, 4] and begins[0] == pytest.approx(2.2) and begins[2] == pytest.approx(0.5)
    assert surplus == [False] * 6 + [True]
    lacking, _, _ = fitted([0.5] * 2, [0.0, 1.4])
    assert lacking == [3, 3, 0]  # 1.4 is of the strip at 1, and too near to that at 2


def test_flow_that_turns_counts_past_a_hundredth_of_the_speed_of_waves(tmp_path):
    """Noise of still water turns nothing."""
    [face] = faces_of(Scene(draft(tmp_path, BASIN)))
    surface = EndLevel(6)
    for speed, comes_in, turned in (
        (-0.01, True, False),
        (-0.1, False, False),
        (0.01, False, False),
        (0.1, True, True),
    ):
        surface.see(face, 6.0, speed, 25.0, 1e-3)
        assert (surface.comes_in, surface.turned) == (comes_in, turned)


def run_to(simulation, time):
    """Step on to a time, s."""
    while simulation.time < time:
        simulation.step()


def top(simulation):
    """The highest fluid, m: half a spacing above its middle."""
    store = simulation.store
    return store.shown("position")[store.shown("kind") == 0, 1].max() + 0.5 * DX


def volume(simulation):
    """Of the fluid, m²."""
    return np.count_nonzero(simulation.store.shown("kind") == 0) * DX * DX


def test_a_basin_follows_the_sea_up_and_down(tmp_path):
    """Over three spacings and back, into rows that were dry.  Control: where the rows of the start stay, the
    highest is not followed."""
    (tmp_path / "tide.csv").write_text("time,value\n0,0.6\n4,0.9\n6,0.9\n10,0.6\n")
    simulation = start(draft(tmp_path, BASIN, 'ends.sea.level={file="tide.csv"}'))
    [state], high = simulation.engine.of("ends").states, []
    for time in np.arange(4.5, 6.6, 0.25):
        run_to(simulation, time)
        high.append(volume(simulation))
    assert np.mean(high) == pytest.approx(0.9, abs=0.03) and state.surface.full == 9
    run_to(simulation, 11.0)
    assert volume(simulation) == pytest.approx(0.6, abs=0.06) and state.surface.full <= 7


def test_a_basin_that_has_run_dry_is_filled_again(tmp_path):
    """What went out last does not keep out what stands behind a plane with nothing in front."""
    (tmp_path / "tide.csv").write_text("time,value\n0,0.6\n1,-0.5\n4,-0.5\n5,0.6\n9,0.6\n")
    more = 'ends.sea.level={file="tide.csv"}', "physics.gravity=[-1.0, -9.81]"
    simulation = start(draft(tmp_path, BASIN, *more))
    run_to(simulation, 4.0)
    assert volume(simulation) < 0.05
    run_to(simulation, 6.5)
    assert volume(simulation) > 0.4


@pytest.mark.parametrize("given", ["flow=0.12", "velocity=0.2"])
def test_what_comes_in_fills_the_rows_that_it_finds(tmp_path, given):
    """A basin that fills: the end is as high as the water before it, and by a flow the volume is right but for
    half a row where waves come back."""
    key, value = given.split("=")
    simulation = start(
        draft(tmp_path, BASIN.replace("level = 0.6", f'{key} = {value}\nwaves = "back"\nlevel = "found"'))
    )
    before = volume(simulation)
    run_to(simulation, 5.0)
    [state] = simulation.engine.of("ends").states
    assert state.surface.full >= 11 and top(simulation) > 1.1
    if key == "flow":
        assert volume(simulation) - before == pytest.approx(0.6, abs=0.06)


def test_a_level_that_is_found_lets_out_what_comes(tmp_path):
    """A stream that falls off a sill leaves through an end that has no fluid at first."""
    text = BASIN.replace("upper = [1.4, 1.6]", "upper = [1.0, 1.6]")
    text = text.replace("level = 0.6", 'flow = 0.12\n[ends.out]\nat = 0.6\ninward = "-x"\nlevel = "found"')
    simulation = start(draft(tmp_path, text, "fluids.water.shape.box.upper=[0.6, 0.6]"))
    before = volume(simulation)
    run_to(simulation, 2.0)
    out = simulation.engine.of("ends").states[1]
    assert out.books.number_out * DX * DX == pytest.approx(0.24 + before - volume(simulation), abs=0.03)
