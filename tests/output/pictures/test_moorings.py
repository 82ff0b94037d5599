"""Mooring lines in pictures, and the charts of places."""

import h5py
import numpy as np
from matplotlib.colors import to_rgba

from psph.output.frames import FrameFile
from psph.output.pictures import charts, style
from psph.output.pictures.show import Show
from psph.output.reader import Run

TAUT = np.array([[1.0, 0.4, 0.2], [0.3, 0.3, 0.75]]), 3.0
HUNG = np.array([[0.8, 0.2, 0.2], [0.4, 0.1, 0.05], [0.2, 0.1, 0.4]]), 0.0


def moored(run):
    """The same run, with two lines in its last frame."""
    with h5py.File(run.path, "r+", locking=False) as file:
        for name, (points, tension) in {"block.taut": TAUT, "block.slack": HUNG}.items():
            file["frames/00002"].attrs[f"line {name}"] = points
            file["frames/00002"].attrs[f"tension {name}"] = tension
    return Run(run.folder)


def test_lines_are_seen_in_3d(tank3d):
    def page(run):
        figure = Show(run, [1.0], "pressure").picture([2])
        figure.canvas.draw()
        return np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    bare, drawn = page(tank3d), page(moored(tank3d))
    for colour, most in ((style.INK, 100), (style.PALE, 30)):
        ink = np.array([255 * part for part in to_rgba(colour)[:3]])
        dark = [(np.abs(image - ink).max(axis=-1) < 12).sum() for image in (bare, drawn)]
        assert dark[1] > dark[0] + most


FLAT = """
scheme = "sph"
title = "A raft"
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
[fluids.water]
density = 1000.0
[bodies.raft]
density = 100.0
"""


def test_frames_keep_lines_and_pictures_draw_them(tmp_path, alone):
    grid = np.meshgrid(0.05 + 0.1 * np.arange(20), 0.05 + 0.1 * np.arange(4), indexing="ij")
    position = np.stack([x.ravel() for x in grid], axis=-1)
    group = (position[:, 1] > 0.3).astype(np.uint8)
    arrays = {"id": np.arange(len(group)), "kind": group, "group": group}
    arrays |= {"position": position, "pressure": position[:, 1], "velocity": 0.0 * position}
    frames = FrameFile(tmp_path / "raft.h5", alone, {"case": FLAT})
    taut, slack = TAUT[0][:, ::2], HUNG[0][:, ::2]
    for k in range(2):
        lines = (
            {"raft.taut": (taut, 3.0)} if k == 0 else {"raft.taut": (taut, 4.0), "raft.slack": (slack, 0.0)}
        )
        frames.write(k, 0.5 * k, k, arrays, lines)
    run = Run(tmp_path)
    assert list(run.lines(0)) == ["raft.taut"] and sorted(run.lines(-1)) == ["raft.slack", "raft.taut"]
    figure = Show(run, [0.5], "pressure").picture([1])
    drawn = {line.get_color(): line.get_xydata() for line in figure.axes[0].lines}
    assert np.array_equal(drawn[style.INK], taut) and np.array_equal(drawn[style.PALE], slack)


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
