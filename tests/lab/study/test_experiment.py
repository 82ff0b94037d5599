"""Curves that a case names: where their files may lie, and what is wrong with them."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from drafts import draft
from fuzzing import Tally, spoilt, thorough
from hypothesis import given
from hypothesis import strategies as st
from jobs import clean_environment
from long import LONG

from psph.case import CaseError, load
from psph.errors import UNPRINTABLE, Foreseen
from psph.lab.errors import StudyError
from psph.lab.study.experiment import read_experiment
from psph.lab.study.ladder import overrides, rows, wanted
from psph.lab.study.prediction import predicted
from psph.lab.study.runs import conditions
from psph.lab.study.study import StudyRuns
from psph.output.errors import NotThere
from psph.output.reader import Run
from psph.parallel.reductions import alone

CASES = Path(__file__).parents[3] / "run" / "cases"

CASE = """
space = { dimensions = 1, spacing = 0.1, periodic = ["x"], lower = [0.0], upper = [2.0] }
time.end = 0.1
physics.sound_speed = 10.0
[fluids.air]
shape.box = { lower = [0.0], upper = [2.0] }
[probes.P]
position = [0.5]
[experiments.gauge]
file = "FILE"
time = "t"
value = "p"
probe = "P.pressure"
"""

CURVE = "# measured\nt,p\n0.0,1.0\n0.1,2.0\n"


def curve(folder, file="gauge.csv", content=CURVE, files=None):
    """What is read of the experiment of a case in ``folder``."""
    if content is not None:
        data = content if isinstance(content, bytes) else content.encode()
        (folder / "gauge.csv").write_bytes(data)
    case = draft(folder, CASE.replace("FILE", str(file)))
    return read_experiment(case, "gauge", files)


def test_a_file_in_the_folder_or_below_is_read(tmp_path):
    assert curve(tmp_path)[1].tolist() == [1.0, 2.0]
    (tmp_path / "below").mkdir()
    (tmp_path / "below/curve.csv").write_text(CURVE)
    assert curve(tmp_path, "below/curve.csv")[1].tolist() == [1.0, 2.0]
    assert curve(tmp_path, "below/../gauge.csv")[1].tolist() == [1.0, 2.0]
    assert curve(tmp_path, tmp_path / "gauge.csv")[1].tolist() == [1.0, 2.0]
    (tmp_path / "link.csv").symlink_to("gauge.csv")
    assert curve(tmp_path, "link.csv")[1].tolist() == [1.0, 2.0]


@pytest.mark.parametrize("file", ["../gauge.csv", "ABSOLUTE", "link.csv", "linked/gauge.csv"])
def test_a_file_elsewhere_is_refused_unless_told(file, tmp_path):
    outside, folder = tmp_path, tmp_path / "case"
    folder.mkdir()
    (outside / "gauge.csv").write_text(CURVE)
    (folder / "link.csv").symlink_to(outside / "gauge.csv")
    (folder / "linked").symlink_to(outside)
    file = file.replace("ABSOLUTE", str(outside / "gauge.csv"))
    with pytest.raises(StudyError, match="lies outside .*/case; move it .* --files DIR") as caught:
        curve(folder, file, None)
    assert str(caught.value).startswith(f"{folder}/case.toml: experiments.gauge.file: ")
    assert curve(folder, file, None, files=outside)[1].tolist() == [1.0, 2.0]
    with pytest.raises(StudyError, match="lies outside"):
        curve(folder, file, None, files=folder / "below")


def test_the_command_line_tells(tmp_path):
    case = CASES / "hard/dam_break.toml"
    study = [
        sys.executable,
        "-m",
        "psph",
        "study",
        case,
        "--out",
        tmp_path / "s",
        "--set",
        "time.end=1e-9",
        "--vary",
        "time.cfl=0.2,0.3",
    ]
    for more, says in (([], "lies outside"), (["--files", CASES], "measured from 0.")):
        job = subprocess.run(
            [*study, *more], capture_output=True, text=True, env=clean_environment(), timeout=60
        )
        assert job.returncode == 2 and says in job.stderr  # it was read, and ends before its times
        assert len(job.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize(
    "content, says",
    [
        ("t,p\n0.0,nan\n", "'nan' is not finite"),
        ("t,p\ninf,1.0\n", "'inf' is not finite"),
        ("t,p\n0,5,1,0\n", "4 values in '0,5,1,0', 2 names above"),
        ("t,p\n0.0\n", "1 values"),
        ("t,p,p\n0.0,1.0,2.0\n", "more than one column 'p'"),
        ("t,q\n0.0,1.0\n", "no column 'p'"),
        ("t,p\n", "holds no rows"),
        ("", "no column 't'"),
        ("t,p\n0.0,a\n", "'a' is no number"),
        (b"t,p\n\xff,1.0\n", "is no text in UTF-8"),
        (f't,p\n0.0,"{"1" * 200_000}\n', "experiments.gauge.file: "),
        ("t,p\n0.0,\0\n", "line 2 is no text"),
        (None, "No such file"),
    ],
)
def test_a_wrong_file_is_one_line(content, says, tmp_path):
    with pytest.raises(StudyError) as caught:
        curve(tmp_path, content=content)
    assert says in str(caught.value) and not UNPRINTABLE.search(str(caught.value))


def test_a_byte_order_mark_and_another_order_are_read(tmp_path):
    time, value = curve(tmp_path, content="\ufefft,p\r\n1.0,2.0\r\n0.0,1.0\r\n")
    assert time.tolist() == [0.0, 1.0] and value.tolist() == [1.0, 2.0]


def test_what_is_no_plain_file_is_not_read(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "circle.csv").symlink_to("circle.csv")
    for file in ("pipe.csv", ".", "circle.csv"):
        with pytest.raises(StudyError, match="experiments.gauge.file"):
            curve(tmp_path, file)


MANY = (100, pytest.param(3000, marks=LONG))


@pytest.mark.timeout(600)
@pytest.mark.parametrize("examples", MANY)
def test_spoilt_curves(examples, tmp_path):
    """Refused in one line, or read whole."""
    tally, path = Tally(), tmp_path / "gauge.csv"
    curve(tmp_path)
    case = load(tmp_path / "case.toml")
    measured = "t,p\n" + "".join(f"{k / 10},{k * k}\n" for k in range(20))

    @thorough(examples)
    @given(spoilt([CURVE.encode(), measured.encode()]))
    def run(data):
        path.write_bytes(data)
        try:
            read = np.array(read_experiment(case, "gauge"))
        except StudyError as error:
            assert not UNPRINTABLE.search(str(error)) and len(str(error)) < 1500
            tally["refused"] += 1
        else:
            lines = data.decode("utf-8-sig").splitlines()
            told = [line for line in lines if line.strip() and not line.startswith("#")]
            assert read.shape == (2, len(told) - 1) and np.isfinite(read).all()
            names = next(csv.reader(told))
            written = sorted(float(row[names.index("t")]) for row in csv.reader(told[1:]))
            assert written == read[0].tolist()
            tally["accepted"] += 1

    run()
    tally.tell()
    assert min(tally["accepted"], tally["refused"]) > examples // 50


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # a fit of figures beyond all measure
@pytest.mark.timeout(600)
@pytest.mark.parametrize("examples", MANY)
def test_spoilt_tables_of_a_run_and_of_a_study(examples, tmp_path):
    """What psph itself has written, and something else has changed."""
    row = {
        "space.spacing": 0.1,
        "error_l2": 0.1,
        "seconds": 1.0,
        "particles": 10,
        "steps": 5,
        "status": "done",
    }
    kept = {
        "rows": [row, row | {"space.spacing": 0.05, "error_l2": 0.02, "seconds": 3.0}],
        "vary": ["space.spacing"],
        "dimensions": 1,
        "case": "a",
        "ranks": 1,
        "error": "of p",
    }
    case, tally = draft(tmp_path, CASE), Tally()
    kept["conditions"] = [conditions(case)]
    (tmp_path / "box.h5").touch()
    assert list(predicted(_written(tmp_path, json.dumps(kept).encode(), b"time,P.p\n0,1\n"), case))

    @thorough(examples)
    @given(spoilt([json.dumps(kept, indent=1).encode()]), spoilt([b"time,P.p\n0.0,1.0\n0.1,2.0\n"]))
    def run(study, table):
        _written(tmp_path, study, table)
        for what, kind in (
            (lambda: list(predicted(tmp_path, case)), StudyError),
            (lambda: Run(tmp_path).probes(), NotThere),
        ):
            try:
                tally["read" if what() else "empty"] += 1
            except kind as error:
                assert not UNPRINTABLE.search(str(error))
                tally["refused"] += 1

    run()
    tally.tell()
    assert tally["read"] and tally["refused"]


def _written(folder, study, table):
    (folder / "study.json").write_bytes(study)
    (folder / "probes.csv").write_bytes(table)
    return folder


@pytest.mark.parametrize(
    "given, says",
    [
        (["space.spacing=0.2,abc"], "abc is not a number"),
        (["space.spacing=0.2,true"], "true is not"),
        (["time.cfl=0.1,0.2", "time.cfl=0.3,0.4"], "given twice"),
    ],
)
def test_a_ladder_that_is_none(given, says):
    with pytest.raises(StudyError, match=says):
        wanted({}, given)


def test_a_text_of_a_ladder_stays_a_text():
    """It once became whatever TOML made of it: a number, and what follows a # a remark."""
    settings = {"title": "0.5 # x", "space.kernel": "true", "physics.gravity": "off"}
    assert overrides(settings) == [
        'title="0.5 # x"',
        'space.kernel="true"',
        "physics.gravity=off",
    ]


