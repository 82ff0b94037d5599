"""A study on the command line: its rows, its files, its words, interrupted and under mpirun."""

import csv
import json
import math
import re
import signal
import subprocess
import sys

import numpy as np
import pytest
from jobs import clean_environment, hears_interrupts, mpirun

from psph.case import load
from psph.lab.errors import StudyError
from psph.lab.study import runs
from psph.lab.study.answer import fitting
from psph.lab.study.effects import effects_words, without_each
from psph.lab.study.judge import Judge, known_values, series_errors, value_at
from psph.lab.study.page import main as on_page
from psph.lab.study.prediction import predicted
from psph.lab.study.study import StudyRuns, pareto
from psph.output.interpolation import interpolated
from psph.output.pages import BEGIN, END
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.runs import memory_check
from psph.runs.footprint import bytes_of_rank
from psph.runs.start import run
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import BlowUp

WAVE = """
scheme = "sph"
[space]
dimensions = 1
spacing = 0.025
smoothing = 2.0
kernel = "cubic"
periodic = ["x"]
lower = [0.0]
upper = [1.0]
[time]
end = 0.1
[physics]
sound_speed = 10.0
[fluids.air]
shape.box = { lower = [0.0], upper = [1.0] }
density = 1.0
velocity = "exact"
pressure = "exact"
[exact.sound_wave]
speed = 1e-4
length = 1.0
[probes.P]
position = [0.3]
[study]
vary = { "space.spacing" = [0.05, 0.025, 0.0125] }
"""


def study(folder, *options, text=WAVE, ranks=None):
    """A finished ``psph study`` of the case ``text`` in ``folder``."""
    file = folder / "wave.toml"
    file.write_text(text)
    command = ["-m", "psph", "study", str(file), "--out", str(folder / "out"), *options]
    if ranks:
        return mpirun(ranks, command)
    return subprocess.run(
        [sys.executable, *command],
        capture_output=True,
        text=True,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
    )


def rows_of(folder) -> list[dict]:
    with open(folder / "out" / "study.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A study of a sound wave, and what it printed."""
    folder = tmp_path_factory.mktemp("study")
    job = study(folder, "--error", "0.002", ranks=2)
    assert job.returncode == 0, job.stderr
    return folder, job.stdout


def test_a_row_holds_what_is_promised(done):
    folder, _ = done
    rows = rows_of(folder)
    assert [float(r["space.spacing"]) for r in rows] == [0.05, 0.025, 0.0125]
    for row in rows:
        assert row["status"] == "done"
        l1, l2, linf, seconds = (float(row[k]) for k in ("error_l1", "error_l2", "error_linf", "seconds"))
        assert 0.0 < l2 < 0.5 and 0.0 < l1 and 0.0 < linf
        parts = sum(float(row[f"{part}_seconds"]) for part in ("set_up", "stepping", "output"))
        assert 0.0 < seconds == pytest.approx(parts)
        assert float(row["particle_steps"]) == float(row["particles"]) * float(row["steps"])
        assert float(row["bytes"]) > 8 * 11 * float(row["particles"])
        timed = int(row["timed"])  # three times, unless a busy machine makes that ten seconds
        spread = float(row["seconds_spread"] or 0.0)
        assert timed == 3 or seconds * (1.0 + spread) * timed >= 10.0
        assert timed == 1 or spread > 0.0
    errors = [float(r["error_l2"]) for r in rows]
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]  # second order, nearly


def test_its_words_follow_from_its_table(done):
    folder, said = done
    errors = [float(r["error_l2"]) for r in rows_of(folder)]
    order = math.log(errors[0] / errors[2]) / math.log(4.0)
    assert f"the error falls with order {order:.2f}" in said
    assert f"{100 * errors[2]:.3g} % costs" in said
    page = (folder / "out" / "study.md").read_text()
    assert "| space.spacing |" in page and "half that error" in page
    assert (folder / "out" / "study.png").stat().st_size > 10_000
    assert said.count("run 3 of 3") == 2  # rank 0 alone speaks


def test_an_error_is_answered_with_settings_to_paste(done, tmp_path):
    folder, said = done
    answer = said[said.index("For an error of 0.2 %") :].splitlines()
    assert answer[1] == "[space]"
    spacing = float(answer[2].removeprefix("spacing = "))
    errors = {float(r["space.spacing"]): float(r["error_l2"]) for r in rows_of(folder)}
    slope = math.log(errors[0.05] / errors[0.0125]) / math.log(4.0)
    assert spacing == pytest.approx(0.0125 * (0.002 / errors[0.0125]) ** (1 / slope), rel=0.05)
    assert load(folder / "wave.toml", [f"space.spacing={spacing!r}"]).space.spacing == spacing
    assert round(1.0 / spacing) == pytest.approx(1.0 / spacing)  # the period is a multiple of it


