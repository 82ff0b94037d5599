"""A probe looks only at the planes of particles where some may be in reach, and what it reads is the same."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.runs.record import Record
from psph.runs.start import run

STREAM = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.1, periodic = ["y"], lower = [0.0, 0.0], upper = [3.0, 1.0] }
neighbours.skin = 0.3
time.end = 0.2
physics.sound_speed = 20.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [3.0, 1.0] }
density = 1000.0
velocity = [4.0, 1.0]
pressure = 5e3
[probes.P]
position = [1.95, 0.41]
fields = ["pressure", "velocity"]
"""
"""Water that moves on as a whole: its lists last while particles leave their cells."""

SWIRL = STREAM.replace('["y"]', '["x", "y"]')
"""The same across periods along the slabs too."""


@pytest.mark.parametrize("text", [STREAM, SWIRL], ids=["open", "periodic"])
def test_all_in_reach_are_among_the_columns_near(text, tmp_path):
    simulation = start(draft(tmp_path, text))
    store, radius = simulation.store, 0.25
    lengths = np.array([period or 1e9 for period in simulation.domain.periods])
    draw, missed, looked_at = np.random.default_rng(1), 0, []
    for _ in range(60):
        simulation.step()
        for place in draw.uniform([-0.5, 0.0], [3.5, 1.0], (20, 2)).tolist():
            x = store.owned_rows("position") - place
            x -= lengths * np.rint(x / lengths)
            near = store.low + np.flatnonzero((x**2).sum(axis=1) < radius**2)
            first, last = simulation.neighbourhood.columns_near(place, radius)
            assert ((first <= near) & (near < last)).all()
            looked_at.append((last - first) / store.owned)
            # The control: where they were listed is not where they are.
            first, last = simulation.domain.columns_near(place[simulation.domain.axis], radius)
            missed += np.count_nonzero((near < first) | (last <= near))
    assert missed > 0
    assert np.median(looked_at) < 0.5


def probes(tmp_path, name, *lines) -> str:
    """What probes.csv holds of a run."""
    run(draft(tmp_path, STREAM, *lines), tmp_path / name, MPI.COMM_SELF, say=lambda *_: None)
    return (tmp_path / name / "probes.csv").read_text(encoding="utf-8")


def test_a_row_of_probes_alone_is_that_beside_a_row_of_the_log(tmp_path, monkeypatch):
    """Beside the log all particles are settled, for probes alone those that they look at."""
    rows = "output.probes=0.001"
    beside = probes(tmp_path, "beside", rows, "output.log=0.001")
    assert probes(tmp_path, "alone", rows, "output.log=0.2") == beside
    monkeypatch.setattr(Record, "_ranges", lambda self: [])
    assert probes(tmp_path, "unsettled", rows, "output.log=0.2") != beside
