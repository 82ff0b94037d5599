"""A heavy block that lands on the floor, with a sound that bears it and with one that does not."""

import pytest
from drafts import draft
from mpi4py import MPI

from psph.output.reader import Run
from psph.runs.start import run
from psph.scene import Scene, check
from psph.simulation.step import BlowUp

SHALLOW = """
space = { dimensions = 2, spacing = 0.01 }
time.end = 0.04
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.3, 0.06] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.03, -0.03], upper = [0.33, 0.4] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [0.3, 0.4] } }]
[bodies.block]
shape.box = { lower = [0.11, 0.06], upper = [0.19, 0.14] }
density = 10000.0
velocity = [0.0, -2.66]
[gauges.block.motion]
of = "block"
"""


def test_a_heavy_block_lands_where_its_drawn_faces_are_those_of_its_particles(tmp_path):
    """By ½ ρc² ε² dx = ½ ρ_b h_b v² the last row of water is pressed by ε = 0.9 at 28 m/s, by 0.4 at 64 m/s.  A
    block drawn half a spacing higher than its particles stand is the control: they pass the floor by as much
    before its face meets it, and press water into it."""
    soft, hard = (draft(tmp_path, SHALLOW, f"physics.sound_speed={c}") for c in (28.0, 64.0))
    [says] = (line for line in check(Scene(soft)) if "may press water into it" in line)
    assert "up to 2.85 m/s" in says and says.endswith("give physics.sound_speed = 64 or more")
    assert not any("press water" in line for line in check(Scene(hard)))
    higher = "bodies.block.shape.box={lower=[0.11,0.065],upper=[0.19,0.145]}"
    with pytest.raises(BlowUp):
        run(
            draft(tmp_path, SHALLOW, "physics.sound_speed=64", higher),
            tmp_path / "higher",
            MPI.COMM_SELF,
            say=quiet,
        )
    run(hard, tmp_path / "hard", MPI.COMM_SELF, say=quiet)
    heights = Run(tmp_path / "hard").gauges()["block"]["block.centre_y"]
    assert heights.min() == pytest.approx(0.04, abs=1e-3)  # it stood on the floor
    assert heights[-1] > heights.min()  # and bounced


def quiet(*_):
    """Says nothing."""
