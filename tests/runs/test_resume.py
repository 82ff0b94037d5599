"""A run that goes on from a checkpoint has the bits of one that was never stopped."""

from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from drafts import with_its_files
from mpi4py import MPI
from runs.resuming import (
    BOX,
    control,
    go_on_alike,
    keep,
    same_files,
    state,
    steps,
    stop_after,
    taken_up,
    velocity_by_id,
)
from simulation.test_precision import box as precise_box

from psph.case import CaseError, load
from psph.output import checkpoint
from psph.output.checkpoint import CheckpointError, checkpoints
from psph.output.errors import OutputError
from psph.runs.resume import case_digest, take_up
from psph.runs.start import resume, run
from psph.runs.watch import Stopped

CASES = sorted((Path(__file__).parents[2] / "run/cases").glob("*.toml"))
COMM = MPI.COMM_SELF
QUIET = {"say": lambda line, where=None: None}


@pytest.fixture
def case(tmp_path):
    """The boxes that run against each other, from a file."""
    path = tmp_path / "box.toml"
    path.write_text(BOX, encoding="utf-8")
    return load(path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of a run that was never stopped, with its last two checkpoints."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "box.toml").write_text(BOX, encoding="utf-8")
    run(load(folder / "box.toml"), folder / "run", COMM, **QUIET)
    return folder / "run"


def copy(folder, to):
    """A copy of a run's folder."""
    to.mkdir()
    for path in folder.iterdir():
        (to / path.name).write_bytes(path.read_bytes())
    return to


def table(folder):
    """The rows of a run's log."""
    return np.genfromtxt(folder / "log.csv", delimiter=",", names=True)


# The state


@pytest.mark.parametrize("since", range(4))
def test_a_simulation_goes_on_with_the_same_bits(case, tmp_path, since):
    """From a rebuild and from steps after it, to past the next ones."""
    simulation = steps(case, COMM, 12)
    while simulation.domain.rebuilds < 5 or simulation.steps - simulation.rebuilt < since:
        simulation.step()
    again = taken_up(case, keep(simulation, case, tmp_path), COMM)
    go_on_alike(simulation, again, 12, rebuilds=2)


def test_a_list_from_where_particles_are_now_gives_other_bits(case, tmp_path):
    """The control: the members of the lists count, and the comparison sees it."""
    simulation = steps(case, COMM, 12)
    while simulation.steps - simulation.rebuilt < 2:
        simulation.step()
    path = keep(simulation, case, tmp_path)
    right, wrong = taken_up(case, path, COMM), control(case, path, COMM)
    assert np.array_equal(velocity_by_id(wrong), velocity_by_id(simulation))
    for each in (simulation, right, wrong):
        each.step()
    assert right.domain.rebuilds == wrong.domain.rebuilds == 0  # the lists of before
    assert np.array_equal(velocity_by_id(right), velocity_by_id(simulation))
    apart = np.abs(velocity_by_id(wrong) - velocity_by_id(simulation)).max()
    assert 0.0 < apart < 1e-12


def test_it_goes_on_in_mixed_precision(tmp_path):
    case = precise_box(2, "mixed", periodic=True)
    simulation = steps(case, COMM, 5)
    again = taken_up(case, keep(simulation, case, tmp_path), COMM)
    for _ in range(8):
        simulation.step()
        again.step()
    assert state(again) == state(simulation)


# The files


def test_what_was_written_after_the_checkpoint_is_written_again(whole, tmp_path):
    """As after a power failure: files that know more than the checkpoint."""
    folder = copy(whole, tmp_path / "run")
    older = checkpoints(folder)[1]
    with open(folder / "log.csv", "a") as log:
        log.write("0.3,90,half a li")
    resume(folder, COMM, chosen=older.name, **QUIET)
    assert same_files(folder, whole)


def test_frames_that_no_longer_open_are_what_they_were(whole, tmp_path):
    """A rank was killed while HDF5 wrote: of the frames since the checkpoint nothing is known."""
    folder = copy(whole, tmp_path / "run")
    older = checkpoints(folder)[1]
    frames = folder / "box.h5"
    with open(frames, "r+b") as file:
        file.write(b"\0" * 2000)
        file.truncate(frames.stat().st_size - 100)
    with pytest.raises(OSError):
        h5py.File(frames)
    resume(folder, COMM, chosen=older.name, **QUIET)
    assert same_files(folder, whole)


def test_a_finished_run_may_be_taken_up_again(whole, tmp_path):
    folder = copy(whole, tmp_path / "run")
    finished = resume(folder, COMM, **QUIET)
    assert finished.simulation.steps == 90 and same_files(folder, whole)


def to(case, end):
    """The case with another end."""
    return case.model_copy(update={"time": case.time.model_copy(update={"end": end})})


def test_a_stopped_run_that_is_extended_is_one_to_the_later_end(whole, case, tmp_path, monkeypatch):
    with monkeypatch.context() as told, pytest.raises(Stopped, match="SIGUSR1 at t = 0.1"):
        stop_after(told, 40)
        run(to(case, 0.15), tmp_path / "run", COMM, **QUIET)
    assert not same_files(tmp_path / "run", whole)
    resume(tmp_path / "run", COMM, extend=["time.end=0.2"], **QUIET)
    assert same_files(tmp_path / "run", whole)
    assert load(tmp_path / "run/case.toml").time.end == 0.2


def test_a_finished_run_that_is_extended_has_shorter_steps_at_its_old_end(whole, case, tmp_path):
    """Two at the most, up to exactly that end: it goes on from there as from any other state."""
    run(to(case, 0.09), tmp_path / "run", COMM, **QUIET)
    [last] = table(tmp_path / "run")[-1:]
    assert last["time"] == 0.09
    finished = resume(tmp_path / "run", COMM, extend=["time.end=0.2"], **QUIET)
    assert finished.simulation.time == 0.2 == table(tmp_path / "run")["time"][-1]
    assert abs(finished.simulation.steps - table(whole)["step"][-1]) <= 2


def test_rows_that_are_missing_are_said(whole, tmp_path):
    folder = copy(whole, tmp_path / "run")
    (folder / "log.csv").write_text("time\n")
    with pytest.raises(OutputError, match="log.csv: .* rows are missing, it had .* bytes at the"):
        resume(folder, COMM, **QUIET)


# Refusals


def test_a_damaged_one_offers_the_older(whole, tmp_path):
    folder = copy(whole, tmp_path / "run")
    newest, older = checkpoints(folder)
    newest.write_bytes(newest.read_bytes()[:-100])
    with pytest.raises(CheckpointError) as refused:
        resume(folder, COMM, **QUIET)
    text = str(refused.value)
    assert text.startswith(f"{newest}: damaged: ") and "\n" not in text
    assert text.endswith(f"`python -m psph resume {folder} --from {older.name}`")
    older.write_bytes(b"")
    with pytest.raises(CheckpointError, match="; no other checkpoint there is whole$"):
        resume(folder, COMM, **QUIET)


def test_another_case_is_refused(whole, tmp_path):
    folder = copy(whole, tmp_path / "run")
    text = (folder / "case.toml").read_text()
    (folder / "case.toml").write_text(text.replace("cfl = 0.4", "cfl = 0.3"))
    with pytest.raises(CheckpointError, match="belongs to another case than .*case.toml"):
        resume(folder, COMM, **QUIET)


def test_later_sources_go_on_where_they_read_the_case_alike(whole, tmp_path, monkeypatch):
    """A key that a case does not have, and the order of keys, belong to the sources and not to the case."""
    monkeypatch.setattr(checkpoint, "SOURCES", "later ones")
    folder, said = copy(whole, tmp_path / "run"), []
    resume(folder, COMM, say=lambda line, where=None: said.append(line))
    assert "warning: other sources of psph wrote it: the bits may be others from here on" in said
    assert same_files(folder, whole)
    case = load(folder / "case.toml")
    turned = SimpleNamespace(
        as_tables=lambda: dict(reversed(case.as_tables().items())), versions=case.versions
    )
    assert case_digest(turned) == case_digest(case)
    assert None not in case.as_tables()["physics"].values() and None in case.physics.model_dump().values()


def test_later_sources_with_other_defaults_say_so(whole, tmp_path, monkeypatch):
    folder = copy(whole, tmp_path / "run")
    text = (folder / "case.toml").read_text()
    (folder / "case.toml").write_text(text.replace("cfl = 0.4", "cfl = 0.3"))
    monkeypatch.setattr(checkpoint, "SOURCES", "later ones")
    with pytest.raises(
        CheckpointError, match="other sources of psph wrote it, for which .*case.toml has other"
    ):
        resume(folder, COMM, **QUIET)


def test_a_run_with_a_key_that_has_departed_is_for_the_sources_that_wrote_it(whole, tmp_path, monkeypatch):
    """To give ``use``, as a case that has not run should, would make it another case."""
    folder = copy(whole, tmp_path / "run")
    text = (folder / "case.toml").read_text()
    (folder / "case.toml").write_text(text.replace("[physics]\n", "[physics]\nxsph = 0.5\n"))
    with pytest.raises(CaseError, match='give use = \\["transport.py"\\]$'):
        resume(folder, COMM, **QUIET)
    monkeypatch.setattr(checkpoint, "SOURCES", "later ones")
    with pytest.raises(CheckpointError) as error:
        resume(folder, COMM, **QUIET)
    said = str(error.value)
    assert (
        said.startswith(f"{folder}/case.toml: physics.xsph: is in a file of its own; ") and "\n" not in said
    )
    assert said.endswith("; other sources of psph wrote this run: resume it with those, or start it again")
    (folder / "case.toml").write_text(text)
    with pytest.raises(CaseError, match="time.end"):  # what the user gives is the user's
        resume(folder, COMM, ["time.end=-1.0"], **QUIET)


def test_a_folder_without_any_says_so(whole, tmp_path):
    folder = copy(whole, tmp_path / "run")
    for path in checkpoints(folder):
        path.unlink()
    with pytest.raises(
        CheckpointError, match="holds no checkpoint: a run of less than 5 s .* --set checkpoint.minutes=10"
    ):
        resume(folder, COMM, **QUIET)
    with pytest.raises(CheckpointError, match="nowhere: there is no such folder: give the folder that"):
        resume(tmp_path / "nowhere", COMM, **QUIET)
    with pytest.raises(CheckpointError, match="holds no run: give the folder that"):
        resume(tmp_path, COMM, **QUIET)


def test_a_run_at_its_end_has_no_step_left(whole, tmp_path):
    folder, said = copy(whole, tmp_path / "run"), []
    resume(folder, COMM, say=lambda line, where=None: said.append(line))
    assert "no step was left to the end: for a later one, resume with --set time.end=..." in said
    assert not any("particle-steps" in line for line in said) and same_files(folder, whole)


def test_dry_rows_of_a_probe_are_counted_from_the_start_of_the_run(whole, tmp_path):
    dry = [
        "probes.beside={position=[1.5,1.45],fields=['pressure','density']}",
        "output.probes=0.01",
        "time.end=0.1",
    ]
    for side, ends in (("left", (0.0, 1.5)), ("right", (1.5, 3.0))):  # with room above
        dry.append(f"fluids.{side}.shape.box={{lower=[{ends[0]},0.0],upper=[{ends[1]},0.8]}}")
    (tmp_path / "box.toml").write_text(BOX, encoding="utf-8")
    said = []
    run(load(tmp_path / "box.toml", dry), tmp_path / "run", COMM, **QUIET)
    resume(tmp_path / "run", COMM, ["time.end=0.15"], say=lambda line, where=None: said.append(line))
    values = np.genfromtxt(tmp_path / "run" / "probes.csv", delimiter=",", names=True)
    unknown = np.isnan(values["besidedensity"])
    none, rows = int(unknown.sum()), len(values)
    assert 0 < none < rows and not values["besidepressure"][unknown].any()
    where = "where probes.csv has 0 for a pressure, else nan"
    assert f"probe beside: no fluid in reach in {none} of {rows} rows, {where}" in said


@pytest.mark.parametrize("text", ["space.spacing=0.1", "time.cfl=0.1", "time", "=1", "output=1"])
def test_only_what_changes_no_step_may_be_extended(whole, text):
    with pytest.raises(CaseError, match="would make it another run; give time.end"):
        take_up(whole, COMM, [text])


def test_an_end_that_is_past_is_refused(whole):
    with pytest.raises(CheckpointError, match="time.end = 0.1 s is not after it, at 0.2 s"):
        take_up(whole, COMM, ["time.end=0.1"])


LIFTED = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 0.2
physics.sound_speed = 20.0
checkpoint.every = 3
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.5] }
[walls.tank.shape.difference]
from.box = { lower = [-0.3, -0.3], upper = [0.8, 1.2] }
minus = [{ box = { lower = [0.0, 0.0], upper = [0.5, 1.2] } }]
[walls.lid]
shape.box = { lower = [0.0, 0.5], upper = [0.5, 0.8] }
motion = { translation = [0.0, 1.0], start = 0.4 }
"""
DRIVEN = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [1.2, 1.2] }
time.end = 0.2
physics.gravity = [1.0, 0.0]
checkpoint.every = 3
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.2, 1.2] }
"""