def test_a_spacing_that_fits_and_stays_within_what_was_asked():
    assert fitting(0.123, []) == 0.123 and fitting(0.12385, []) == 0.123
    assert fitting(0.12385, [], coarser=True) == 0.124
    assert fitting(0.123, [1.0]) == 1.0 / 9 and fitting(0.5, [1.0]) == 0.5
    assert fitting(0.123, [1.0], coarser=True) == 1.0 / 8
    assert fitting(0.3, [1.0, 0.6]) == pytest.approx(0.2)
    assert fitting(0.3, [1.0, 2**0.5], [1.0]) == 0.25  # not all: then what comes next
    assert fitting(0.3, [1.0, 2**0.5]) == 0.3  # nothing fits: a warning says so


def test_a_stored_study_predicts_a_run_outside_the_fit(done, tmp_path):
    folder, _ = done
    case = load(folder / "wave.toml", ["space.spacing=0.00625"])
    lines = list(predicted(folder / "out", case))
    predicted_error = float(lines[1].split()[1])
    job = study(tmp_path, "--vary", "space.spacing=0.00625,0.0125")
    assert job.returncode == 0, job.stderr
    [finest] = [r for r in rows_of(tmp_path) if float(r["space.spacing"]) == 0.00625]
    assert 1 / 1.5 < predicted_error / (100 * float(finest["error_l2"])) < 1.5
    job = subprocess.run(
        [sys.executable, "-m", "psph", "explain", str(folder / "wave.toml"), "--study", str(folder / "out")],
        capture_output=True,
        text=True,
        env=clean_environment(),
        timeout=60,
    )
    assert "From the study in" in job.stdout and "velocity at the end" in job.stdout
    with pytest.raises(
        StudyError,
        match=r"holds a study of .*wave\.toml: fluids\.air\.density is"
        r" 1\.0 there and 2\.0 here; give the folder of a study of .*wave\.toml",
    ):
        list(predicted(folder / "out", load(folder / "wave.toml", ["fluids.air.density=2.0"])))
    aside = load(folder / "wave.toml", ["output.log=0.05", "title=again", "study.repeats=1"])
    assert list(predicted(folder / "out", aside))
    with pytest.raises(StudyError, match="holds no study"):
        list(predicted(tmp_path, case))


def test_a_result_is_used_again_only_for_the_same_sources(tmp_path, monkeypatch):
    (tmp_path / "wave.toml").write_text(WAVE)
    case, performed = load(tmp_path / "wave.toml"), []

    def blows_up(*_, **__):
        performed.append(runs.SOURCES)
        raise BlowUp("too fast")

    monkeypatch.setattr(runs, "run", blows_up)
    for sources in ("one", "one", "two"):
        monkeypatch.setattr(runs, "SOURCES", sources, raising=False)
        assert runs.perform(case, tmp_path / "out", alone(), 1, print)["status"] == "too fast"
    assert performed == ["one", "two"]


@pytest.mark.long
def test_an_interrupted_study_goes_on_from_its_finished_runs(done):
    folder, _ = done
    before = rows_of(folder)
    kept = folder / "out" / "run-02" / "result.json"
    kept.unlink()
    again = study(folder, ranks=2)
    assert again.returncode == 0, again.stderr
    assert again.stdout.count("done before") == 2
    after = rows_of(folder)
    assert [r["error_l2"] for r in after] == [r["error_l2"] for r in before]
    assert after[0]["seconds"] == before[0]["seconds"] and kept.exists()
    one = study(folder)  # another number of ranks is another timing
    assert "done before" not in one.stdout


