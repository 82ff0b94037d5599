"""Solids that span three ranks, alone and in a fluid: the same bits on each number of ranks, and resumed on another in
mid-bounce."""

import shutil

import h5py
import numpy as np
import pytest
from cases.measures import by_id
from jobs import mpirun
from long import LONG
from parallel.test_immersion import FLAP
from parallel.test_solids import BEAMS

from psph.output.checkpoint import checkpoints
from psph.output.reader import Run

CROWD = BEAMS.replace("lower = [4.1, -0.6], upper = [4.6, 1.4]", "lower = [4.1, 0.1], upper = [4.4, 1.1]")
"""With a smaller wall, so that the beam reaches into the last third of all particles."""

SHAKEN = FLAP.replace(
    "sinusoid = { amplitude = [0.0, 0.02], period = 0.1 }",
    'series = { file = "hand.csv", displacement = ["x", "y"] }',
)
"""The sheet on water again, with a clamp that follows a table."""

ROWS = "time,x,y\n0,0,0\n0.01,0.002,-0.003\n0.02,0.001,0.004\n0.06,0,0\n"

FINER = SHAKEN.replace("[solids.sheet]", "[solids.sheet]\nspacing = 0.025").replace(
    "[solids.post]", "[solids.post]\nspacing = 0.016666666666666666"
)
"""Both of spacings of their own."""

SCENES = {  # the text, its end in s, and the group of what is on all ranks
    "three bodies of different laws in contact": (CROWD, 0.06, 0),
    "a sheet on water and a post of another law in it": (SHAKEN, 0.05, 1),
    "the same of a half and a third of the spacing": (FINER, 0.05, 1),
}


def psph(ranks, *words):
    job = mpirun(ranks, ["-m", "psph", *words])
    assert job.returncode == 0, job.stderr


def assert_alike(one, other):
    last, rest = by_id(one.frame(-1)), by_id(other.frame(-1))
    assert last.keys() == rest.keys()
    for name in last:
        assert np.array_equal(last[name], rest[name]), name
    assert all((one.folder / t).read_text() == (other.folder / t).read_text() for t in ("log.csv",))


@LONG
@pytest.mark.parametrize("name", SCENES)
def test_solids_span_three_ranks_and_go_on_on_others(name, tmp_path):
    text, end, wide = SCENES[name]
    (tmp_path / "case.toml").write_text(text.replace("time.end = 1.0", f"time.end = {end}"), encoding="utf-8")
    (tmp_path / "hand.csv").write_text(ROWS, encoding="utf-8")
    runs = {}
    for ranks in (1, 2, 3):
        folder = tmp_path / str(ranks)
        psph(ranks, tmp_path / "case.toml", "--out", folder, "--set", "checkpoint.every=20")
        runs[ranks] = Run(folder)
    start = by_id(runs[1].frame(0))
    x, own = start["position"][:, 0], start["group"] == wide
    thirds = np.quantile(x, (1 / 3, 2 / 3))
    assert x[own].min() < thirds[0] and thirds[1] < x[own].max()  # it is on all of three ranks
    assert np.abs(by_id(runs[1].frame(-1))["position"] - start["position"]).max() > 1e-3
    for ranks in (2, 3):
        assert_alike(runs[1], runs[ranks])
    for before, after in ((3, 2), (1, 3), (2, 1)):
        again = tmp_path / f"{before} to {after}"
        shutil.copytree(tmp_path / str(before), again)
        middle = checkpoints(again)[-1]
        if wide == 0:
            with h5py.File(middle) as file:
                assert np.count_nonzero(file["particles/contact_energy"][:]) > 5  # they are in contact
        psph(after, "resume", again, "--from", middle.name)
        assert_alike(runs[1], Run(again))
