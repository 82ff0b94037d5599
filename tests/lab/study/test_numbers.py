"""Studies of a number, and of a curve that comes late."""

import csv
import math

import numpy as np
import pytest
from drafts import TANK, draft, refusal

from psph.api import Case, study
from psph.case import CaseError
from psph.lab.study.judge import shifted
from psph.lab.study.numbers import ladders_of_numbers, sentences_of_numbers
from psph.parallel.reductions import alone
from psph.runs.experiments import refuse_unfit_experiments
from psph.scene import Scene

NUMBERS = """
[gauges.side.level]
foot = [0.5, 0.0]
top = [0.5, 0.7]
[numbers.top]
of = "side.level"
take = "maximum"
"""


def rows(values, spacings=(0.04, 0.02, 0.01, 0.005), reach=0.0):
    """The rows of runs with these values of the number."""
    return [{"space.spacing": dx, "number top": q, "reach top": reach} for dx, q in zip(spacings, values)]


def concluded(tmp_path, values, **more):
    """The ladder of these values, and what is said of it."""
    case = draft(tmp_path, TANK + NUMBERS)
    [found] = ladders_of_numbers(case, rows(values, **more))
    return found, *sentences_of_numbers([found])


def test_a_family_of_known_order_goes_to_its_limit(tmp_path):
    values = [0.5 + 3.0 * dx**1.5 for dx in (0.04, 0.02, 0.01, 0.005)]
    found, said = concluded(tmp_path, values)
    assert found.limit.value.value == pytest.approx(0.5, abs=1e-6)
    assert found.limit.order.value == pytest.approx(1.5, abs=1e-3) and found.unit == "m"
    assert said.startswith("top goes to 0.5") and "m at zero spacing, with order 1.50" in said
    # Three runs: the grid convergence index, which holds the limit.
    found, said = concluded(tmp_path, values[1:], spacings=(0.02, 0.01, 0.005))
    reach = found.limit.value.high - found.limit.value.value
    assert reach == pytest.approx(1.25 * (values[-1] - 0.5), rel=1e-3) and "grid convergence index" in said


@pytest.mark.parametrize(
    "values, why",
    [
        ([0.5, 0.6, 0.45, 0.52], "the values do not go one way ever more slowly"),
        ([0.5, 0.51, 0.53, 0.57], "the values do not go one way ever more slowly"),
        ([0.5, 0.5, 0.5, 0.5], "all runs have the same"),
        ([0.5, math.nan, 0.52, 0.53], "1 of the runs have no such number"),
        ([0.50, 0.60, 0.61, 0.70], "the order is not known|do not go one way"),
        ([0.5, 0.6], "2 runs are too few"),
    ],
)
def test_no_answer_where_the_runs_tell_none(tmp_path, values, why):
    found, said = concluded(tmp_path, values)
    assert found.limit is None
    assert "top: no answer at zero spacing: " in said
    assert any(part in said for part in why.split("|"))


def test_a_shift_in_time_is_taken_out_and_no_more():
    t = np.linspace(0.0, 4.0, 401)

    def curve(late):
        return lambda shift: np.where(
            (t + shift >= 0.0) & (t + shift <= 4.0), np.sin(3.0 * (t + shift - late)), np.nan
        )

    theirs = np.sin(3.0 * t)
    plain, none = shifted(curve(0.13), theirs, 0.0)
    assert none == 0.0 and plain.l2 > 0.3
    judged, late = shifted(curve(0.13), theirs, 0.2)
    assert late == pytest.approx(0.13, abs=1e-4) and judged.l2 < 1e-3
    judged, late = shifted(curve(0.13), theirs, 0.1)
    assert late == pytest.approx(0.1, abs=1e-6) and judged.l2 == pytest.approx(
        plain.l2 * 0.03 / 0.13, rel=0.1
    )
    assert shifted(lambda shift: np.full(401, np.nan), theirs, 0.1)[1] == 0.0


CURVE = "t,level\n0,0.5\n0.05,0.55\n0.1,0.5\n"


def test_a_number_of_a_small_case_by_theory_an_experiment_and_the_finest(tmp_path):
    (tmp_path / "level.csv").write_text(CURVE)
    text = (
        TANK
        + NUMBERS
        + 'theory = 0.6\n[experiments.seen]\nfile = "level.csv"\ntime = "t"\nvalue = "level"\nprobe = "side.level"\n'
    )
    case = draft(tmp_path, text, "time.end=0.1", "fluids.water.velocity=[0.5,0.0]", "study.repeats=1")
    for against in ("theory", "seen", "finest"):
        changes = {"study.error": "top", "study.against": against}
        own = Case(case.as_tables(), folder=tmp_path).with_(changes)
        found = study(own, {"space.spacing": [0.1, 0.05]}, out=tmp_path / "study", quiet=True, comm=alone())
        assert "top (maximum of side.level)" in found.error
        q = found.table["number top"]
        reference = {"theory": 0.6, "seen": 0.55, "finest": q[-1]}[against]
        if against == "finest":
            assert found.table["difference_l2"][0] == pytest.approx(abs(q[0] / q[1] - 1.0))
        else:
            assert found.table["error_l2"] == pytest.approx(np.abs(q / reference - 1.0))
    assert (tmp_path / "study" / "study.top.png").stat().st_size > 5000
    own = Case(case.as_tables(), folder=tmp_path).with_({"study.shift": 0.02, "study.against": "seen"})
    found = study(own, {"space.spacing": [0.1, 0.05]}, out=tmp_path / "study", quiet=True, comm=alone())
    assert "less a shift in time of 0.02 s at most" in found.error
    assert (np.abs(found.table["time_shift"]) <= 0.02).all()
    # A further number asks for no run.
    before = [path.stat().st_mtime_ns for path in sorted((tmp_path / "study").glob("run-*/case.h5"))]
    more = own.with_({"numbers.mean.of": "side.level", "numbers.mean.take": "mean"})
    found = study(more, {"space.spacing": [0.1, 0.05]}, out=tmp_path / "study", quiet=True, comm=alone())
    assert np.isfinite(found.table["number mean"]).all()
    assert before == [path.stat().st_mtime_ns for path in sorted((tmp_path / "study").glob("run-*/case.h5"))]
    with open(tmp_path / "study" / "study.csv", newline="") as file:
        assert {"number top", "reach top", "time_shift"} <= set(next(csv.DictReader(file)))


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("numbers.a={of='side.level',take='maximun'}", "numbers.a.take"),
        ("numbers.a={of='side.level',take='mean',level=1.0}", "take = mean has no use for it"),
        ("numbers.a={of='side.level',take='response'}", "numbers.a: take = response needs wave; add it"),
        ("numbers.a={of='side.level',take='mean',after=9.0}", "no time is left until the end"),
    ],
)
def test_numbers_that_are_none_are_refused(tmp_path, override, says):
    [line] = refusal(tmp_path, TANK + NUMBERS, override)
    assert says in line


def test_a_number_of_what_is_not_measured_is_refused_before_the_run(tmp_path):
    case = draft(tmp_path, TANK + NUMBERS, "numbers.top.of='side.levle'")
    with pytest.raises(
        CaseError, match="numbers.top.of: .*is not measured in this case; did you mean 'side.level'"
    ):
        refuse_unfit_experiments(Scene(case))
