"""A moored buoy in irregular waves whose paddle takes up what comes back: its tension, and the same after a stop."""

import numpy as np
import pytest
from cases.measures import by_id
from jobs import mpirun
from long import LONG

from psph.output.checkpoint import checkpoints
from psph.output.reader import Run

BUOY = """
parallel.axis = "x"
time.end = 2.4
checkpoint = { every = 2000, minutes = 60.0 }
output = { frames = 0.4, log = 0.5, probes = 0.02 }
space = { dimensions = 2, spacing = 0.02 }
physics.gravity = [0.0, -9.81]
physics.damping_zone = { begin = 2.2, end = 3.2 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [3.2, 0.4] }
pressure = "hydrostatic"
[walls.flume]
shape.union = [
  { box = { lower = [-0.3, -0.06], upper = [3.26, 0.0] } },
  { box = { lower = [3.2, 0.0], upper = [3.26, 0.6] } },
]
[walls.paddle]
shape.box = { lower = [-0.06, 0.0], upper = [0.0, 0.6] }
motion.irregular = { height = 0.1, period = 1.1, depth = 0.4, seed = 7, components = 24, absorb = {} }
motion.ramp = 0.5
[bodies.buoy]
shape.box = { lower = [0.7, 0.18], upper = [0.94, 0.3] }
density = 500.0
[bodies.buoy.lines.left]
at = [0.7, 0.18]
anchor = [0.7, 0.0]
stiffness = 2.0e4
length = 0.18
pulls_only = true
[bodies.buoy.lines.right]
at = [0.94, 0.18]
anchor = [0.94, 0.0]
stiffness = 2.0e4
length = 0.18
pulls_only = true
[gauges.buoy.motion]
of = "buoy"
[gauges.wave.level]
foot = [0.5, 0.0]
top = [0.5, 0.6]
"""
"""Half as heavy as water and all under it, on two lines that are taut from the start."""

BUOYANCY = 500.0 * 0.24 * 0.12 * 9.81
"""What the lines hold down, N per metre."""


@LONG
@pytest.mark.timeout(600)
def test_a_taut_mooring_holds_the_buoyancy_and_goes_on_alike_on_other_ranks(tmp_path):
    (tmp_path / "case.toml").write_text(BUOY, encoding="utf-8")
    folder = tmp_path / "run"
    job = mpirun(2, ["-m", "psph", tmp_path / "case.toml", "--out", folder], timeout=500)
    assert job.returncode == 0, job.stderr
    first, wave = Run(folder), Run(folder).gauges()["wave"]
    buoy = first.gauges()["buoy"]
    sum_of_lines = buoy["buoy.tension_left"] + buoy["buoy.tension_right"]
    late = buoy["time"] > 0.4
    assert sum_of_lines[late].mean() == pytest.approx(BUOYANCY, rel=0.05)
    assert np.ptp(wave["wave.level"]) > 0.02 and np.ptp(buoy["buoy.centre_x"]) > 0.01  # in waves, it sways
    assert np.ptp(buoy["buoy.centre_y"]) < 0.02  # and stays down
    frames = [by_id(first.frame(k)) for k in range(len(first.times))]
    tables = {path.name: path.read_text() for path in folder.glob("*.csv")}
    stopped = checkpoints(folder)[-1].name
    for ranks in (3, 1):
        job = mpirun(ranks, ["-m", "psph", "resume", folder, "--from", stopped], timeout=500)
        assert job.returncode == 0, job.stderr
        again = Run(folder)
        assert {path.name: path.read_text() for path in folder.glob("*.csv")} == tables
        assert len(again.times) == len(frames)
        for k, frame in enumerate(frames):
            assert all(np.array_equal(by_id(again.frame(k))[name], frame[name]) for name in frame), k
