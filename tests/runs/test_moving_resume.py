"""A run with a series goes on from a checkpoint, and knows its file again."""

import numpy as np
import pytest

from psph.case import load
from psph.output.checkpoint import CheckpointError, checkpoints
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import resume, run

SCENE = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.1 }
time.end = 0.06
parallel.axis = "x"
physics.gravity = [0.0, -9.8]
physics.sound_speed = 20.0
checkpoint.every = 10
output = { frames = 0.02, log = 0.01 }
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }, pressure = "hydrostatic" }
[walls.tank]
condition = "extrapolated"
shape.difference.from.box = { lower = [-0.3, -0.3], upper = [1.3, 0.9] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.9] } }]
motion = [
  { series = { file = "tank.csv", displacement = ["x", "y"], angle = "turn", center = [0.5, 0.0] } },
  { translation = [0.5, 0.0], start = 0.025 },
]
[frame]
motion = { sinusoid = { angle = 0.1, center = [0.5, 0.0], period = 0.3 } }
"""
ROWS = "time,x,y,turn\n0,0,0,0\n0.03,0.02,0.01,0.05\n0.06,0.01,0,-0.05\n"


def test_the_same_bits_after_a_restart_and_another_series_is_refused(tmp_path):
    (tmp_path / "case.toml").write_text(SCENE)
    (tmp_path / "tank.csv").write_text(ROWS)
    folder = tmp_path / "run"
    run(load(tmp_path / "case.toml"), folder, alone(), say=lambda *_: None)
    assert (folder / "tank.csv").read_text() == ROWS
    (tmp_path / "tank.csv").unlink()  # the run has its own
    whole, log = Run(folder).frame(-1), Run(folder).log()
    older = checkpoints(folder)[-1]
    resume(folder, alone(), ["guards.speed=0.9"], older.name, say=lambda *_: None)
    again = Run(folder).frame(-1)
    assert all(np.array_equal(again[name], whole[name]) for name in whole)
    assert all(np.array_equal(Run(folder).log()[name], log[name]) for name in log)
    (folder / "tank.csv").write_text(ROWS.replace("0.05", "0.06"))
    with pytest.raises(CheckpointError, match="belongs to another case"):
        resume(folder, alone(), ["time.end=0.08"], say=lambda *_: None)