@pytest.mark.long
def test_a_study_that_is_killed_goes_on_where_it_was(tmp_path):
    file = tmp_path / "wave.toml"
    file.write_text(WAVE.replace("end = 0.1", "end = 3.0"))  # the last run takes long enough
    command = [sys.executable, "-m", "psph", "study", str(file), "--out", str(tmp_path / "out")]
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=clean_environment(),
        preexec_fn=hears_interrupts,
    ) as job:
        for line in job.stdout:
            if line.startswith("run 1 of 3") and "steps" in line:
                job.send_signal(signal.SIGINT)
        said = job.stderr.read()
    stopped = "stopped: the same command goes on after the runs that are done\n"
    assert (job.returncode, said) in [(130, "interrupted\n"), (75, stopped)]  # before a step, or in one
    assert (tmp_path / "out/run-01/result.json").exists()
    assert not (tmp_path / "out/run-03/result.json").exists()
    assert not (tmp_path / "out/study.csv").exists()
    again = study(tmp_path, "--vary", "space.spacing=0.05,0.04", text=file.read_text())
    assert again.returncode == 0, again.stderr
    assert again.stdout.count("done before") == 1


def test_a_run_that_blows_up_or_is_refused_is_a_row(tmp_path):
    vary = '"time.step" = [1e-3, 0.02], "space.spacing" = [0.05, 0.025, 0.0124]'
    text = WAVE.replace('"space.spacing" = [0.05, 0.025, 0.0125]', vary)
    job = study(tmp_path, "--set", "time.end=2.0", text=text)
    assert job.returncode == 0, job.stderr
    status = {(r["space.spacing"], r["time.step"]): r["status"] for r in rows_of(tmp_path)}
    assert status["0.05", ""] == status["0.025", ""] == status["0.025", "0.001"] == "done"
    when_and_why = r"blew up at step \d+, time [\d.e-]+ s: .*(speeds of sound|not finite|of its rest density)"
    assert re.search(when_and_why, status["0.025", "0.02"])
    assert status["0.0124", ""].startswith("refused: ") and "whole number" in status["0.0124", ""]
    assert "2 of 5 runs did not finish" in job.stdout


def test_what_a_study_varies_is_blamed_as_such(tmp_path):
    """The key was not given by --set."""
    job = study(tmp_path, "--vary", "space.spacin=0.05,0.04")
    assert job.returncode == 2 and "with vary space.spacin=0.0" in job.stdout + job.stderr


def test_a_study_of_which_no_run_finished_fails_and_says_so(tmp_path):
    text = WAVE.replace('"space.spacing" = [0.05, 0.025, 0.0125]', '"space.spacing" = [0.0512, 0.0124]')
    job = study(tmp_path, text=text)
    assert job.returncode == 3 and "2 of 2 runs did not finish" in job.stdout
    assert "study: no run has finished, see their status" in job.stderr


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--vary", "space.spacing=0.1"], "one value only"),
        (["--vary", "space.spacin=0.1,0.2"], "spacin"),
        (["--set", "study.error=heat"], "study.error: heat is not measured; give one of velocity"),
        (["--set", "study.against=theory"], "study.against: theory has no velocity"),
        (["--set", "exact.sound_wave.length=0.7"], "exact.sound_wave: repeats every 0.7 m"),
        (["--error", "-1"], "study --error -1: give a number above zero"),
        (
            [
                "--set",
                "exact=off",
                "--set",
                "fluids.air.velocity=[1.0]",
                "--set",
                "fluids.air.pressure=0.0",
                "--vary",
                "time.cfl=0.1,0.2",
            ],
            "no reference",
        ),
    ],
)
def test_what_makes_no_sense_is_said_before_any_run(tmp_path, options, says):
    job = study(tmp_path, *options)
    assert job.returncode == 2 and says in job.stderr, job.stderr
    assert not (tmp_path / "out").exists() and "Traceback" not in job.stderr


@pytest.mark.long
def test_profiles_are_a_choice_that_can_be_pasted(tmp_path):
    """Beside the default scheme without a profile; in the answer by the keys that they change."""
    job = study(
        tmp_path,
        "--vary",
        "profile=off,quick,reference",
        "--vary",
        "space.spacing=0.05,0.025",
        "--grid",
        "--error",
        "0.3",
        "--set",
        "scheme=stable",
        "--set",
        "study.repeats=1",
    )
    assert job.returncode == 0, job.stderr
    rows = rows_of(tmp_path)
    assert [r["profile"] for r in rows] == 2 * ["off", "quick", "reference"]
    assert all(r["status"] == "done" for r in rows)
    assert len({r["error_l2"] for r in rows}) == 6
    answer = job.stdout[job.stdout.index("For an error of 30 %") :].partition("wrote")[0]
    assert "profile =" not in answer and "spacing = 0.06" in answer