@pytest.mark.parametrize(
    "text, end, why", [(LIFTED, 2.0, "free surface opens"), (DRIVEN, 0.3, "c rests on it")]
)
def test_an_end_that_makes_another_scene_is_refused(text, end, why, tmp_path):
    """The folder stays as it is; control: with what the end decides given, or not reached by then, it goes on."""
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    for name, *keys in ("run",), ("given", "physics.sound_speed=20.0"):
        run(load(tmp_path / "case.toml", keys), tmp_path / name, COMM, **QUIET)
    with pytest.raises(CheckpointError, match=f"would make it another run, since .*{why}"):
        resume(tmp_path / "run", COMM, [f"time.end={end}"], **QUIET)
    assert load(tmp_path / "run/case.toml").time.end == 0.2
    assert resume(tmp_path / "given", COMM, ["time.end=0.3"], **QUIET)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_the_case_that_a_run_leaves_is_the_same_case(path, tmp_path):
    case = load(path)
    (tmp_path / "case.toml").write_text(case.to_toml(), encoding="utf-8")
    with_its_files(case, tmp_path)
    again = load(tmp_path / "case.toml", ["time.end=123.0", "output.log=0.5", "checkpoint.every=3"])
    assert case_digest(again) == case_digest(case)
    assert case_digest(load(path, ["space.smoothing=1.41"])) != case_digest(case)


