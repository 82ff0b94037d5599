"""The quick battery itself, its table, its verdicts, its files."""

import csv
import math

import pytest
from mpi4py import MPI

from psph.case import load
from psph.case.schemes import SCHEMES
from psph.lab.battery import command, tables
from psph.lab.battery.command import CASES, battery, folder_of
from psph.lab.battery.measures import MEASURES
from psph.lab.battery.page import main as on_page
from psph.lab.battery.trials import BATTERY, CONTROLS, OURS, QUICK, Bound, Trial
from psph.lab.battery.verdicts import BLEW_UP, FAILS, GOOD, HELD, HOLDS, REFUSED, judged, without_effect
from psph.lab.errors import BatteryError
from psph.scene import Scene

EVERY = {trial.name: trial for trial in (*BATTERY, *QUICK)}
FILES = sorted(CASES.glob("*.toml"))


# The table


@pytest.mark.parametrize("trial", EVERY.values(), ids=EVERY.keys())
def test_a_trial_can_be_run(trial):
    assert set(trial.columns) <= {*SCHEMES, *CONTROLS} and trial.schemes[0] == OURS
    assert trial.shown in MEASURES
    assert all(bound.measure in MEASURES for bound in (*trial.holds, *trial.goals))
    for column in trial.columns:
        case = load(CASES / f"{trial.case}.toml", trial.overrides(column))
        assert case.scheme == (column if column in SCHEMES else case.scheme)


ASKED = {
    "box, kick 1e-7 m/s": {("speed", 1.0), ("late_speed", 1e-9)},
    "box, kick 1 m/s": {("late_speed", 1e-4)},
    "box, jitter 10 %": {("late_speed", 1e-4)},
    "cube, jitter 10 %, 3D": {("late_speed", 1e-4)},
    "tank, hydrostatic, 60 s": {("probe_error", 0.005), ("probe_spread", 5.0), ("noise", 0.005)},
    "tank, uniform density, 60 s": {("probe_error", 0.01), ("probe_spread", 5.0), ("noise", 0.005)},
    "rotating patch": {("kinetic", 0.93), ("angular", 0.01), ("momentum", 1e-13), ("pieces", 1)},
    "rotating patch, fine": {("kinetic", 0.95), ("angular", 0.01), ("momentum", 1e-13), ("pieces", 1)},
    "rotating cube, 3D": {("kinetic", 0.93), ("angular", 0.01), ("momentum", 1e-13), ("pieces", 1)},
    "dam break": {("front_error", 0.05)},
    "oscillating drop, 20 periods": {("swing", 0.9)},
    "Taylor–Green, Re 1,000": {("energy_left", 0.95)},
}
"""Bounds whose miss makes a run fail, with the lower end where there is one."""


@pytest.mark.parametrize("name", ASKED)
def test_bounds_are_those_that_were_asked_for(name):
    [trial] = [trial for trial in BATTERY if trial.name == name]
    ends = {(b.measure, b.least if b.least > -math.inf else b.most) for b in trial.holds}
    assert ASKED[name] <= ends
    assert trial.end == {"box": 2.0, "box_3d": 2.0, "patch": 4.0, "patch_3d": 4.0}.get(trial.case, trial.end)


@pytest.mark.parametrize("trial", [t for t in EVERY.values() if "jitter" in t.name], ids=lambda t: t.name)
def test_a_box_in_disorder_keeps_the_kick_of_the_paper(trial):
    """Without it every pressure is the same, and p⁻ computes zero for ever."""
    for column in trial.columns:
        case = load(CASES / f"{trial.case}.toml", trial.overrides(column))
        [kick] = case.perturbations
        assert kick.velocity[0] == 1e-7 and case.fluids["fluid"].jitter > 0.0


def test_every_hard_case_is_in_the_battery():
    assert {trial.case for trial in BATTERY} == {path.stem for path in FILES}
    assert len(BATTERY) == len({trial.name for trial in BATTERY})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_head_of_a_hard_case(path):
    text = path.read_text(encoding="utf-8")
    head = text.split("\n\n")[0]
    assert all(f"\n# {word}:" in head for word in ("Source", "Expect", "Particles", "Command"))
    assert f"run/cases/hard/{path.name}" in head
    count = Scene(load(path)).census.sizes.sum()
    assert f"# Particles: {count:,}" in head
    assert "scheme" not in text.partition("[space]")[0].replace(head, "")  # that of the house


# Verdicts

PATCH = Trial(
    "patch",
    "patch",
    "kinetic",
    1.0,
    1.0,
    1.0,
    holds=(Bound("kinetic", least=0.5),),
    goals=(Bound("kinetic", least=0.9),),
    fails=("no shift",),
)


@pytest.mark.parametrize(
    ("found", "verdict", "broken"),
    [
        ({"kinetic": 0.95, "lost": 0.0}, GOOD, ()),
        ({"kinetic": 0.7, "lost": 0.0}, HOLDS, ("kinetic 0.7 (≥ 0.9)",)),
        ({"kinetic": 0.3, "lost": 0.0}, FAILS, ("kinetic 0.3 (≥ 0.5)", "kinetic 0.3 (≥ 0.9)")),
        ({"kinetic": 0.95, "lost": 2.0}, FAILS, ("lost 2 (≤ 0)",)),
        ({"lost": 0.0}, FAILS, ("kinetic not measured (≥ 0.5)", "kinetic not measured (≥ 0.9)")),
        (
            {"kinetic": float("nan"), "lost": 0.0},
            FAILS,
            ("kinetic nan (≥ 0.5)", "kinetic nan (≥ 0.9)"),
        ),
    ],
)
def test_verdicts(found, verdict, broken):
    row = judged(PATCH, OURS, {"status": "done", "seconds": 1.0}, found, 1.0)
    assert (row.verdict, tuple(map(str, row.broken)), row.control) == (verdict, broken, False)
    control = judged(PATCH, "no shift", {"status": "done"}, found, 1.0)
    good = judged(PATCH, OURS, {"status": "done"}, {"kinetic": 0.95, "lost": 0.0}, 1.0)
    assert control.control and list(without_effect([good, control])) == [control] * (verdict in HELD)


