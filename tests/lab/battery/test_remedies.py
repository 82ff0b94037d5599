"""Remedies beside each other: the rows, what some of them hold and do not, the page."""

import csv

import pytest
from mpi4py import MPI

from psph.__main__ import main
from psph.case import load
from psph.errors import Refused
from psph.lab.battery import command, comparison, tables
from psph.lab.battery.command import compare, file_of
from psph.lab.battery.comparison_page import main as on_page
from psph.lab.battery.measures import MEASURES
from psph.lab.battery.remedies import PLAIN, REMEDIES, SHOWN, Remedy, trials
from psph.lab.battery.remedies import comparison as comparison_of
from psph.lab.battery.verdicts import BLEW_UP, FAILS, GOOD, Row
from psph.scene import Scene
from psph.simulation.plan import make_plan

NAMES = [remedy.name for remedy in REMEDIES]
SHIFT = Remedy(("physics.position_shift=0.1",))
OWN = REMEDIES[-1]


# The rows


def case_of(trial, remedy, folder):
    return load(file_of(MPI.COMM_SELF, trial, remedy.name, folder), trial.overrides(remedy.name))


def what_acts(case):
    """Kernel and effects; two that have no parameter are equal as tuples."""
    return case.space, [(type(effect), effect) for effect in make_plan(Scene(case)).effects]


@pytest.mark.parametrize("remedy", REMEDIES, ids=NAMES)
def test_a_remedy_stands_alone_beside_plain_sph(remedy, tmp_path):
    for trial in trials([remedy]):
        case = case_of(trial, remedy, tmp_path)
        assert case.scheme == ("stable" if remedy == OWN else "sph")
        assert case.guards.on_trouble == "warn" and case.time.end == trial.end
        [plain] = [case_of(one, REMEDIES[0], tmp_path) for one in trials() if one.name == trial.name]
        assert (what_acts(case) == what_acts(plain)) == (remedy == REMEDIES[0])


def test_the_rows_are_told_apart():
    assert len(set(NAMES)) == len(NAMES) and NAMES[0] == 'scheme = "sph"' == Remedy((PLAIN,)).name
    assert 'pressure_gradient = "tensile_control", particle_shifting = 0.1' in NAMES
    assert "background_pressure = 3000, in the patch 20" in NAMES
    box, jittered, patch = trials()
    there = "background_pressure = 3000, in the patch 20"
    assert "physics.background_pressure=3000" in jittered.overrides(there)
    assert "physics.background_pressure=20" in patch.overrides(there)
    assert tuple(SHOWN) == (box.name, jittered.name, patch.name)
    assert {name for shown in SHOWN.values() for name in shown} <= MEASURES.keys()


# Some of them, run


@pytest.fixture(scope="module")
def some(tmp_path_factory):
    """(folder, rows) of plain SPH, a shift and the default scheme."""
    folder = tmp_path_factory.mktemp("remedies")
    return folder, compare(MPI.COMM_SELF, comparison_of((REMEDIES[0], SHIFT, OWN)), folder)


def found(rows, trial, remedy):
    [row] = [row for row in rows if (row.trial, row.column) == (trial, remedy.name)]
    return row


@pytest.mark.timeout(600)
def test_plain_sph_tears_and_the_own_scheme_holds(some):
    _, rows = some
    for trial in SHOWN:
        assert found(rows, trial, REMEDIES[0]).verdict == FAILS
        assert found(rows, trial, OWN).verdict == GOOD
    assert found(rows, "patch", REMEDIES[0]).found["pieces"] > 5
    growth = found(rows, "4.2", REMEDIES[0]).found["growth"]
    assert growth == pytest.approx(2470, rel=0.02)  # linear theory of the kick, docs/stability.md
    assert found(rows, "4.2", OWN).found["growth"] == 0.0


@pytest.mark.timeout(600)
def test_a_shift_holds_the_patch_and_slows_no_tension(some):
    _, rows = some
    held = found(rows, "patch", SHIFT).found
    assert held["pieces"] == 1 and held["angular"] < 0.02
    assert found(rows, "4.2", SHIFT).verdict == FAILS
    growth = [found(rows, "4.2", one).found["growth"] for one in (SHIFT, REMEDIES[0])]
    assert growth[0] == pytest.approx(growth[1], rel=0.01)