@pytest.mark.long
def test_effects_are_left_out_one_by_one(tmp_path):
    text = WAVE.replace("[fluids.air]", "artificial_viscosity = 0.05\n[fluids.air]").replace(
        "density = 1.0", "density = 1.0\nviscosity = 1e-9"
    )
    job = study(tmp_path, "--effects", text=text)
    assert job.returncode == 0, job.stderr
    assert [r["status"] for r in rows_of(tmp_path)] == ["done"] * 3
    assert "laminar viscosity: it changes no answer of this case" in job.stdout
    assert "artificial viscosity: nothing" not in job.stdout  # it damps the wave
    case = load(tmp_path / "wave.toml")
    assert set(without_each(case)) == {"laminar viscosity", "artificial viscosity"}


def test_a_run_that_does_not_fit_into_the_memory_does_not_end_the_study(tmp_path, monkeypatch):
    """Nor is it kept as impossible: more memory may be free the next time."""
    (tmp_path / "wave.toml").write_text(WAVE)
    every = [{"space.spacing": dx} for dx in (0.05, 0.00125, 0.025)]
    case = load(tmp_path / "wave.toml", ["space.spacing=0.00125"])
    needed = bytes_of_rank(Scene(case), make_plan(Scene(case)), 1)

    def statuses():
        made = StudyRuns(tmp_path / "wave.toml", ["study.repeats=1"], every, tmp_path / "out", alone())
        return [row["status"] for row in made.run(lambda line: None)]

    monkeypatch.setattr(memory_check, "free_memory", lambda: 0.9 * needed)
    first, lacking, last = statuses()
    assert first == last == "done"
    assert re.fullmatch(
        r"not possible here: wave: 800 particles need about [\d.]+ GiB on one machine, .*", lacking
    )
    monkeypatch.undo()
    assert statuses() == ["done"] * 3


def test_words_of_an_effect_that_a_case_needs():
    base = {"status": "done", "seconds": 2.0, "mean P": 10.0, "error_l2": math.nan}
    rows = {"": base, "gravity": {"status": "it blew up"}, "friction": base | {"seconds": 1.0, "mean P": 9.0}}
    lines = list(effects_words(rows))
    assert lines[0] == "gravity: the case needs it; without it, it blew up."
    assert lines[1] == "friction: 50 % of the time; it changes P by 10 %."
    assert list(effects_words({"": {"status": "it blew up"}}))[0].endswith("does not finish: it blew up.")


def test_the_front_holds_what_nothing_beats():
    made = [{"seconds": s, "error_l2": e} for s, e in ((1, 0.5), (2, 0.6), (3, 0.1), (4, math.nan))]
    assert pareto(made) == [made[0], made[2]]


def test_a_table_from_an_experiment_is_a_reference(tmp_path):
    (tmp_path / "curve.csv").write_text("# source\nT,Z\n0.0,2.0\n2.0,4.0\n")
    text = """
[experiments.gauge]
file = "curve.csv"
time = "T"
value = "Z"
probe = "P.pressure"
time_unit = 0.05
value_unit = 10.0
"""
    (tmp_path / "wave.toml").write_text(WAVE + text)
    judge = Judge(load(tmp_path / "wave.toml", ["study.error=P.pressure", "study.against=gauge"]))
    time, value = judge.measured
    assert time.tolist() == [0.0, 0.1] and value.tolist() == [20.0, 40.0]
    for change, says in (
        ("experiments.gauge.file=none.csv", "No such file"),
        ("experiments.gauge.time=Time", "has no column 'Time'; give one of T, Z"),
        (
            "study.after=0.2",
            "study.after: 0.2 s leaves nothing to compare, since the comparison ends at 0.1 s",
        ),
        ("study.until=0.05", None),  # its first time is enough
    ):
        sets = ["study.error=P.pressure", "study.against=gauge", change]
        if says:
            with pytest.raises(StudyError, match=says):
                Judge(load(tmp_path / "wave.toml", sets))
        else:
            assert Judge(load(tmp_path / "wave.toml", sets)).measured[0][0] == 0.0
    (tmp_path / "curve.csv").write_text("T,Z\n20.0,2.0\n40.0,4.0\n")
    with pytest.raises(StudyError, match="gauge: measured from 1 to 2 s, compared from 0 to 0.1 s"):
        Judge(load(tmp_path / "wave.toml", ["study.error=P.pressure", "study.against=gauge"]))


