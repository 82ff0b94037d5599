"""Random small scenes have the same bits however they are run: ranks, slabs, overlap, threads,
output, checkpoints."""

import json
import os
from pathlib import Path

import pytest
from jobs import mpirun
from long import long_but_for, tell
from parallel.scenes import FAMILIES, scene
from remedies import FILES, beside

TESTS = Path(__file__).parents[1]
SHORT = ("tank",)


def told(folder, steps):
    """What the scenes in a folder came to."""
    search = os.pathsep.join([str(TESTS), str(TESTS.parent)])
    job = mpirun(
        7,
        [TESTS / "parallel" / "alike.py", folder, steps],
        timeout=900,
        env={"PYTHONPATH": search},
    )
    assert job.returncode == 0, job.stderr
    return [json.loads(line) for line in job.stdout.splitlines()]


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for(SHORT, FAMILIES))
def test_same_bits_however_it_is_run(name, tmp_path):
    seeds = range(1 if name in SHORT else 4)
    beside(tmp_path, *FILES)
    for seed in seeds:
        path = tmp_path / f"{seed}.toml"
        path.write_text(scene(FAMILIES[name], 1000 * list(FAMILIES).index(name) + seed))
    found = told(tmp_path, 30)
    assert len(found) == len(seeds) and any(one["rebuilds"] > 1 for one in found)
    for one in found:
        print(one["scene"], one["particles"], "particles,", one["rebuilds"], "rebuilds")
        digests = one["digests"]
        assert {key.split()[-1] for key in digests} == {"1", "2", "3", "4", "7"}
        control = {key: digests.pop(key) for key in list(digests) if key.startswith("nudged")}
        expected = digests["plain on 1"]
        assert "blew up" not in expected
        assert {key: x for key, x in digests.items() if x != expected} == {}
        assert len(set(control.values())) == 1 and expected not in control.values()
        tell("random scenes, each on 1, 2, 3, 4 and 7 ranks")
        tell("runs of them, alike bit by bit", len(digests))
