"""Solids in both descriptions: the rows, what some of them do, and the counts of what they cost."""

import pytest
from long import LONG
from mpi4py import MPI

from psph.case import load
from psph.case.updated import updated_in
from psph.lab.battery.command import CASES, _run
from psph.lab.battery.measures import MEASURES
from psph.lab.battery.solid_kinds import REMEDIES, SHOWN, SOLIDS, TRIALS
from psph.lab.battery.solid_measures import operations
from psph.scene import Scene
from psph.simulation.plan import make_plan

[STRIP] = [one for one in TRIALS if one.name == "strip"]
BARE = "updated, no artificial stress"


def case_of(trial, column):
    return load(CASES / f"{trial.case}.toml", trial.overrides(column))


@pytest.mark.parametrize("trial", TRIALS, ids=lambda trial: trial.name)
def test_every_column_fits_every_trial(trial):
    assert {name for shown in SHOWN.values() for name in shown} <= MEASURES.keys()
    for column in trial.columns:
        case = case_of(trial, column)
        assert bool(updated_in(case)) == (column in REMEDIES) == (case.scheme == "solid")
        assert (case.physics.artificial_stress is None) == (column == BARE or not updated_in(case))
        assert not updated_in(case) or case.physics.contact is None


def test_operations_are_those_of_all_neighbours_in_all_passes():
    total, updated, bare = (case_of(STRIP, name) for name in ("total", "updated", BARE))
    counts = [operations(Scene(case), make_plan(Scene(case))) for case in (total, updated, bare)]
    assert 1000.0 < counts[0] < counts[2] < counts[1] < 4000.0


def run(column, folder):
    return _run(MPI.COMM_SELF, STRIP, column, folder)


@pytest.mark.timeout(300)
def test_a_pulled_strip_tears_without_artificial_stress_alone(tmp_path):
    held, torn = run("updated", tmp_path), run(BARE, tmp_path)
    assert held.verdict == "holds" and held.found["pieces"] == 1.0 and held.found["near_least"] > 0.9
    assert torn.verdict in ("fails", "blew up") and torn.found["pieces"] > 1.0
    total = run("total", tmp_path)
    assert total.verdict == "good" and abs(total.found["drift"]) < 1e-3


@LONG
@pytest.mark.timeout(1800)
def test_the_table_stands(tmp_path):
    """Every cell that docs/lagrangian.md tells of in words."""
    rows = {(t.name, c): _run(MPI.COMM_SELF, t, c, tmp_path) for t in SOLIDS.trials for c in t.columns}
    assert all(rows[t.name, "total"].verdict == "good" for t in TRIALS)
    assert abs(rows["plate", "updated, corrected gradients"].found["period_error"]) < 0.12
    assert rows["spin", "updated"].found["kinetic"] > 0.93
    assert rows["spin", BARE].found["pieces"] > 5.0
    assert rows["rings", "updated"].found["pieces"] == 2.0 and rows["rings", BARE].found["pieces"] > 5.0
