"""Mooring lines in pictures, and the charts of places."""

import h5py
import numpy as np
import pytest
from matplotlib.colors import to_rgba

from psph.output.frames import FrameFile
from psph.output.pictures import charts, style
from psph.output.pictures.moorings import moorings_of
from psph.output.pictures.show import Show
from psph.output.reader import Run

MIDDLE = np.array([0.9, 0.3, 0.1])
LINES = """
[bodies.block.lines.taut]
at = [1.0, 0.4, 0.2]
anchor = [0.3, 0.3, 0.75]
length = 0.5
pulls_only = true
[bodies.block.lines.slack]
at = [0.8, 0.2, 0.0]
anchor = [0.2, 0.1, 0.1]
length = 2.0
pulls_only = true
[bodies.block.lines.spring]
at = [1.0, 0.2, 0.2]
anchor = [1.2, 0.2, 0.6]
pulls_only = false
"""


def moored(run):
    """The same run, whose block is a rigid body on three lines."""
    with h5py.File(run.path, "r+", locking=False) as file:
        file.attrs["case"] = file.attrs["case"].replace("walls.block", "bodies.block") + LINES
    return Run(run.folder)


def test_the_ends_of_lines_go_with_their_body(tank3d):
    run = moored(tank3d)
    start, last = (run.frame(k) for k in (0, 2))
    case = Show(run, [0.0], "pressure").case
    taut, slack, spring = moorings_of(case, start).at(last)
    turn = np.array([[np.cos(0.6), -np.sin(0.6), 0.0], [np.sin(0.6), np.cos(0.6), 0.0], [0.0, 0.0, 1.0]])
    there = turn @ (np.array([1.0, 0.4, 0.2]) - MIDDLE) + MIDDLE + [0.1, 0.0, 0.04]
    assert taut.ends == pytest.approx(np.array([there, [0.3, 0.3, 0.75]]), abs=1e-12)
    assert [one.slack for one in (taut, slack, spring)] == [False, True, False]
    assert moorings_of({"bodies": {"block": {}}}, start) is None


def test_lines_are_seen_in_3d(tank3d):
    def page(run):
        figure = Show(run, [1.0], "pressure").picture([2])
        figure.canvas.draw()
        return np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    bare, drawn = page(tank3d), page(moored(tank3d))
    ink = np.array([255 * part for part in to_rgba(style.INK)[:3]])
    dark = [(np.abs(image - ink).max(axis=-1) < 12).sum() for image in (bare, drawn)]
    assert dark[1] > dark[0] + 200


FLAT = """
scheme = "sph"
title = "A raft"
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, 0.0], upper = [2.0, 1.0] }
time.end = 1.0
[fluids.water]
density = 1000.0
[bodies.raft.lines.left]
at = [1.6, 0.5]
anchor = [0.2, 0.0]
pulls_only = false
[bodies.raft.lines.to_buoy]
at = [1.9, 0.5]
anchor = [0.65, 0.75]
to = "buoy"
length = 9.0
pulls_only = true
[bodies.buoy]
density = 100.0
"""


def test_lines_are_drawn_in_2d_from_bodies_beyond_a_seam(tmp_path, alone):
    def cells(low, counts):
        grid = np.meshgrid(*(a + 0.05 + 0.1 * np.arange(n) for a, n in zip(low, counts)), indexing="ij")
        return np.stack([x.ravel() for x in grid], axis=-1)

    parts = [cells((0.0, 0.0), (20, 3)), cells((1.6, 0.5), (3, 2)), cells((0.6, 0.7), (2, 1))]
    group = np.repeat(np.arange(3, dtype=np.uint8), [len(part) for part in parts])
    frames = FrameFile(tmp_path / "raft.h5", alone, {"case": FLAT})
    for k in range(2):
        position = np.concatenate([parts[0], parts[1] + [0.25 * k, 0.0], parts[2] + [0.0, 0.1 * k]])
        position[:, 0] %= 2.0
        arrays = {"id": np.arange(len(group)), "kind": (group > 0).astype(np.uint8), "group": group}
        arrays |= {"position": position, "pressure": position[:, 1], "velocity": 0.0 * position}
        frames.write(k, 0.5 * k, k, arrays)
    figure = Show(Run(tmp_path), [0.5], "pressure").picture([1])
    left, between = (line for line in figure.axes[0].lines if len(line.get_xdata()) == 2)
    assert left.get_xydata() == pytest.approx(np.array([[1.85, 0.5], [0.2, 0.0]]), abs=1e-9)
    assert between.get_xydata() == pytest.approx(np.array([[2.15, 0.5], [0.65, 0.85]]), abs=1e-9)
    assert [line.get_color() for line in (left, between)] == [style.INK, style.PALE]


def test_heave_has_an_axis_of_its_own_beside_a_long_way():
    time = np.linspace(0.0, 1.0, 5)

    def titles(x, y):
        chart = charts.Chart("centre", "m", time, {"x": x, "y": y})
        return [one.title for one in charts.apart(chart)]

    assert titles(3.0 * time, 0.2 + 0.1 * time) == ["centre x", "centre y"]
    assert titles(1.0 + 0.0 * time, 0.2 + 0.1 * time) == ["centre x", "centre y"]
    assert titles(0.2 + 0.1 * time, 0.25 + 0.1 * time) == ["centre"]
    force = charts.Chart("force", "N", time, {"x": 0.0 * time, "y": time})
    assert list(charts.apart(force)) == [force]
