"""Studies of scenes with finer regions: error against seconds with and without them."""

import numpy as np
import pytest
from drafts import draft

from psph.api import Case, study
from psph.case import load
from psph.fields import FLUID
from psph.lab.errors import StudyError
from psph.lab.report.page import report
from psph.lab.study import command
from psph.lab.study.conclusions import Conclusions
from psph.lab.study.effects import without_each
from psph.lab.study.judge import Judge, series_errors
from psph.lab.study.prediction import predicted
from psph.lab.study.report import table
from psph.output.interpolation import interpolated
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs.start import run
from psph.scene import Scene

TANK = """
[space]
dimensions = 2
spacing = 0.1
[[space.refine]]
shape.box = { lower = [0.5, -0.4], upper = [1.4, 1.2] }
[time]
end = 0.02
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.8] }
pressure = "hydrostatic"
velocity = [0.3, 0.0]
[walls.tank]
shape.difference.from.box = { lower = [-0.3, -0.3], upper = [1.3, 1.1] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 1.1] } }]
[gauges.side.level]
foot = [0.9, 0.0]
top = [0.9, 1.0]
[numbers.top]
of = "side.level"
take = "maximum"
[study]
repeats = 1
"""


def studied(folder, vary, grid=True, **changes):
    """A study of the tank, and its page."""
    case = Case(draft(folder, TANK).as_tables(), folder=folder).with_(**changes)
    found = study(case, vary, grid=grid, out=folder / "study", quiet=True, comm=alone())
    return found, (folder / "study" / "study.md").read_text()


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    """Two spacings, with three factors of refinement each, against the finest run."""
    folder = tmp_path_factory.mktemp("refined")
    return folder / "study", *studied(
        folder, {"space.spacing": [0.1, 0.05], "space.refine[0].factor": [1, 2, 4]}, study__error="velocity"
    )


def test_the_finest_run_is_that_of_the_smallest_spacing_anywhere(grid):
    _, found, page = grid
    table = found.table
    assert table["finest_spacing"].tolist() == pytest.approx([0.1, 0.05, 0.025, 0.05, 0.025, 0.0125])
    assert table["difference_l2"].argmin() == 5 and table["difference_l2"][5] == 0.0
    assert "against the finest run (spacing 0.05, factor 4: 0.0125 m where it is finest)" in page
    assert "its own error added" in page and "| finest (m) |" in page


def test_ladders_choices_and_numbers_by_factor(grid):
    folder, _, page = grid
    for factor in (1, 2, 4):
        assert f"- factor {factor}: " in page
        assert f"- factor {factor}: top: no answer at zero spacing: 2 runs are too few" in page
    for told in ("spacing 0.1, factor 2 takes ", "spacing 0.05, factor 4 takes "):
        assert f"- {told}" in page
    assert "factor 1 takes" not in page and "nan" not in page
    for picture in ("study.png", "study.top.png"):
        assert (folder / picture).stat().st_size > 10_000
    assert "study.top" in report(folder).read_text(encoding="utf-8")


def test_a_run_of_a_ladder_is_foreseen_by_its_factor(grid):
    folder, _, _ = grid
    tank = str(folder.parent / "case.toml")
    changes = ["study.error=velocity", "space.spacing=0.08"]
    for factor in (1, 2):
        own = load(tank, [*changes, f"space.refine[0].factor={factor}"])
        first, error, time = predicted(folder, own)
        assert f", factor {factor} on 1 rank" in first and "%" in error and "s (" in time
    with pytest.raises(StudyError, match=r"space\.refine\[0\]\.factor is [24] there and 8 here"):
        list(predicted(folder, load(tank, [*changes, "space.refine[0].factor=8"])))


def test_with_and_without(tmp_path):
    found, page = studied(tmp_path, {"space.refine": ["off"]}, grid=False, study__error="velocity")
    assert found.table["finest_spacing"].tolist() == [0.05, 0.1]
    assert "its own error unknown" in page and "refine off takes " in page
    # Without finer particles there is one run, and nothing to compare it with.
    with pytest.raises(Exception, match="no finer run to compare with"):
        studied(tmp_path, {"space.refine": ["off"]}, grid=False, study__error="velocity", space__refine=None)


SIZE = {"particles": 100, "steps": 10}


