"""A line that parts is told of once, with the time, and stands in the summary; frames and gauges no longer have it."""

import json

import numpy as np
from drafts import draft
from mpi4py import MPI
from scene.test_lines import MOORED, PORT

from psph.output.reader import Run
from psph.runs.start import run


def test_a_line_that_parts_is_told_of_once(tmp_path):
    said = []
    case = draft(
        tmp_path,
        MOORED + '[gauges.raft.motion]\nof = "raft"\n',
        f"{PORT}break_load=60.0",
        "bodies.raft.velocity=[1.0, 0.0]",
        "time.end=0.1",
        "output.frames=0.05",
    )
    run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda line, *_: said.append(line))
    [told, again] = [line for line in said if "has parted" in line]
    assert told == again  # as it happens, and at the end
    time = float(told.split(" has parted at ")[1].split(" s")[0])
    assert told.startswith("bodies.raft.lines.port has parted at ") and 0.0 < time < 0.1
    assert told in json.loads((tmp_path / "run/summary.json").read_text())["said"]
    left = Run(tmp_path / "run")
    gauge = left.gauges()["raft"]
    tension, after = gauge["raft.tension_port"], gauge["time"] > time
    assert tension[~after].min() > 0.0 and not tension[after].any()
    assert gauge["raft.anchor_tension_port"][0] > 0.0
    assert [len(left.lines(k)) for k in (0, -1)] == [1, 0]
    assert np.allclose(left.lines(0)["raft.port"][0][[0, -1]], [[0.8, 0.4], [0.0, 0.0]])
