"""A run with geometry files keeps them, and goes on with them; and the hull that is shipped."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from drafts import POOL, draft
from jobs import clean_environment
from mpi4py import MPI
from runs.resuming import stop_after
from scene.solids import cube

from psph.case import load
from psph.lab.study import runs
from psph.output.checkpoint import CheckpointError
from psph.output.errors import OutputError
from psph.output.pictures.plot import plot
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import resume, run
from psph.runs.watch import Stopped
from psph.simulation.step import BlowUp

COMM = MPI.COMM_SELF
QUIET = {"say": lambda line, where=None: None}
MESHES = Path(__file__).parents[2] / "run/cases/meshes"


@pytest.fixture
def case(tmp_path):
    """POOL with a post that is a cube of 0.4 m."""
    (tmp_path / "parts").mkdir()
    cube(0.0, 400.0).export(tmp_path / "parts/post.stl")
    return draft(tmp_path, POOL, "checkpoint.every=4", "output.frames=0.01")


def stopped(monkeypatch, case, folder):
    """A run that is told to stop in its fifth step."""
    with monkeypatch.context() as patch, pytest.raises(Stopped):
        stop_after(patch, 5)
        run(case, folder, COMM, **QUIET)


def test_a_run_keeps_its_meshes_and_goes_on_with_them(tmp_path, monkeypatch, case):
    run(case, tmp_path / "whole", COMM, **QUIET)
    assert (tmp_path / "whole/parts/post.stl").read_bytes() == (tmp_path / "parts/post.stl").read_bytes()
    stopped(monkeypatch, case, tmp_path / "run")
    (tmp_path / "parts/post.stl").unlink()  # the copy is what counts
    resume(tmp_path / "run", COMM, **QUIET)
    whole, again = (Run(tmp_path / name) for name in ("whole", "run"))
    assert (whole.folder / "log.csv").read_bytes() == (again.folder / "log.csv").read_bytes()
    one, other = whole.frame(-1), again.frame(-1)
    assert one["position"].any() and one.keys() == other.keys()
    assert all(np.array_equal(one[name], other[name]) for name in one)


BEACH = """
[space]
dimensions = 2
spacing = 0.05
[time]
end = 0.02
[physics]
gravity = [0.0, -9.81]
[fluids.water]
density = 1000.0
shape.difference = { from = { box = { lower = [0, 0], upper = [1, 0.5] } }, minus = [{ height_map = { file = "parts/bed.csv", bottom = -0.2 } }] }
[walls.bed]
shape.height_map = { file = "parts/bed.csv", bottom = -0.2 }
[walls.side]
condition = "mirror"
shape.box = { lower = [-0.2, -0.2], upper = [0.0, 1.0] }
"""


def test_a_run_keeps_its_ground_and_is_drawn_with_it(tmp_path, monkeypatch):
    (tmp_path / "parts").mkdir()
    bed = tmp_path / "parts/bed.csv"
    bed.write_text("x,y\n0,0\n0.5,0\n1.5,0.6\n")
    case = draft(tmp_path, BEACH, "checkpoint.every=4")
    run(case, tmp_path / "whole", COMM, **QUIET)
    stopped(monkeypatch, case, tmp_path / "run")
    bed.unlink()  # the copy is what counts
    resume(tmp_path / "run", COMM, **QUIET)
    logs = [(tmp_path / name / "log.csv").read_bytes() for name in ("whole", "run")]
    assert logs[0] == logs[1]
    assert plot(tmp_path / "run")
    stopped(monkeypatch, load(tmp_path / "whole/case.toml"), tmp_path / "again")
    (tmp_path / "again/parts/bed.csv").write_text("x,y\n0,0\n1.5,0.6\n")
    with pytest.raises(CheckpointError, match="belongs to another case"):
        resume(tmp_path / "again", COMM, **QUIET)


def test_a_changed_mesh_is_another_case(tmp_path, monkeypatch, case):
    stopped(monkeypatch, case, tmp_path / "run")
    cube(0.0, 300.0).export(tmp_path / "run/parts/post.stl")
    with pytest.raises(CheckpointError, match="belongs to another case"):
        resume(tmp_path / "run", COMM, **QUIET)


def test_another_file_of_that_name_is_not_lost(tmp_path, case):
    (tmp_path / "run/parts").mkdir(parents=True)
    (tmp_path / "run/parts/post.stl").write_text("mine")
    with pytest.raises(OutputError, match="parts/post.stl is another than the case uses and would be lost"):
        run(case, tmp_path / "run", COMM, **QUIET)


def test_a_result_of_a_study_is_used_again_only_with_the_same_mesh(tmp_path, monkeypatch, case):
    performed = []

    def blows_up(*_, **__):
        performed.append(1)
        raise BlowUp("too fast")

    monkeypatch.setattr(runs, "run", blows_up)
    for size in (400.0, 400.0, 300.0):
        cube(0.0, size).export(tmp_path / "parts/post.stl")
        again = load(tmp_path / "case.toml")
        assert runs.perform(again, tmp_path / "out", alone(), 1, print)["status"] == "too fast"
    assert len(performed) == 2


def test_the_hull_is_what_its_script_draws(tmp_path):
    script = tmp_path / "hull.py"
    script.write_text((MESHES / "hull.py").read_text(encoding="utf-8"), encoding="utf-8")
    subprocess.run([sys.executable, str(script)], check=True, env=clean_environment(), timeout=60)
    assert (tmp_path / "hull.stl").read_bytes() == (MESHES / "hull.stl").read_bytes()
    assert (MESHES / "hull.stl").stat().st_size < 200_000