def test_a_run_by_which_errors_are_told_has_none_of_its_own(tmp_path):
    keys = ["space.refine[0].factor"]
    rows = [
        {"status": "done", "seconds": 1.0 * f, "error_l2": e, "space.spacing": 0.1, keys[0]: f} | SIZE
        for f, e in ((1, 0.02), (4, float("nan")))
    ]
    said = list(Conclusions(draft(tmp_path, TANK), keys, rows).sentences(None))
    assert "factor 4 takes 4.00 times as long; its own error is not known." in said


def test_fields_are_averaged_by_the_sizes_of_particles_and_count_by_their_volumes(tmp_path):
    """Among coarse and fine ones a smooth field is the same; one average for both would reach too far."""
    dx = np.array([0.1] * 100 + [0.05] * 400)
    coarse, fine = (np.arange(n) * 0.1 * 10 / n + 0.5 / n for n in (10, 20))
    x = np.concatenate(
        [np.stack(np.meshgrid(a, b), -1).reshape(-1, 2) for a, b in ((coarse, coarse), (fine + 1.0, fine))]
    )
    bent = np.sin(9.0 * x[:, 0])
    at = np.array([[1.5, 0.52], [1.33, 0.48]])
    own, wide = (
        np.abs(interpolated(x, bent, at, spacing, (None, None)) - np.sin(9.0 * at[:, 0])).max()
        for spacing in (dx, 0.1)
    )
    assert own < 0.4 * wide
    assert series_errors(np.array([2.0, 1.0]), np.ones(2), np.array([1.0, 3.0])).l1 == pytest.approx(0.25)
    case = draft(tmp_path, TANK)
    run(case, tmp_path / "run", alone(), say=lambda *_: None)
    judged, _ = Judge(case).errors(tmp_path / "run", tmp_path / "run")
    assert np.isnan(judged.l2)


WHIRL = """
[space]
dimensions = 2
spacing = 0.1
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [2.0, 2.0]
[[space.refine]]
shape.box = { lower = [0.6, 0.6], upper = [1.4, 1.4] }
[time]
end = 0.01
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 2.0] }
velocity = "exact"
viscosity = 0.01
[exact.taylor_green]
speed = 1.0
length = 2.0
"""


def test_errors_by_an_exact_solution_count_each_bit_of_water_once(tmp_path):
    case = draft(tmp_path, WHIRL)
    run(case, tmp_path / "run", alone(), say=lambda *_: None)
    results = Run(tmp_path / "run")
    frame = results.frame(-1, "position", "velocity", "kind", "group")
    lead = frame["kind"] == FLUID
    assert set(frame["group"][lead]) == {0, 1}
    x, v = frame["position"][lead], frame["velocity"][lead]
    scene = Scene(case)
    exact = scene.layout.exact.velocity(x, case.time.end, scene.starts.setting)
    size = np.where(frame["group"][lead] == 0, 1.0, 0.25)
    assert size.sum() == 400.0
    told = results.errors()["velocity_l2"][-1]
    assert told == pytest.approx(series_errors(v, exact, size).l2, rel=1e-6)
    assert told != pytest.approx(series_errors(v, exact).l2, rel=1e-3)


def test_each_effect_has_its_own_run_and_what_is_the_case_itself_none(tmp_path, capsys, monkeypatch):
    """A wall without `continues` is one that continues the first fluid: that run is the case itself."""
    some = ("dry wall", "gravity", "impact damping")
    few = {name: keys for name, keys in without_each(draft(tmp_path, TANK)).items() if name in some}
    assert list(few) == ["dry wall", "impact damping", "gravity"]
    monkeypatch.setattr(command, "without_each", lambda case: few)
    case = draft(tmp_path, TANK, "study.error=velocity", "time.end=2e-3")
    (tmp_path / "as_it_is.toml").write_text(case.to_toml())
    command.study(alone(), str(tmp_path / "as_it_is.toml"), [], [], False, True, tmp_path / "out", None, None)
    said = capsys.readouterr().out
    assert "dry wall:" not in said and "gravity: the case needs it; without it, refused: " in said
    assert '"hydrostatic": there is no gravity' in said[said.index("gravity: the case needs it") :]
    assert "impact damping: " in said and "it changes top by " in said and "-0 %" not in said


def test_many_keys_are_told_by_the_names_of_runs():
    keys = [f"physics.{name}" for name in "abcde"]
    rows = [{"status": "done"}, {"status": "done", keys[1]: "off"}]
    head, body = table(rows, keys)
    assert head[0] == "run" and [cells[0] for cells in body] == ["as it is", "b off"]
    assert table(rows, keys[:4])[0][:4] == keys[:4]
