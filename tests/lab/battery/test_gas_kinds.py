"""Ideal gases with and without what broadens shocks: the rows, and what the short ones do."""

import pytest
from long import LONG
from mpi4py import MPI

from psph.case import load
from psph.lab.battery.command import CASES, _run
from psph.lab.battery.gas_kinds import GASES, SHOWN, TRIALS
from psph.lab.battery.measures import MEASURES

OF = {trial.name: trial for trial in TRIALS}
WHOLE, SWITCHED, BARE = "gas", "gas, a switch", "gas, no viscosity"


def run(name, column, folder):
    return _run(MPI.COMM_SELF, OF[name], column, folder)


@pytest.mark.parametrize("trial", TRIALS, ids=lambda trial: trial.name)
def test_every_column_fits_every_trial(trial):
    assert {name for shown in SHOWN.values() for name in shown} <= MEASURES.keys()
    for column in trial.columns:
        physics = load(CASES / f"{trial.case}.toml", trial.overrides(column)).physics
        assert (physics.shock_viscosity is None) == (column == BARE)
        assert column == BARE or (physics.shock_viscosity.least < 1.0) == (column == SWITCHED)


@pytest.mark.timeout(300)
def test_gas_that_parts_before_walls_breaks_without_viscosity(tmp_path):
    held, broken = run("void", WHOLE, tmp_path), run("void", BARE, tmp_path)
    assert held.verdict == "good" and held.found["gas_energy"] < 1e-3
    assert broken.verdict == "blew up"


@pytest.mark.timeout(300)
def test_gas_that_cannot_go_on_ends_its_own_run_alone(tmp_path):
    trial = OF["blast"]._replace(other_end=0.03)
    broken = _run(MPI.COMM_SELF, trial, "gas, long steps", tmp_path)
    assert broken.verdict == "blew up" and "thermal energy is below zero" in broken.status


@pytest.mark.timeout(300)
def test_a_vortex_needs_the_switch(tmp_path):
    kept, lost = run("vortex", SWITCHED, tmp_path), run("vortex", WHOLE, tmp_path)
    assert kept.verdict == "good" and kept.found["kinetic"] > 0.7
    assert lost.verdict == "fails" and lost.found["kinetic"] < 0.2


@LONG
@pytest.mark.timeout(1800)
def test_the_table_stands(tmp_path):
    """What docs/gas.md tells of it."""
    rows = {(t.name, c): run(t.name, c, tmp_path) for t in GASES.trials for c in t.columns}
    assert all(rows[name, WHOLE].verdict == "good" for name in OF if name != "vortex")
    assert all(rows[name, SWITCHED].verdict == "good" for name in OF if name != "blast")
    assert rows["blast", SWITCHED].found["closest"] < 0.1 < rows["blast", WHOLE].found["closest"]
    assert rows["blast", BARE].verdict == "fails" and rows["tube", BARE].verdict == "blew up"
