"""Guards and the post-mortem where particles are of several sizes: each is seen at its own."""

from pathlib import Path

import numpy as np
import pytest
from drafts import draft
from jobs import mpirun
from mpi4py import MPI
from runs.guarded import started
from runs.resuming import steps
from runs.test_guards import report_of

from psph.output.pictures import closeup
from psph.runs.guards import Guards
from psph.runs.post_mortem import PICTURE, REPORT
from psph.runs.worst_particle import _shares, find
from psph.scene import Scene

COMM = MPI.COMM_SELF

TANK = """
time.end = 0.1
physics.gravity = [0.0, -9.81]
[space]
dimensions = 2
spacing = 0.05
[[space.refine]]
shape.box = { lower = [0.5, -0.2], upper = [1.2, 1.0] }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.15, -0.15], upper = [1.15, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.8] } }]
"""

TOO_LONG = "time.step=1.5e-3"
"""It blows up in the finer region within some steps."""


def of_level(simulation, level, follows=False):
    """The ids of the fluid of a level that leads, or follows."""
    table = simulation.plan.materials
    own = table.where(lambda one: one.is_fluid and one.level == level and one.follows == follows)
    return simulation.store.shown("id")[own[simulation.store.shown("group")]]


def suspected(simulation, scene, number):
    return find(simulation, scene, (simulation.store.shown("id") == number).astype(float))


@pytest.mark.parametrize("level", [0, 1])
def test_the_shares_add_up_on_every_level_and_would_not_with_the_numbers_of_the_coarsest(level, tmp_path):
    case = draft(tmp_path, TANK)
    simulation, scene, off = steps(case, COMM, 24), Scene(case), []
    for number in of_level(simulation, level)[::37][:5]:
        suspect = suspected(simulation, scene, number)
        assert suspect.level == level and suspect.scene.spacing == 0.05 * 0.5**level
        told = suspect.value("acceleration")
        size = max(np.linalg.norm(share.acceleration) for share in suspect.shares)
        assert np.allclose(sum(one.acceleration for one in suspect.shares), told, rtol=0, atol=1e-9 * size)
        coarse = _shares(simulation, scene, simulation.plan, suspect.around, suspect.column, suspect.offset)
        off.append(np.linalg.norm(sum(one.acceleration for one in coarse) - told) / size)
    assert max(off) > 0.1 if level else max(off) < 1e-9


def test_who_follows_is_said_to(tmp_path):
    case = draft(tmp_path, TANK)
    simulation, scene = steps(case, COMM, 4), Scene(case)
    suspect = suspected(simulation, scene, of_level(simulation, 1, follows=True)[0])
    assert suspect.follows and not suspect.shares and suspect.hardest() is None
    assert suspect.kind(suspect.column) == "fluid that follows"
    assert "(level 1, 0.025 m)" in suspect.name


def test_a_blow_up_names_the_size_and_who_leads(tmp_path):
    """One who follows may be as fast, but has it from others."""
    trouble, _ = started(draft(tmp_path, TANK, TOO_LONG), tmp_path / "run", COMM)
    text, table = report_of(tmp_path / "run")
    assert " (level 1, 0.025 m) " in str(trouble) and "pushed hardest by" in str(trouble)
    assert table["level of sizes"] == "1, spacing 0.025 m" and table["particle"].endswith(", fluid")
    assert "of its size, dx = 0.025 m within the support (2.8 dx)" in text and "buffer" not in text
    step = float(text.split("would allow ")[1].split(" s")[0])
    assert step < 0.5 * 1.4 * 0.025 / Scene(draft(tmp_path, TANK)).sound_speed  # h/c of the finer ones
    assert (tmp_path / "run" / PICTURE).stat().st_size > 10_000


def test_it_is_the_same_on_two_ranks(tmp_path):
    case, told = Path(draft(tmp_path, TANK).file), []
    for ranks in (1, 2):
        out = tmp_path / "run"  # the report names it
        job = mpirun(ranks, ["-m", "psph", str(case), "--set", TOO_LONG, "--out", str(out), "--overwrite"])
        assert "blew up" in job.stderr
        told.append((out / REPORT).read_bytes())
    assert told[0] == told[1]


def test_the_picture_shows_one_size(tmp_path, monkeypatch):
    drawn, honest = [], closeup.circles

    def watched(axes, places, wide, **how):
        drawn.append(wide)
        return honest(axes, places, wide, **how)

    monkeypatch.setattr(closeup, "circles", watched)
    started(draft(tmp_path, TANK, TOO_LONG), tmp_path / "run", COMM)
    assert set(drawn) == {0.025}


def test_depth_behind_a_wall_counts_in_spacings_of_the_particle(tmp_path):
    """Three quarters of a coarse spacing are one and a half of the finer."""
    case = draft(tmp_path, TANK)
    simulation, scene = steps(case, COMM, 1), Scene(case)
    guards = Guards(scene, simulation, None, tmp_path, lambda line: None)
    store = simulation.store
    position = store.data[store.rows["position"].start : store.rows["position"].stop, store.inner]
    for level, hidden in ((0, False), (1, True)):
        at = np.flatnonzero(store.shown("id") == of_level(simulation, level)[0])[0]
        kept = position[:, at].copy()
        position[:, at] = 0.25 if level == 0 else 0.75, -0.0375
        assert guards._hidden()[at] == hidden and guards._hidden().sum() == hidden
        position[:, at] = kept