VALUES = st.one_of(
    st.floats().map(repr),
    st.integers().map(str),
    st.text(max_size=5),
    st.sampled_from(["0.1", "0.05", "off", "true", "cubic", "[0", "1e999", "9" * 5000, ""]),
)
KEYS = st.sampled_from(["space.spacing", "space.kernel", "time.cfl", "time.end", "profile", "no.key"])


@pytest.mark.timeout(600)
@pytest.mark.parametrize("examples", (60, pytest.param(1000, marks=LONG)))
def test_ladders_on_the_command_line(examples, tmp_path):
    file, tally = tmp_path / "case.toml", Tally()
    file.write_text(CASE.replace("FILE", "gauge.csv"))
    (tmp_path / "gauge.csv").write_text(CURVE)
    ladders = st.builds("{}={}".format, KEYS, st.lists(VALUES, min_size=1, max_size=3).map(",".join))
    sound = st.sampled_from(["time.end=0.1,0.2", "space.kernel=cubic,quintic"])  # drawn ones rarely are

    @thorough(examples)
    @given(st.lists(st.one_of(ladders, ladders, sound, st.text(max_size=9)), min_size=1, max_size=2))
    def run(asked):
        try:
            every = rows(wanted({}, asked), False)
            StudyRuns(file, [], every, tmp_path / "out", alone()).refuse_nonsense()
        except Foreseen as error:
            lines = error.lines if isinstance(error, CaseError) else [str(error)]
            assert all(len(line) < 1500 and not UNPRINTABLE.search(line) for line in lines)
            tally["refused"] += 1
        else:
            tally["accepted"] += 1

    run()
    tally.tell()
    assert tally["accepted"] and tally["refused"]
