"""Ranks that die, disks that fill up: nothing is lost but the work since the last checkpoint."""

import numpy as np
import pytest
from jobs import mpirun
from long import LONG
from runs.faults import OFTEN, Trials, blows, table

pytestmark = pytest.mark.alone


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """A case with many frames and checkpoints, and the folder of its run that never stopped."""
    folder = tmp_path_factory.mktemp("box")
    (folder / "box.toml").write_text(OFTEN, encoding="utf-8")
    job = mpirun(1, ["-m", "psph", folder / "box.toml", "--out", folder / "run"])
    assert job.returncode == 0, job.stderr
    return folder / "box.toml", folder / "run"


def test_a_killed_rank_ends_the_job_and_loses_nothing(box, tmp_path):
    trials = Trials(*box, tmp_path, np.random.default_rng(1))
    aimed = [("a frame is being laid out", 5), ("messages travel", 4), ("a checkpoint is sealed", 2)]
    trials.go([*aimed, None])
    assert len(trials.fell) >= 3 and trials.finished >= 1


@LONG
@pytest.mark.timeout(1800)
def test_ranks_killed_everywhere_and_at_random(box, tmp_path, capsys):
    trials = Trials(*box, tmp_path, np.random.default_rng(6))
    trials.go(blows(trials.random, aimed=60, at_random=80))
    with capsys.disabled():
        print("", *table(trials.fell), f"{trials.finished} runs came to their end", sep="\n")
    assert len(trials.fell) >= 100
    assert {"step", "halo", "frame", "checkpoint"} <= {fell.phase for fell in trials.fell}