def test_norms_and_interpolation_by_hand():
    found = series_errors(np.array([1.0, 2.0]), np.array([2.0, 2.0]))
    assert found == pytest.approx((0.25, math.sqrt(1 / 8), 0.5))
    assert all(map(math.isnan, series_errors(np.empty(0), np.empty(0))))  # a probe that stayed dry
    grid = (np.indices((20, 20)).reshape(2, -1).T + 0.5) * 0.1
    at = np.array([[0.83, 1.21], [1.5, 0.5]])
    linear = interpolated(grid, grid @ [2.0, 1.0], at, 0.1, (None, None))
    assert linear == pytest.approx(at @ [2.0, 1.0], rel=0.02)
    assert interpolated(grid, grid, np.array([[9.0, 9.0]]), 0.1, (None, None)) == pytest.approx(grid[-1:])


def test_values_between_particles_know_of_the_period():
    """A periodic field near the edges, from particles that stand on one side of each edge only."""
    lower, periods = np.array([-0.3, 0.0]), (1.0, None)
    grid = lower + (np.indices((20, 4)).reshape(2, -1).T + 0.5) * 0.05
    wave = np.sin(2.0 * np.pi * (grid[:, 0] + 0.313))
    at = np.array([[-0.299, 0.1], [0.699, 0.1], [-0.3, 0.1], [0.7 - 1e-17, 0.1]])
    exact = np.sin(2.0 * np.pi * (at[:, 0] + 0.313))
    assert interpolated(grid, wave, at, 0.05, periods) == pytest.approx(exact, abs=0.02)
    assert np.abs(interpolated(grid, wave, at, 0.05, (None, None)) - exact).min() > 0.1
    beyond = interpolated(grid, wave, np.array([[0.2, 0.25]]), 0.05, (None, 0.2))
    assert beyond == pytest.approx(interpolated(grid, wave, np.array([[0.2, 0.05]]), 0.05, (None, 0.2)))


def test_the_finest_run_is_compared_across_the_period(tmp_path):
    """As if its particles stood there three times, side by side."""
    text = WAVE.replace('velocity = "exact"', "velocity = [0.4]").replace("1e-4", "0.5")
    (tmp_path / "wave.toml").write_text(text)
    sets = ["study.against=finest", "study.error=pressure", "scheme=sph"]
    found = {}
    for spacing in (0.05, 0.025):
        case = load(tmp_path / "wave.toml", [*sets, f"space.spacing={spacing}"])
        run(case, tmp_path / f"{spacing}", alone(), say=lambda *_: None)
        frame = Run(tmp_path / f"{spacing}").frame(-1, "position", "pressure")
        found[spacing] = frame["position"], frame["pressure"]
    coarse, (x, p) = found[0.05], found[0.025]
    side_by_side = interpolated(
        np.concatenate([x - 1.0, x, x + 1.0]), np.tile(p, 3), coarse[0], 0.025, (None,)
    )
    judged, _ = Judge(case).errors(tmp_path / "0.05", tmp_path / "0.025")
    assert judged == pytest.approx(series_errors(coarse[1], side_by_side), rel=1e-12)
    one_sided = interpolated(x, p, coarse[0], 0.025, (None,))
    assert judged.l1 < 0.999 * series_errors(coarse[1], one_sided).l1


def test_the_finest_run_judges_where_nothing_else_does(tmp_path):
    text = WAVE.replace('"exact"', "0.0").replace("velocity = 0.0", "velocity = [0.5]")
    text = text[: text.index("[exact")] + text[text.index("[probes") :] + 'error = "velocity"\n'
    job = study(tmp_path, text=text)
    assert job.returncode == 0, job.stderr
    errors = [r["error_l2"] for r in rows_of(tmp_path)]
    assert max(map(float, errors)) < 1e-12  # a uniform flow stays one
    case = load(tmp_path / "wave.toml")
    assert Judge(case).in_words == "velocity at the end against the finest run"
    assert alone().size == 1 and json.loads((tmp_path / "out" / "study.json").read_text())["ranks"] == 1


