"""Random small scenes have the same bits however they are run: ranks, slabs, overlap, threads,
output, checkpoints."""

import copy
import json
import os
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from invariances.scenes import SCENES
from invariances.streams import STREAMS
from jobs import mpirun
from long import long_but_for, tell
from parallel import gas_scenes, refined_scenes
from parallel.scenes import FAMILIES, scene
from remedies import FILES, beside

TESTS = Path(__file__).parents[1]
SHORT = ("tank", "stream")


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


@pytest.mark.landing
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for(SHORT, FAMILIES))
def test_same_bits_however_it_is_run(name, tmp_path):
    seeds = range(1 if name in SHORT else 4)
    beside(tmp_path, *FILES)
    for seed in seeds:
        path = tmp_path / f"{seed}.toml"
        path.write_text(scene(FAMILIES[name], 1000 * list(FAMILIES).index(name) + seed))
    all_alike(told(tmp_path, 30), len(seeds))


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for((), gas_scenes.FAMILIES))
def test_gases_of_many_sizes_have_the_same_bits_however_they_are_run(name, tmp_path):
    """Between mirrors, in periods, and under their own pull by a tree, softened by size."""
    for seed in range(2):
        (tmp_path / f"{seed}.toml").write_text(gas_scenes.scene(gas_scenes.FAMILIES[name], seed))
    all_alike(told(tmp_path, 16), 2)


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for((), refined_scenes.FAMILIES))
def test_finer_regions_have_the_same_bits_however_they_are_run(name, tmp_path):
    """Coarse and fine ones with steps of their own; regions that rest, in a stream too, go with a front or with a body."""
    for seed in range(2):
        (tmp_path / f"{seed}.toml").write_text(refined_scenes.scene(refined_scenes.FAMILIES[name], seed))
    all_alike(told(tmp_path, 20), 2)


TENSE = [name for name, one in SCENES.items() if "surface_tension" in str(one)]
"""Scenes whose surfaces pull."""


def with_a_gap(tables, axis):
    """A scene cut along ``axis``, with more of its first matter 6 m on, so that ranks between have no particle;
    mirrors, which are without end, become walls."""
    found = copy.deepcopy(tables) | {"parallel": {"axis": axis}}
    matter = found.get("soils") or found["fluids"]
    name, far = next(iter(matter.items()))
    way = np.where([one == axis for one in "xy"], 6.0, 0.0)
    box = {"lower": way.tolist(), "upper": (way + [1.5, 0.5]).tolist()}
    for wall in found.get("walls", {}).values():
        wall.pop("condition", None)
    matter[name] = {**far, "shape": {"union": [far["shape"], {"box": box}]}}
    return found


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for((), [name for name in SCENES if "soils" in SCENES[name]]))
def test_soils_beside_walls_and_bodies_have_the_same_bits_however_they_are_run(name, tmp_path):
    for axis in "xy":
        (tmp_path / f"{axis}.toml").write_text(tomli_w.dumps(with_a_gap(SCENES[name], axis)))
    all_alike(told(tmp_path, 30), 2)


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", long_but_for((), (*STREAMS, *TENSE)))
def test_streams_and_tensions_have_the_same_bits_however_they_are_run(name, tmp_path):
    cut = STREAMS[name] | {"parallel": {"axis": "x"}} if name in STREAMS else with_a_gap(SCENES[name], "x")
    (tmp_path / "x.toml").write_text(tomli_w.dumps(cut))
    all_alike(told(tmp_path, 60), 1)


def all_alike(found, scenes):
    """One digest however a scene was run, another for the control."""
    assert len(found) == scenes and any(one["rebuilds"] > 1 for one in found)
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
