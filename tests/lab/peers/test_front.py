"""The picture of error against seconds, and older sources beside these ones."""

import subprocess
from pathlib import Path

import pytest

from psph.lab.errors import PeersError, RunBlewUp
from psph.lab.peers import command, front, own
from psph.lab.peers.benchmarks import BENCHMARKS, numbers
from psph.lab.peers.front import Dot, curves_of, draw, kind
from psph.lab.peers.page import table
from psph.lab.peers.records import Job

ROOT = Path(__file__).parents[3]

VORTICES = {
    "psph, default scheme, 50²": ("0.49", "1.6", "2.2 (2.0–2.4)", "5.6", "a, 1"),
    "psph, default scheme, 25²": ("1.3", "2.8", "0.7", "3.3", "a, 1"),
    "PySPH `tvf`, jittered": ("9", "18", "31", "32", "b, 1"),
    "SPHinXsys": ("62", "69", "–", "1.3", "c, 1"),
    "psph, SSPH, 50²": (*BENCHMARKS["taylor_green"].blown, "a, 1"),
}


def test_runs_of_one_kind_are_joined_from_the_cheapest_on():
    """What blew up has no point; a run whose own seconds are unknown has those of the whole."""
    assert curves_of(BENCHMARKS["taylor_green"], VORTICES) == {
        "psph, default scheme": [Dot(0.7, 1.3, "25²"), Dot(2.2, 0.49, "50²")],
        "PySPH `tvf`, jittered": [Dot(31.0, 9.0, "")],
        "SPHinXsys": [Dot(1.3, 62.0, "")],
    }


def test_an_error_of_two_numbers_is_their_rms():
    assert BENCHMARKS["cavity"].error(("1 / 2", "0.03 / 0.04", "9 / 9")) == pytest.approx(3.5355, abs=1e-4)
    assert BENCHMARKS["box"].error(("30", "40", "0.4", "9")) == pytest.approx(35.355, abs=1e-3)
    assert BENCHMARKS["tank"].error(("– / –", "–", "–")) is None and numbers("35 (33–38)") == [35, 33, 38]


def test_a_colour_is_that_of_a_code_and_of_psph_that_of_a_scheme():
    assert kind("PySPH `tvf`, jittered") == ("PySPH", "tvf, jittered")
    assert kind("SPHinXsys, relaxed") == ("SPHinXsys", "relaxed")
    assert kind("psph, plain SPH, half") == ("psph, plain SPH", "half")
    assert kind("psph before") == ("psph before", "")
    assert kind("psph, `taylor_green.toml`")[0] == "psph, as set up for it"


def test_the_picture_has_a_panel_for_each_table(tmp_path):
    """Tables without rows have empty panels; a page without a table is refused."""
    page = tmp_path / "peers.md"
    made = {name: table(of.head, {}) for name, of in BENCHMARKS.items()}
    made["taylor_green"] = table(BENCHMARKS["taylor_green"].head, VORTICES)
    page.write_text("".join(f"<!-- {n}: begin -->\n{text}\n<!-- {n}: end -->\n" for n, text in made.items()))
    assert draw(page, tmp_path / "front.png").read_bytes()[:4] == b"\x89PNG"
    page.write_text("nothing")
    with pytest.raises(PeersError, match="no place for"):
        draw(page, tmp_path / "front.png")


def test_no_label_stands_on_another(tmp_path, monkeypatch):
    """Two runs a point apart.  The control: with one place for a label, they do."""

    def covered(corners):
        drawn = []
        monkeypatch.setattr(front, "CORNERS", corners)
        monkeypatch.setattr(front.style, "save", lambda figure, path: drawn.append(figure) or path)
        page = tmp_path / "peers.md"
        near = {"psph, plain SPH, 50²": ("0.50", "1.6", "2.3", "5.6", "a, 1")}
        made = {name: table(of.head, {}) for name, of in BENCHMARKS.items()}
        made["taylor_green"] = table(BENCHMARKS["taylor_green"].head, VORTICES | near)
        blocks = (f"<!-- {n}: begin -->\n{text}\n<!-- {n}: end -->\n" for n, text in made.items())
        page.write_text("".join(blocks), encoding="utf-8")
        draw(page, tmp_path / "front.png")
        boxes = [text.get_window_extent() for axes in drawn[0].axes for text in axes.texts]
        assert len(boxes) == 4
        return sum(box.count_overlaps(boxes) - 1 for box in boxes)

    assert covered(front.CORNERS) == 0
    assert covered(front.CORNERS[:1]) > 0


def test_a_run_that_blows_up_says_so_in_its_row(tmp_path, monkeypatch):
    """Control: one that cannot start has no row."""
    monkeypatch.chdir(ROOT)
    keys = ("time.end=1", "scheme=sph", "space.spacing=0.05", "guards.speed=0.01")
    case = own.CASES / "hard/taylor_green.toml"
    with pytest.raises(RunBlewUp, match="the run blew up"):
        own.run(own.HERE, case, keys, tmp_path / "blown")
    with pytest.raises(PeersError, match="no_such_key") as raised:
        own.run(own.HERE, case, ("no_such_key=1",), tmp_path / "wrong")
    assert not isinstance(raised.value, RunBlewUp)

    class Code:
        name = "psph"

        def jobs(self, benchmark):
            return [Job(name, run) for name, run in (("blown", blown), ("wrong", wrong))]

    def blown(folder):
        raise RunBlewUp("it blew up")

    def wrong(folder):
        raise PeersError("no such key")

    rows = command.in_turns("tank", {"psph": (Code(), "1.0")}, 2, tmp_path, "2026-11-28")
    assert rows == {"blown": ("blew up", "–", "–", "–", "–", "1.0, 2026-11-28")}
    assert table(BENCHMARKS["tank"].head, rows)


def test_older_sources_run_their_own_cases(tmp_path):
    """A copy of the case under other sources; controls: a folder without cases, one without a commit."""
    with pytest.raises(PeersError, match="no run/cases there; give a folder of older sources"):
        own.Earlier(tmp_path)
    (tmp_path / own.CASES).mkdir(parents=True)
    earlier = own.Earlier(tmp_path)
    with pytest.raises(PeersError, match="no commit; give a checkout"):
        earlier.prepare()
    words = ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "--allow-empty", "-m", "a"]
    for of in (["init", "-q"], words):
        subprocess.run(["git", "-C", str(tmp_path), *of], check=True)
    assert len(earlier.prepare()) == 9
    assert [job.label for job in earlier.jobs("tank")] == ["psph before, dx 0.02"]
    with pytest.raises(PeersError, match="tank.toml: no such file"):
        earlier.jobs("tank")[0].run(tmp_path / "out")
