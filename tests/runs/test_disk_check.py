"""A run whose files do not fit on the disk is refused before it writes any."""

from collections import namedtuple

import pytest
from drafts import draft
from mpi4py import MPI
from runs.guarded import BOX

from psph.runs import disk_check
from psph.runs.disk_check import TooLittleDisk, check_disk
from psph.runs.forecast import forecast
from psph.runs.output_size import bytes_of_run
from psph.runs.start import run
from psph.scene import Scene
from psph.simulation.plan import make_plan

Usage = namedtuple("Usage", "free")


def with_free(monkeypatch, free):
    monkeypatch.setattr(disk_check.shutil, "disk_usage", lambda folder: Usage(free))


@pytest.fixture
def needed(tmp_path):
    """A case, its scene and plan, and the bytes of its run."""
    case = draft(tmp_path, BOX, "output.frames=0.005")
    scene = Scene(case)
    plan = make_plan(scene)
    return case, scene, plan, bytes_of_run(scene, plan, forecast(scene, plan, 1).steps)


def test_a_run_that_does_not_fit_leaves_no_trace_and_one_that_does_runs(needed, tmp_path, monkeypatch):
    case, _, _, size = needed
    folder = tmp_path / "run"
    with_free(monkeypatch, size - 1)
    with pytest.raises(
        TooLittleDisk, match=r"case\.toml: output\.frames: .* free in .*: make space, or"
    ) as no:
        run(case, folder, MPI.COMM_SELF, say=lambda *_: None)
    assert no.value.exit_code == 2 and not folder.exists()
    with_free(monkeypatch, size)
    run(case, folder, MPI.COMM_SELF, say=lambda *_: None)
    written = sum(path.stat().st_size for path in folder.glob("*.h5"))
    assert 0.4 * size < written <= size  # one checkpoint at the end, where room is kept for three


def test_what_is_replaced_counts_as_free_and_what_is_done_needs_no_room(needed, tmp_path, monkeypatch):
    _, scene, plan, size = needed
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "case.h5").write_bytes(bytes(1000))
    with_free(monkeypatch, size - 1000)
    check_disk(scene, plan, folder, MPI.COMM_SELF)
    with pytest.raises(TooLittleDisk):
        check_disk(scene, plan, tmp_path / "elsewhere" / "deep", MPI.COMM_SELF)
    half = scene.case.time.end / 2
    left = bytes_of_run(scene, plan, forecast(scene, plan, 1).steps, half)
    with_free(monkeypatch, left)
    check_disk(scene, plan, folder, MPI.COMM_SELF, half)
    with_free(monkeypatch, left - 1)
    with pytest.raises(TooLittleDisk):
        check_disk(scene, plan, folder, MPI.COMM_SELF, half)