def test_one_that_is_not_there_is_refused(whole):
    with pytest.raises(CheckpointError, match="x.h5: there is no such file; checkpoint-90.h5, at"):
        resume(whole, COMM, chosen="x.h5", **QUIET)


def test_a_run_that_may_go_on_is_said_to_be_one(whole, case):
    with pytest.raises(OutputError, match="--overwrite, or go on with it: `python -m psph resume"):
        run(case, whole, COMM, **QUIET)


def test_a_run_anew_leaves_no_checkpoint_of_the_old_one(whole, case, tmp_path):
    folder = copy(whole, tmp_path / "run")
    run(to(case, 1e-3), folder, COMM, overwrite=True, **QUIET)
    assert [path.name for path in checkpoints(folder)] == ["checkpoint-1.h5"]


# Stopping


def test_a_run_that_is_stopped_again_and_again_ends_with_the_same_files(whole, tmp_path):
    """By its wall-clock limit, which is over before each first step."""
    text = BOX.replace("every = 30", "wall_clock = 1e-6")
    (tmp_path / "box.toml").write_text(text, encoding="utf-8")
    with pytest.raises(Stopped, match="stopped by checkpoint.wall_clock at t = .*: resume with `"):
        run(load(tmp_path / "box.toml"), tmp_path / "run", COMM, **QUIET)
    for stop in range(2, 5):
        with pytest.raises(Stopped):
            resume(tmp_path / "run", COMM, **QUIET)
        assert checkpoints(tmp_path / "run")[0].name == f"checkpoint-{stop}.h5"
    resume(tmp_path / "run", COMM, ["checkpoint.wall_clock=off", "checkpoint.every=30"], **QUIET)
    assert same_files(tmp_path / "run", whole)
    assert np.isfinite(np.loadtxt(whole / "log.csv", delimiter=",", skiprows=1)).all()
