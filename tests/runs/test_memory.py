"""Memory of a run, as the system counts it: at most 600 bytes a particle of a plain fluid in 3D."""

import json
import subprocess
import sys

from jobs import clean_environment
from runs.footprint import START

SCRIPT = (
    START
    + """
record.write_frame()
rebuilds = simulation.domain.rebuilds
while simulation.domain.rebuilds < rebuilds + 2:
    simulation.step()
record.write_frame()
print(json.dumps({
    "particles": particles,
    "measured": (memory("VmHWM") - before) / particles,
    "predicted": sum(bytes_per_particle(scene, plan)),
}))
"""
)

CUBE = """
scheme = "sph"
space = { dimensions = 3, spacing = 0.0125, smoothing = 1.2 }
time.end = 1.0
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] }
jitter = 0.2
pressure = 10000.0
"""
"""A cube of 80 sites a side that bursts: lists are rebuilt every few steps."""


def test_bytes_a_particle_rebuilds_and_frames_included(tmp_path):
    (tmp_path / "cube.toml").write_text(CUBE)
    job = subprocess.run(
        [sys.executable, "-c", SCRIPT, tmp_path / "cube.toml"],
        capture_output=True,
        text=True,
        env=clean_environment(),
    )
    assert job.returncode == 0, job.stderr
    found = json.loads(job.stdout.splitlines()[-1])
    assert found["particles"] == 80**3
    assert 300 < found["measured"] <= 600
    assert abs(found["measured"] / found["predicted"] - 1.0) < 0.15
