"""Walls that no water touches bear nothing, and probes without water in reach say so."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.fields import WALL
from psph.output.reader import Run
from psph.runs.start import run
from psph.simulation import neighbourhood as neighbourhood_module
from psph.simulation import wetting as wetting_module

DX, DEPTH = 0.02, 0.3

DAM = """
title = "Water beside a wall with nothing on the other side"
space = { dimensions = 2, spacing = 0.02 }
time.end = 0.12
[output]
frames = 0.06
probes = 0.01
[physics]
gravity = [0.0, -9.8]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.4, 0.3] }
pressure = "hydrostatic"
[walls.basin]
shape.union = [
    { box = { lower = [-0.08, -0.08], upper = [0.8, 0.0] } },
    { box = { lower = [-0.08, 0.0], upper = [0.0, 0.4] } },
    { box = { lower = [0.4, 0.0], upper = [0.48, 0.4] } },
]
[probes.wet]
position = [0.39, 0.1]
fields = ["pressure"]
[probes.floor]
position = [0.2, 0.0]
fields = ["pressure"]
[probes.behind]
position = [0.49, 0.1]
fields = ["pressure", "velocity"]
[probes.dry_floor]
position = [0.64, 0.01]
fields = ["pressure"]
"""


def reach_of(frame):
    """For each wall particle the distance to the nearest fluid, m; and ρ/ρ₀ − 1 there."""
    from scipy.spatial import cKDTree

    wall = frame["kind"] == WALL
    apart, _ = cKDTree(frame["position"][~wall]).query(frame["position"][wall])
    return apart, frame["density"][wall] / 1000.0 - 1.0


@pytest.fixture(scope="module")
def still(tmp_path_factory):
    """A run of still water beside a wall of four layers, and what it said."""
    folder, said = tmp_path_factory.mktemp("dry"), []
    run(draft(folder, DAM), folder / "out", MPI.COMM_SELF, say=lambda line, *_: said.append(line))
    return Run(folder / "out"), said


def test_a_probe_without_water_in_reach_says_so(still):
    finished, said = still
    table = finished.probes()
    assert np.isnan(table["behind.velocity_x"]).all()
    assert not table["behind.pressure"].any() and not table["dry_floor.pressure"].any()
    rows = len(table["time"])
    for name in ("behind", "dry_floor"):
        where = "where probes.csv has 0 for a pressure, else nan"
        assert f"probe {name}: no fluid in reach in {rows} of {rows} rows, {where}" in said
    assert not any(line.startswith(("probe wet", "probe floor")) for line in said)
    assert np.abs(table["wet.pressure"] / (9800.0 * (DEPTH - 0.1)) - 1.0).max() < 0.02
    assert np.abs(table["floor.pressure"] / (9800.0 * DEPTH) - 1.0).max() < 0.02


def test_walls_out_of_reach_of_the_water_have_their_rest_density(still):
    finished, _ = still
    for k in (1, 2):
        apart, strain = reach_of(finished.frame(k))
        assert (strain[apart > 2.8 * 1.1 * DX] == 0.0).all()
        assert (strain[apart < 1.1 * DX] > 0.0).mean() > 0.9


def test_a_wall_forgets_the_water_that_has_left(tmp_path):
    """A drop is thrown up from the floor: what pressed on it there is gone with it."""
    case = draft(
        tmp_path,
        DAM,
        "walls.basin.shape={box={lower=[-0.2, -0.08], upper=[0.6, 0.0]}}",
        "fluids.water.velocity=[0.0, 3.0]",
        "fluids.water.pressure=0",
        "probes=off",
        "fluids.water.shape.box.upper=[0.4, 0.1]",
        "time.end=0.06",
    )
    run(case, tmp_path / "out", MPI.COMM_SELF, say=lambda *_: None)
    apart, strain = reach_of(Run(tmp_path / "out").frame(-1))
    assert apart.min() > 2.6 * 1.1 * DX
    assert (strain == 0.0).all()


RUNNING = "fluids.water.shape.box.upper=[0.2, 0.3]"
"""The same water half as wide: it runs over a dry floor against a dry wall."""


def frames_of(folder, *sets):
    """Every field of every frame of a run, and how many rows of its lists were empty at the end."""
    finished = run(draft(folder, DAM, *sets), folder / "out", MPI.COMM_SELF, say=lambda *_: None)
    lengths = finished.simulation.domain.lists.lengths[: finished.simulation.store.owned]
    found = Run(folder / "out")
    return [found.frame(k) for k in range(len(found.times))], np.count_nonzero(lengths == 0)


def test_that_nothing_is_summed_for_dry_walls_changes_next_to_nothing(tmp_path, monkeypatch):
    """Until an impact makes much of the fluid between 0.95 of the support of a dry wall and its end."""
    sets = ("scheme=sph", RUNNING, "probes=off")
    for name in ("rests", "sums"):
        (tmp_path / name).mkdir()
    frames, idle = frames_of(tmp_path / "rests", *sets)
    monkeypatch.setattr(wetting_module, "find_resting", lambda first, last, *rest: None)
    monkeypatch.setattr(neighbourhood_module, "_sought", lambda *_: None)
    same, none = frames_of(tmp_path / "sums", *sets)
    assert idle > 20 and none == 0 and len(frames) == len(same) == 3
    for one, other in zip(frames, same):
        assert np.abs(one["position"] - other["position"]).max() < 1e-3 * DX
        assert np.abs(one["pressure"] - other["pressure"]).max() < 0.01 * 9800.0 * DEPTH
    walls = frames[-1]["kind"] == WALL
    assert (frames[0]["pressure"][walls] != frames[-1]["pressure"][walls]).any()  # some became wet


FALLING = (
    "walls.basin={shape={box={lower=[-0.2, -0.08], upper=[0.6, 0.0]}}, condition='extrapolated'}",
    "fluids.water.shape.box={lower=[0.0, 0.06], upper=[0.4, 0.16]}",
    "fluids.water.velocity=[0.3, -2.0]",
    "fluids.water.pressure=0",
    "probes=off",
)


def test_a_gauge_of_force_changes_no_bit(tmp_path):
    """And between 0.95 of the support and its end a wall that is dry bears what it gives: momentum stays."""
    alone = start(draft(tmp_path, DAM, *FALLING))
    asked = start(draft(tmp_path, DAM, *FALLING, "gauges.floor.force.on=['basin']"))
    pushed = 0.0
    for _ in range(60):
        alone.step()
        asked.step()
        [(columns, _)] = [*asked.engine.neighbourhood.dry_beside_fluid(0, asked.store.total)] or [([], 0)]
        pushed = max(pushed, *(np.abs(load[columns]).max(initial=0.0) for load in asked.store["load"]))
    for name in ("position", "velocity", "pressure"):
        assert np.array_equal(alone.store.shown(name), asked.store.shown(name)), name
    assert pushed > 0.0


def test_when_lists_are_made_decides_nothing(tmp_path):
    """Water falls on a dry floor, with lists that last for a step, and for long: to rounding the same.  With walls
    that became wet when lists were made, pressures differed by a third of the largest."""
    falling = (
        "walls.basin.shape={box={lower=[-0.2, -0.08], upper=[0.6, 0.0]}}",
        "fluids.water.shape.box={lower=[0.0, 0.06], upper=[0.4, 0.16]}",
        "fluids.water.velocity=[0.3, -2.0]",
        "fluids.water.pressure=0",
        "probes=off",
        "output.frames=0.03",
        "time.end=0.06",
    )
    ends = []
    for name, skin in (("short", 0.001), ("long", 0.5)):
        (tmp_path / name).mkdir()
        frames, _ = frames_of(tmp_path / name, *falling, f"neighbours.skin={skin}")
        ends.append({key: values[np.argsort(frames[-1]["id"])] for key, values in frames[-1].items()})
    one, other = ends
    assert one["pressure"].max() > 1000.0
    assert np.abs(one["position"] - other["position"]).max() < 1e-10 * DX
    assert np.abs(one["pressure"] - other["pressure"]).max() < 1e-6
