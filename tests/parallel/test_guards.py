"""The post-mortem is the same on any number of ranks, and all ranks end together."""

import numpy as np
import pytest
from mpi4py import MPI
from runs.guarded import THROWN, boxed, started

from psph.runs.post_mortem import REPORT
from psph.runs.start import run
from psph.simulation.step import BlowUp, Simulation

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


def ends(folder, *lines):
    """(what the run raised, the report) on all ranks, and on this one alone."""
    found = []
    for name, comm in (("together", COMM), (f"rank{COMM.rank}", MPI.COMM_SELF)):
        trouble, said = started(boxed(folder, COMM, *lines), folder / name, comm)
        COMM.Barrier()
        text = (folder / name / REPORT).read_text(encoding="utf-8")
        found.append((str(trouble).replace(name, "X"), text.replace(name, "X"), trouble))
    return found


@pytest.mark.parametrize(
    "lines",
    [
        THROWN,
        [*THROWN, "guards.speed=100.0", "guards.density=1e9", "guards.energy=1e9", "time.step=2e-4"],
        ["fluids.water.pressure=6e4"],  # many are equally bad: the lowest id
    ],
    ids=["speed", "depth", "density"],
)
def test_the_report_does_not_tell_the_number_of_ranks(lines, mpi_tmp_path):
    together, alone = ends(mpi_tmp_path, *lines)
    assert isinstance(together[2], BlowUp) and len(set(COMM.allgather(together[0]))) == 1
    assert together[:2] == alone[:2]


def test_one_rank_that_has_no_number_ends_all(mpi_tmp_path, monkeypatch):
    honest = Simulation.step

    def injured(self, *end):
        store = self.store
        if self.steps == 5:
            mine = np.flatnonzero(store.id[store.inner] == 60)
            store["velocity"][0][store.low + mine] = np.nan
        honest(self, *end)

    monkeypatch.setattr(Simulation, "step", injured)
    together, alone = ends(mpi_tmp_path)
    assert "step 6, " in together[0] and "particle 60 has a position" in together[0]
    assert together[:2] == alone[:2]


def test_warnings_are_the_same(mpi_tmp_path):
    lines = ["time.step=2e-4", "time.end=0.004", *THROWN, "guards.on_trouble=warn"]
    said = {}
    for name, comm in (("together", COMM), (f"rank{COMM.rank}", MPI.COMM_SELF)):
        trouble, told = started(boxed(mpi_tmp_path, COMM, *lines), mpi_tmp_path / name, comm)
        assert trouble is None
        said[name] = [line for line in told if line.startswith(("warning: step", "guards."))]
    together, alone = said.values()
    assert together == alone and len(together) > 3


def test_all_ranks_agree_on_what_a_run_took(mpi_tmp_path):
    """A study decides by it, on every rank, whether to run once more."""
    case = boxed(mpi_tmp_path, COMM, "time.end=0.01")
    took = run(case, mpi_tmp_path / "run", COMM, say=lambda line, where=None: None)[1:]
    assert COMM.allgather(took) == [took] * COMM.size
