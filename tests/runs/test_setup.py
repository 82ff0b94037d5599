"""The start: who compiles, who loads, and what a marker in the cache is worth."""

import json

import numpy as np
import pytest
from drafts import SQUARE, draft
from jobs import mpirun

from psph.runs import setup
from psph.scene import Scene
from psph.simulation.plan import make_plan

LINE = """
scheme = "sph"
space = { dimensions = 1, spacing = 0.1 }
time.end = 1e-3
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0], upper = [4.0] }
"""

SCRIPT = """
import json, sys
from pathlib import Path

from mpi4py import MPI
from numba.core import event

from psph.case import load
from psph.runs.start import run

case, folder = sys.argv[1:]
with event.install_recorder("numba:compile") as compilations:
    run(load(Path(case)), Path(folder), MPI.COMM_WORLD)
begun = [e for _, e in compilations.buffer if e.is_start]
counts = MPI.COMM_WORLD.gather(len(begun))
if MPI.COMM_WORLD.rank == 0:
    print(json.dumps(counts))
"""


def compilations(ranks, folder, cache, more=""):
    """How many loops each rank compiled for a short run."""
    script = folder / "script.py"
    case = folder / "line.toml"
    script.write_text(SCRIPT)
    case.write_text(more + LINE)
    out = folder / f"run{len(list(folder.iterdir()))}"
    job = mpirun(ranks, [script, case, out], env={"PSPH_CACHE": str(cache)})
    assert job.returncode == 0, job.stderr
    return json.loads(job.stdout.splitlines()[-1])


@pytest.mark.long
def test_the_ranks_share_the_compiling_and_load_the_rest(tmp_path):
    cache = tmp_path / "cache"
    first, second = compilations(2, tmp_path, cache)
    assert first > 0 and second > 0
    loops = [path.name for path in cache.glob("*/*.loop")]
    assert sum("sum_over_neighbours" in name for name in loops) > 0
    assert len(loops) == len(set(loops))
    [ready] = cache.glob("*/*.ready")
    assert compilations(2, tmp_path, cache) == [0, 0]
    assert compilations(2, tmp_path, cache, "checkpoint.every = 1\n") == [0, 0]

    # Without a marker rank 0 looks first; a wrong one costs what is missing, on every rank.
    ready.unlink()
    assert compilations(2, tmp_path, cache) == [0, 0]
    assert ready.exists()
    for kept in cache.rglob("*permute*"):
        kept.unlink()
    assert compilations(2, tmp_path, cache) == [1, 1]


class Caught(Exception):
    """In place of the rehearsal's first step."""


def test_the_two_particles_of_the_rehearsal_are_as_large_as_those_of_the_scene(tmp_path, monkeypatch):
    """With a density of 1 for 1000 kg/m³ a fourth power overflowed in single precision: every closed
    box in mixed precision with the default scheme ended before its first step."""

    def catch(scene, plan, store, *rest):
        raise Caught(store)

    monkeypatch.setattr(setup, "Simulation", catch)
    oil = "fluids.oil={shape={box={lower=[2.0,0.0],upper=[3.0,1.0]}}, density=800.0}"
    for overrides in ((), (oil,)):  # the mass is a constant of the scene, or an array
        scene = Scene(draft(tmp_path, SQUARE, *overrides))
        plan = make_plan(scene)
        with pytest.raises(Caught) as caught:
            setup._rehearse(scene, plan, setup.Store(2, plan.stored, plan.constants, plan.view))
        [store] = caught.value.args
        volumes = store.owned_rows("mass") / store.owned_rows("density")
        assert volumes == pytest.approx(np.full(2, scene.spacing**2))
