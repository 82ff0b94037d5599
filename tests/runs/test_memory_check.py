"""A run that does not fit into the memory is refused before it takes any."""

import pytest
from drafts import draft
from mpi4py import MPI
from runs.test_explain import BOX

from psph.lab.study.runs import perform
from psph.lab.study.study import StudyRuns
from psph.runs import explain as words
from psph.runs import memory_check
from psph.runs.explain import explain
from psph.runs.footprint import bytes_of_rank
from psph.runs.memory_check import TooLittleMemory
from psph.runs.start import run
from psph.scene import Scene
from psph.simulation.plan import make_plan


@pytest.fixture
def needed(tmp_path):
    """The case of 13,824 particles, and what it takes on one rank, bytes."""
    case = draft(tmp_path, BOX)
    scene = Scene(case)
    return case, bytes_of_rank(scene, make_plan(scene), 1)


def test_a_run_that_does_not_fit_leaves_no_trace(needed, tmp_path, monkeypatch):
    case, size = needed
    monkeypatch.setattr(memory_check, "free_memory", lambda: size - 1.0)
    with pytest.raises(TooLittleMemory) as refused:
        run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    assert str(refused.value) == (
        f"{case.name}: 13,824 particles need about {size / 2**30:.1f} GiB on one machine, "
        f"{size / 2**30:.1f} GiB are free there: use more machines, or a larger space.spacing"
    )
    assert refused.value.exit_code == 2
    assert not (tmp_path / "run").exists()


def test_one_that_fits_is_not_refused(needed, monkeypatch):
    case, size = needed
    monkeypatch.setattr(memory_check, "free_memory", lambda: size)
    scene = Scene(case)
    memory_check.check_memory(scene, make_plan(scene), MPI.COMM_SELF)


def test_explain_foresees_it(needed, monkeypatch):
    case, size = needed
    refused = "too much for this machine: "
    for free, said in ((size, False), (size - 1.0, True)):
        monkeypatch.setattr(words, "free_memory", lambda: free)
        assert any(refused in line for line in explain(Scene(case), 1)) == said


@pytest.mark.mpi(min_size=2)
def test_the_ranks_of_a_machine_count_together_and_all_refuse(mpi_tmp_path, monkeypatch):
    """Rank 1 alone sees that there is too little."""
    comm = MPI.COMM_WORLD
    folder = mpi_tmp_path / str(comm.rank)
    folder.mkdir()
    case = draft(folder, BOX)
    scene = Scene(case)
    plan = make_plan(scene)
    together = comm.size * bytes_of_rank(scene, plan, comm.size)
    monkeypatch.setattr(memory_check, "free_memory", lambda: together - (comm.rank == 1))
    with pytest.raises(TooLittleMemory):
        memory_check.check_memory(scene, plan, comm)
    monkeypatch.setattr(memory_check, "free_memory", lambda: together)
    memory_check.check_memory(scene, plan, comm)


HUGE = """
space = { dimensions = 2, spacing = 1e-5 }
time.end = 1.0
physics.gravity = [0.0, -9.8]
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [4.0, 2.0] }
"""
"""8·10¹⁰ sites: to count them takes hours."""


@pytest.mark.timeout(30)
def test_a_lattice_that_no_machine_holds_is_refused_before_its_sites_are_counted(tmp_path):
    case = draft(tmp_path, HUGE)
    for go in (
        lambda: run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None),
        lambda: StudyRuns(case.file, [], [{}], tmp_path / "study", MPI.COMM_SELF),
    ):
        with pytest.raises(
            TooLittleMemory, match=r"case: about 8e\+10 particles need at least 2.24e\+04 GiB"
        ):
            go()


@pytest.mark.timeout(120)
def test_a_rung_of_a_study_that_no_machine_holds_does_not_end_the_others(tmp_path):
    case = draft(tmp_path, HUGE, "space.spacing=0.5", "time.end=0.01")
    study = StudyRuns(
        case.file,
        ["space.spacing=0.5", "time.end=0.01"],
        [{"space.spacing": x} for x in (0.5, 1e-5)],
        tmp_path / "study",
        MPI.COMM_SELF,
    )
    coarse, huge = (
        perform(one, tmp_path / str(k), MPI.COMM_SELF, 1, lambda line: None)
        for k, one in enumerate(study.cases)
    )
    assert coarse["status"] == "done" and huge["status"].startswith("not possible here: case")
