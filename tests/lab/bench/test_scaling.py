"""The model of many cores: its counts against real runs, its limits, and the page that shows it."""

import json
from pathlib import Path

import pytest
from jobs import mpirun

from psph.lab.bench.scaling import MEASURED, SlabScene, model, table

PAGE = Path(__file__).parents[3] / "docs" / "scaling.md"

COUNTS = """
import json
from mpi4py import MPI
from psph.case import Case
from psph.output.ledger import Ledger
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.runs.setup import create_particles
from psph.simulation.step import Simulation

case = Case.model_validate({
    "space": {"dimensions": 3, "spacing": 1.0, "smoothing": 1.2},
    "time": {"end": 1.0},
    "physics": {"sound_speed": 10.0},
    "fluids": {"water": {"shape": {"box": {"lower": [0.0] * 3, "upper": [48.0, 12.0, 12.0]}}}},
})
comm, scene = MPI.COMM_WORLD, Scene(case)
plan = make_plan(scene)
simulation = Simulation(scene, plan, create_particles(scene, plan, comm), comm, Ledger())
halo, store = simulation.domain.halo, simulation.store
mine = [halo.bytes(plan.refreshed), store.low + store.high, simulation.domain.planes]
found = comm.gather(mine)
if comm.rank == 0:
    print(json.dumps(found))
"""


@pytest.mark.parametrize("ranks", [2, pytest.param(4, marks=pytest.mark.long)])
def test_counts_of_real_runs(ranks):
    job = mpirun(ranks, ["-c", COUNTS])
    assert job.returncode == 0, job.stderr
    found = json.loads(job.stdout.splitlines()[-1])
    scene = SlabScene(48 * 12 * 12, long=4.0)
    assert sum(planes for *_, planes in found) == scene.planes
    for rank, (sent, ghosts, _) in enumerate(found):
        sides = (rank > 0) + (rank < ranks - 1)
        # A plane of cells holds 2 or 3 lattice planes where the model has 2.7 on average.
        assert ghosts == pytest.approx(sides * scene.ghosts, rel=0.3)
        assert sent == pytest.approx(sides * scene.ghosts * scene.ghost_bytes, rel=0.3)


def test_one_core_is_pairs_alone():
    step = model(MEASURED, SlabScene(10**6), 1)
    assert step.seconds == pytest.approx(10**6 * MEASURED.particle, rel=1e-9)
    assert (step.ranks, step.threads) == (1, 1)


def test_never_more_ranks_than_planes_and_never_slower_with_more_cores():
    for particles in (10**6, 10**8):
        scene, before = SlabScene(particles), float("inf")
        for cores in (1, 4, 16, 64, 256, 1024):
            step = model(MEASURED, scene, cores)
            assert step.ranks <= scene.planes and step.ranks * step.threads <= cores
            assert step.seconds <= before
            before = step.seconds


def test_a_slow_network_binds():
    slow = MEASURED._replace(bandwidth=2e8)
    step = model(slow, SlabScene(10**7), 64)
    assert step.messages > step.compute


def test_the_page_shows_the_model():
    shown = PAGE.read_text(encoding="utf-8").partition("<!-- model: begin -->\n")[2]
    assert shown.partition("\n<!-- model: end -->")[0].splitlines() == list(table())
