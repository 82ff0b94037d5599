"""Long runs hold no more memory, files and messages at their end than at their beginning."""

import json
from pathlib import Path

import pytest
from jobs import mpirun
from long import LONG, tell, tell_most

pytestmark = pytest.mark.timeout(600)  # two ranks on a busy machine wait for each other
WATCHED = Path(__file__).with_name("growth.py")
MOST = {"bytes": 1_000_000, "files": 0, "requests": 0, "objects": 300}
"""What may be more at the end than after a tenth of the run, 10,000 steps or more; a sample is an object, and
memory comes from the system in pieces of half a megabyte."""


def growth(folder, ranks, steps, *how, timeout=550):
    """What grew by how much from a tenth of the steps on, and how often lists were made."""
    job = mpirun(ranks, [WATCHED, folder, steps, *how], timeout=timeout)
    assert job.returncode == 0, job.stderr
    told = json.loads(job.stdout.splitlines()[-1])
    settled = [sample for sample in told["samples"] if sample["steps"] >= steps // 10]
    assert len(settled) > 80 and settled[-1]["steps"] == steps
    return {name: settled[-1][name] - settled[0][name] for name in MOST}, told["rebuilds"]


@pytest.mark.parametrize(
    ("ranks", "steps"),
    [
        (1, 10_000),
        pytest.param(2, 1_000, marks=LONG),
        pytest.param(1, 1_000_000, marks=[LONG, pytest.mark.timeout(1500)]),
        pytest.param(2, 50_000, marks=[LONG, pytest.mark.timeout(1500)]),
    ],
)
def test_nothing_grows(tmp_path, ranks, steps):
    grown, rebuilds = growth(tmp_path, ranks, steps, timeout=1500)
    assert rebuilds > steps // 150
    assert all(grown[name] <= most for name, most in MOST.items()), grown
    tell("steps of runs whose memory was watched", steps)
    tell_most("growth of memory in such a run after its first tenth, bytes", grown["bytes"])


@LONG
def test_a_leak_would_be_seen(tmp_path):
    grown, _ = growth(tmp_path, 1, 20_000, "leak")
    assert grown["bytes"] > 2 * MOST["bytes"]