def test_a_control_that_misses_what_the_scheme_misses_too_shows_nothing():
    done = {"status": "done", "seconds": 1.0}
    low = {"kinetic": 0.3, "lost": 0.0}
    ours, idle = (judged(PATCH, column, done, low, 1.0) for column in (OURS, "no shift"))
    shown = judged(PATCH, "no shift", done, low | {"lost": 2.0}, 1.0)
    blown = judged(PATCH, "no shift", {"status": "the run blew up at step 3"}, low, 0.5)
    assert ours.verdict == idle.verdict == FAILS
    assert list(without_effect([ours, idle])) == [idle]
    assert list(without_effect([ours, shown])) == list(without_effect([ours, blown])) == []


def test_a_run_that_ended_early():
    blown = judged(PATCH, OURS, {"status": "the run blew up at step 3"}, {}, 0.25)
    assert blown.verdict == BLEW_UP and tables.cell(blown) == "× 0.25 s"
    # What a guard saw leave the walls is a loss, wherever it is when the run ends.
    spilt = judged(PATCH, OURS, {"status": "the run lost a particle", "lost": True}, {"lost": 0.0}, 0.25)
    assert spilt.verdict == FAILS and tables.cell(spilt) == "− lost at 0.25 s"
    assert str(spilt.broken[0]) == "lost 1 (≤ 0)"
    refused = judged(PATCH, OURS, {"status": "refused: 9 ranks for 3 planes"}, {}, 0.0)
    assert refused.verdict == REFUSED and "9 ranks" in tables.line(refused)
    idle = judged(PATCH, "no shift", {"status": "done"}, {"kinetic": 1.0, "lost": 0.0}, 1.0)
    told = list(tables.sentences([blown, idle]))
    assert f"- `{OURS}` blew up in patch: kinetic not measured (≥ 0.5)." in told
    assert f"- The control no shift misses no bound in patch that `{OURS}` keeps." in told


# The quick battery


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """(folder, rows) of the quick battery."""
    folder = tmp_path_factory.mktemp("battery")
    return folder, battery(MPI.COMM_SELF, True, folder)


@pytest.mark.timeout(600)
def test_the_scheme_holds_and_every_control_fails(quick):
    _, rows = quick
    for row in rows:
        assert (row.verdict not in HELD) if row.control else row.verdict == GOOD, tables.line(row)
    assert {row.column for row in rows if row.control} >= {
        "no background",
        "no potential",
        "no shift",
        "bare 1.2",
    }
    falling = next(row for row in rows if row.column == "no background")
    assert falling.found["growth"] > 1000.0 and rows[0].found["growth"] == 0.0


@pytest.mark.timeout(600)
def test_files_of_the_battery(quick, tmp_path, capsys):
    folder, rows = quick
    table = list(csv.DictReader(open(folder / "battery.csv", encoding="utf-8")))
    assert [(r["trial"], r["scheme"]) for r in table] == [(r.trial, r.column) for r in rows]
    assert float(table[0]["late_speed"]) == rows[0].found["late_speed"]
    text = (folder / "battery.md").read_text(encoding="utf-8")
    assert all(f"| {trial.name} |" in text for trial in QUICK)
    assert (folder / "battery.png").read_bytes()[:4] == b"\x89PNG"
    page = tmp_path / "page.md"
    page.write_text("# A\n<!-- battery: begin -->\nbefore\n<!-- battery: end -->\nafter\n")
    (tmp_path / "images").mkdir()
    assert on_page([str(page), str(folder)]) == 0
    made = page.read_text(encoding="utf-8")
    assert "- `stable` holds in" in made and "| rotating" not in made
    assert "before\n" not in made and "after\n" in made
    assert "(images/battery.png)" in made and (tmp_path / "images/battery.png").exists()
    assert on_page([str(page), str(tmp_path)]) == 2 and on_page([]) == 2
    assert "give the folder of a battery" in capsys.readouterr().err


@pytest.mark.timeout(600)
def test_finished_runs_are_not_done_again(quick, capsys):
    folder, rows = quick
    place = folder_of(folder, QUICK[0], OURS)
    before = (place / "log.csv").stat().st_mtime_ns
    again = battery(MPI.COMM_SELF, True, folder, QUICK[:1])
    assert (place / "log.csv").stat().st_mtime_ns == before
    assert again == rows[: len(again)]
    said = capsys.readouterr().out
    assert "box, kick 1e-7 m/s, stable: good" in said and "wrote" in said


@pytest.mark.mpi(min_size=2)
def test_two_ranks_measure_what_one_does(tmp_path):
    comm = MPI.COMM_WORLD
    folder = comm.bcast(tmp_path)
    goals = (Bound("late_speed", most=1e-7),)
    short = (QUICK[0]._replace(end=2e-3, other_end=2e-3, goals=goals, fails=()),)
    rows = battery(comm, True, folder / "two", short)
    assert len(rows) == (comm.rank == 0)
    if comm.rank == 0:
        [alone] = battery(MPI.COMM_SELF, True, folder / "one", short)
        assert rows[0].found == alone.found and rows[0].verdict == GOOD


def test_cases_that_are_not_there(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "CASES", tmp_path / "none")
    with pytest.raises(BatteryError, match="from psph's own folder"):
        battery(MPI.COMM_SELF, True, tmp_path)