def test_errors_against_the_finest_run_hold_its_own(done, tmp_path):
    """By a wave whose exact solution is known: what is promised without it holds against it."""
    asked = 0.01
    job = study(
        tmp_path, "--set", "study.against=finest", "--set", "study.error=velocity", "--error", str(asked)
    )
    assert job.returncode == 0, job.stderr
    true = {float(r["space.spacing"]): float(r["error_l2"]) for r in rows_of(done[0])}
    rows = {float(r["space.spacing"]): r for r in rows_of(tmp_path)}
    for dx, row in rows.items():
        assert 1 / 1.3 < float(row["error_l2"]) / true[dx] < 1.3
    assert float(rows[0.025]["difference_l2"]) < 0.85 * true[0.025]  # what was told as its error
    assert "The errors include that of the finest run itself, estimated as" in job.stdout
    answer = job.stdout[job.stdout.index("For an error of 1 %") :].splitlines()
    spacing = float(answer[2].removeprefix("spacing = "))
    order = math.log(true[0.05] / true[0.0125]) / math.log(4.0)
    assert 0.5 * asked < true[0.0125] * (spacing / 0.0125) ** order < 1.1 * asked


def test_a_study_comes_onto_a_page_with_its_picture(done, tmp_path):
    folder, _ = done
    (tmp_path / "images").mkdir()
    page = tmp_path / "page.md"
    page.write_text(f"# Before\n{BEGIN}\nold\n{END}\nafter\n")
    assert on_page([str(page), str(folder / "out")]) == 0
    text = page.read_text()
    assert "| out | velocity | " in text and "old" not in text and text.endswith(f"{END}\nafter\n")
    assert "(images/accuracy_out.png)" in text and (tmp_path / "images/accuracy_out.png").exists()
    assert on_page([str(page), str(tmp_path)]) == 2 and on_page([]) == 2


def test_studies_of_profiles_come_as_one_table(done, tmp_path):
    folder, _ = done
    (tmp_path / "images").mkdir()
    page, kept = tmp_path / "page.md", tmp_path / "kept"
    page.write_text(f"{BEGIN}\n{END}\n")
    kept.mkdir()
    run = {"space.spacing": 0.02, "status": "done", "error_l2": 0.0123, "seconds": 4.2}
    rows = [
        run | {"profile": "quick"},
        {"profile": "reference", "space.spacing": 0.02, "status": "the run blew up at step 3: too fast"},
    ]
    told = {"vary": ["profile"], "rows": rows, "error": "velocity at the end", "case": "a/wave.toml"}
    (kept / "study.json").write_text(json.dumps(told))
    assert on_page([str(page), str(kept), str(folder / "out")]) == 0
    text = page.read_text()
    assert "| wave | velocity | 0.02 | – | 1.23 % in 4.2 s | the run blew up at step 3 |" in text
    assert text.index("## Error") < text.index("## The cost") and text.count("## ") == 2


def test_a_series_of_spacings_is_a_row(tmp_path):
    (tmp_path / "images").mkdir()
    page, kept = tmp_path / "page.md", tmp_path / "vortex"
    page.write_text(f"{BEGIN}\n{END}\n")
    kept.mkdir()
    rows = [
        {
            "space.spacing": 0.08 / 2**k,
            "status": "done",
            "error_l2": error,
            "seconds": 0.1 * 8**k,
            "particles": 100 * 4**k,
            "steps": 100 * 2**k,
        }
        for k, error in enumerate((0.16, 0.04, 0.01, 0.003))
    ]
    told = {"vary": ["space.spacing"], "rows": rows, "error": "velocity", "case": "a.toml", "dimensions": 2}
    (kept / "study.json").write_text(json.dumps(told))
    assert on_page([str(page), str(kept)]) == 0
    text = page.read_text()
    assert "| vortex | velocity | 0.08, 0.04, 0.02, 0.01 | 16 %, 4 %, 1 %, 0.3 % | 51 s | 1.9" in text


def test_rows_of_a_probe_without_fluid_in_reach_are_left_out():
    table = {"time": np.arange(4.0), "P1.pressure": np.array([np.nan, 5.0, np.nan, 7.0])}
    assert [x.tolist() for x in known_values(table, "P1.pressure")] == [[1.0, 3.0], [5.0, 7.0]]


def test_no_value_is_carried_from_wet_rows_to_dry_ones():
    none = np.nan
    table = {"time": np.arange(6.0), "V.velocity_x": np.array([none, 5.0, 7.0, none, 1.0, 3.0])}
    at = np.array([-0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5])
    told = [none, none, none, 5.0, 6.0, 7.0, none, none, none, 1.0, 2.0, 3.0, none]
    assert value_at(at, table, "V.velocity_x") == pytest.approx(told, nan_ok=True)
    table["V.velocity_x"][:] = none
    assert np.isnan(value_at(at, table, "V.velocity_x")).all()
