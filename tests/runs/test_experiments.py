"""Experiments that a case names are looked at before a run of it: a fault is one line."""

import subprocess
import sys

import pytest
from drafts import TANK, draft
from jobs import clean_environment
from mpi4py import MPI

from psph.case import CaseError
from psph.runs.experiments import refuse_unfit_experiments
from psph.runs.start import run
from psph.scene import Scene

MEASURED = (
    TANK
    + """
[probes.P1]
position = [0.5, 0.1]
[gauges.wire.level]
foot = [0.5, 0.0]
top = [0.5, 0.7]
[experiments.curve]
file = "curve.csv"
time = "t"
value = "p"
probe = "P1.pressure"
"""
)

CURVE = "t,p\n0.0,4000.0\n1.0,3900.0\n"


@pytest.fixture
def curve(tmp_path):
    """The file of the experiment."""
    path = tmp_path / "curve.csv"
    path.write_text(CURVE, encoding="utf-8")
    return path


def refused(folder, *sets):
    """The lines by which the case is refused, without the folder."""
    with pytest.raises(CaseError) as caught:
        refuse_unfit_experiments(Scene(draft(folder, MEASURED, *sets)))
    return [line.replace(f"{folder}/", "") for line in caught.value.lines]


def test_what_is_there_is_accepted(tmp_path, curve):
    for column in ("P1.pressure", "wire.level", "wire.wetted"):
        refuse_unfit_experiments(Scene(draft(tmp_path, MEASURED, f"experiments.curve.probe={column}")))
    refuse_unfit_experiments(Scene(draft(tmp_path, TANK)))


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        (
            "file=none.csv",
            "curve.file: none.csv: No such file or directory; give a CSV file in the case's folder",
        ),
        ('file="../none.csv"', "curve.file: ../none.csv: No such file or directory; give a CSV file"),
        ("time=T", "curve: curve.csv has no column 'T'; give one of t, p"),
        ("value=q", "curve: curve.csv has no column 'q'; give one of t, p"),
        (
            "probe=P1.presure",
            "curve.probe: \"P1.presure\" is not measured in this case; did you mean 'P1.pressure'?",
        ),
        (
            "probe=tip.front",
            'curve.probe: "tip.front" is not measured in this case; known here: P1.pressure, wire',
        ),
    ],
)
def test_what_is_not_there_is_one_line(tmp_path, curve, sets, says):
    [line] = refused(tmp_path, f"experiments.curve.{sets}")
    assert line.startswith(f"case.toml: experiments.{says}")


def test_a_curve_beside_the_folder_is_left_to_a_study(tmp_path, curve):
    below = tmp_path / "below"
    below.mkdir()
    curve.write_text("no table", encoding="utf-8")
    refuse_unfit_experiments(Scene(draft(below, MEASURED, 'experiments.curve.file="../curve.csv"')))
    curve.rename(below / "curve.csv")
    assert refused(below) == [
        "case.toml: experiments.curve: curve.csv has no column 't'; give one of no table"
    ]


def test_a_run_is_refused_before_it_begins(tmp_path):
    with pytest.raises(CaseError, match="experiments.curve.file: .*No such file"):
        run(draft(tmp_path, MEASURED), tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    assert not (tmp_path / "run").exists()
    for verb in ("check", "explain"):
        job = subprocess.run(
            [sys.executable, "-m", "psph", verb, tmp_path / "case.toml"],
            capture_output=True,
            text=True,
            env=clean_environment(),
            timeout=60,
        )
        assert job.returncode == 2 and "experiments.curve.file" in job.stderr and not job.stdout
