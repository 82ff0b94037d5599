"""A frame of a million particles from two ranks: every number comes back, no rank holds it all."""

import json

import numpy as np
import pytest
from jobs import mpirun
from long import LONG, tell
from runs.footprint import START
from viewers import seen_by_vtk

from psph.output.reader import Run

SIDE = 1000

CASE = """
scheme = "sph"
time = { end = 1e-5, step = 1e-5 }
space = { dimensions = 2, spacing = SPACING }
physics.sound_speed = 10.0
physics.artificial_viscosity = 0.1
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
pressure = 1000.0
velocity_gradient = [[0.0, -1.0], [1.0, 0.0]]
"""

SCRIPT = (
    START
    + """
simulation.step()
record.write_last()
record.close()
peak = comm.reduce(memory("VmHWM") - before, MPI.MAX)
if comm.rank == 0:
    predicted = sum(bytes_per_particle(scene, plan)) * particles / comm.size
    print(json.dumps({"particles": particles, "peak": peak, "predicted": predicted}))
"""
)


@LONG
@pytest.mark.timeout(900)
def test_a_million_particles_come_back(tmp_path):
    for name, side in (("few", 10), ("million", SIDE)):
        (tmp_path / f"{name}.toml").write_text(CASE.replace("SPACING", str(1.0 / side)))
    # Compiled by a process of its own: what a compiler leaves behind is not the run's.
    assert mpirun(1, ["-m", "psph", tmp_path / "few.toml", "--out", tmp_path / "few"]).returncode == 0
    job = mpirun(2, ["-c", SCRIPT, tmp_path / "million.toml"], timeout=900)
    assert job.returncode == 0, job.stderr
    found = json.loads(job.stdout.splitlines()[-1])
    assert found["particles"] == SIDE**2
    assert found["peak"] < 1.3 * found["predicted"]  # all of it, frames and log, not the step alone
    frame = Run(tmp_path).frame(-1)
    order = np.argsort(frame["id"])
    assert np.array_equal(frame["id"][order], np.arange(SIDE**2))
    x, v = frame["position"][order], frame["velocity"][order]
    sites = (np.indices((SIDE, SIDE)).reshape(2, -1).T + 0.5) / SIDE
    if not np.allclose(x[:SIDE], sites[:SIDE], atol=1e-4):
        sites = sites[:, ::-1]  # ids may run along either axis
    assert np.allclose(x, sites, atol=1e-4) and not np.array_equal(x, sites)
    calm = np.all(np.abs(sites - 0.5) < 0.45, axis=1)  # no surface near
    assert np.allclose(v[calm], np.stack([-sites[:, 1], sites[:, 0]], axis=1)[calm], atol=1e-3)
    [(_, points, fields)] = seen_by_vtk(tmp_path / "million.xdmf")
    assert np.array_equal(points[:, :2], frame["position"])
    assert np.array_equal(fields["pressure"], frame["pressure"])
    tell("particles written in one frame and read back", SIDE**2)
