"""Ground of two soils at rest: each bears its own weight and that of what lies on it."""

import numpy as np
import pytest
from cases.measures import by_id
from drafts import draft
from mpi4py import MPI

from psph.output.reader import Run
from psph.physics.damping import diffusion
from psph.runs.start import run

LAYERS = """
time.end = 0.1
output.frames = 0.1
physics.gravity = [0.0, -9.81]
[space]
dimensions = 2
spacing = 0.01
periodic = ["x"]
lower = [1000.0, 499.96]
upper = [1000.1, 500.3]
[soils.sand]
shape.box = { lower = [1000.0, 500.0], upper = [1000.1, 500.08] }
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle = 33.0
[soils.clay]
shape.box = { lower = [1000.0, 500.08], upper = [1000.1, 500.16] }
density = 1600.0
young = 4.0e6
poisson = 0.4
friction_angle = 33.0
[walls.floor]
shape.box = { lower = [1000.0, 499.96], upper = [1000.1, 500.0] }
no_slip = true
"""


def rested(tmp_path):
    """Soft sand below stiff clay after 0.1 s: how far any row has moved, m; and the pressure along and across
    gravity of all but the four uppermost rows, over that of the start."""
    run(draft(tmp_path, LAYERS), tmp_path / "out", MPI.COMM_SELF, say=lambda *_: None)
    first, last = (by_id(Run(tmp_path / "out").frame(frame)) for frame in (0, -1))
    deep = (first["kind"] == 0) & (first["position"][:, 1] < 500.12)
    moved = np.abs(last["position"] - first["position"])[first["kind"] == 0].max()
    along, across = (
        (last["pressure"] - last["deviator"][:, k])[deep]
        / (first["pressure"] - first["deviator"][:, k])[deep]
        for k in (2, 0)
    )
    return moved, along, across


@pytest.mark.timeout(300)
def test_two_soils_of_different_stiffness_rest_on_each_other(tmp_path):
    moved, along, across = rested(tmp_path)
    assert moved < 2e-5
    assert along == pytest.approx(np.ones_like(along), abs=0.02)
    assert across == pytest.approx(np.ones_like(across), abs=0.05)


@pytest.mark.long
@pytest.mark.timeout(300)
def test_they_do_not_where_density_spreads_between_them(tmp_path, monkeypatch):
    """The control: one excess of density for both presses the soft one and stretches the stiff one."""
    monkeypatch.setattr(diffusion, "matter_of", lambda scene: diffusion.OneMatter())
    moved, _, across = rested(tmp_path)
    assert moved > 1e-4 and np.abs(across - 1.0).max() > 0.3