@pytest.mark.timeout(600)
def test_files_and_page(some, tmp_path, capsys):
    folder, rows = some
    table = list(csv.DictReader(open(folder / "remedies.csv", encoding="utf-8")))
    assert [(r["trial"], r["scheme"]) for r in table] == [(r.trial, r.column) for r in rows]
    page = tmp_path / "page.md"
    page.write_text("# A\n<!-- remedies: begin -->\nbefore\n<!-- remedies: end -->\nafter\n")
    assert on_page(["remedies", str(page), str(folder)]) == 0
    made = page.read_text(encoding="utf-8")
    assert "before\n" not in made and "after\n" in made
    plain, shift, own = (f"| `{one.name}` |" for one in (REMEDIES[0], SHIFT, OWN))
    [told] = [line for line in made.splitlines() if line.startswith(plain)]
    cells = [cell.strip() for cell in told.strip("|").split("|")]
    assert cells[1].startswith("− 2") and len(cells) == 1 + len(SHOWN)
    assert made.index(plain) < made.index(shift) < made.index(own)
    whole = (folder / "remedies.md").read_text(encoding="utf-8")
    assert "`growth`: growth" in made and "`late_speed`" in whole and "`late_speed`" not in made
    assert "- patch holds: `lost` ≤ 0, `near_5` ≥ 0.6" in whole and "- patch holds" not in made
    assert on_page(["remedies", str(page), str(tmp_path)]) == 2 and on_page([]) == 2
    assert "give the folder of a comparison of remedies" in capsys.readouterr().err


@pytest.mark.timeout(600)
def test_finished_runs_are_not_done_again(some, capsys):
    folder, rows = some
    logs = sorted(folder.glob("*/log.csv"))
    before = [path.stat().st_mtime_ns for path in logs]
    assert compare(MPI.COMM_SELF, comparison_of((REMEDIES[0], SHIFT, OWN)), folder) == rows
    assert [path.stat().st_mtime_ns for path in logs] == before and len(logs) == len(rows) == 9
    said = capsys.readouterr().out
    assert 'patch, scheme = "sph": fails at t = 2' in said and "wrote" in said
    [told] = [line for line in said.splitlines() if line.startswith('scheme = "sph"  ')]
    assert told.split()[3:5] == ["−", tables.number(rows[0].found["growth"])]  # the table


# What is told of what ended early, and the command line


def test_a_run_that_blew_up_says_when():
    every = trials(REMEDIES[:1])
    rows = [
        Row(t.name, NAMES[0], False, FAILS, t.shown, "done", {t.shown: 2454.3}, (), 0.1, 1.0)
        for t in every[:2]
    ]
    late = {"kinetic": 9.0, "pieces": 7.0}
    rows.append(Row("patch", NAMES[0], False, BLEW_UP, "kinetic", "torn", late, (), 1.25, None))
    _, _, told, *_ = comparison.markdown(comparison_of(REMEDIES[:1]), rows)
    assert "| − 2454 | – | – |" in told and told.endswith("| × 1.2 s | – | – | – |")


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (2454.3, "2454"),
        (0.95512, "0.955"),
        (1e-7, "1e-07"),
        (float("inf"), "inf"),
        (2e9, "2e+09"),
        (None, "–"),
        (float("nan"), "–"),
    ],
)
def test_numbers(value, told):
    assert tables.number(value) == told


def test_the_command_line(monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(command, "compare", lambda comm, of, out: asked.append((of.name, out)))
    for name in ("remedies", "walls"):
        assert main(["stability", f"--{name}", "--out", str(tmp_path)]) == 0
    assert asked == [("remedies", tmp_path), ("solids", tmp_path / "solids"), ("walls", tmp_path)]
    for other in ("--battery", "--quick"):
        with pytest.raises(Refused, match="^stability --remedies: stands alone"):
            main(["stability", "--remedies", other])
