"""The verb ``stability``: one answer, the map, what is refused, the page."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest
from jobs import clean_environment, mpirun
from mpi4py import MPI

from psph.lab.maps import survey as survey_module
from psph.lab.maps.command import Asked, stability
from psph.lab.maps.elastic import PAGE, elastic
from psph.lab.maps.page import main as on_page
from psph.lab.maps.survey import sentences, survey
from psph.output.errors import OutputError
from psph.smoothing import KERNELS
from psph.theory.stability import STATES
from psph.theory.stability.errors import StabilityError
from psph.theory.stability.growth import growth
from psph.theory.stability.parts import REMEDIES
from psph.theory.stability.uniform import Settings
from psph.theory.stability.windows import SMOOTHINGS

PAPER = Asked(kernel="cubic", smoothing=1.2, pressure=-2500.0, density=900.0, sound_speed=5.0, spacing=1e-3)


def answer(capsys, asked):
    """(what it prints in words, the JSON of its last line)."""
    stability(MPI.COMM_SELF, asked._replace(json=True))
    *said, last = capsys.readouterr().out.splitlines()
    return said, json.loads(last)


def test_the_command_line():
    """As the documentation gives it, in a process of its own."""
    job = subprocess.run(
        [
            sys.executable,
            "-m",
            "psph",
            "stability",
            "--kernel",
            "hyperbolic",
            "--smoothing",
            "1.2",
            "--lattice",
            "square",
            "--state",
            "compression",
            "--form",
            "symmetric",
            "--json",
        ],
        capture_output=True,
        text=True,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
    )
    assert job.returncode == 0 and not job.stderr
    found = json.loads(job.stdout.splitlines()[-1])
    assert list(found) == ["growth_rate", "wave_vector", "stable"]
    assert found["growth_rate"] == pytest.approx(0.28, abs=0.005) and found["stable"] is False
    assert max(map(abs, found["wave_vector"])) == pytest.approx(3.14159, abs=1e-4)


def test_one_rank_speaks_and_a_fault_is_one_line():
    job = mpirun(2, ["-m", "psph", "stability", "--kernel", "cubic", "--state", "tension"])
    assert job.returncode == 0 and job.stdout.count("unstable") == 1
    job = mpirun(2, ["-m", "psph", "stability", "--kernel", "square"])
    assert job.returncode == 2
    assert job.stderr.count("stability --kernel square: not known; one of wendland-c2") == 1


def test_si_units(capsys):
    said, found = answer(capsys, PAPER)
    assert found["growth_rate"] == pytest.approx(2812, abs=0.5)
    assert "2812 1/s" in said[-1] and "rad/m, of wavelength 2 dx" in said[-1]
    said, found = answer(capsys, PAPER._replace(box=15))
    assert found["growth_rate"] == pytest.approx(2693, abs=0.5)
    assert "box of 15 particles along an edge" in said[0]


def test_sound_speed_is_ten_unless_given(capsys):
    given = [answer(capsys, Asked(kernel="cubic", state="tension", sound_speed=c)) for c in (10.0, 30.0)]
    usual = answer(capsys, Asked(kernel="cubic", state="tension"))
    assert usual == given[0] and usual[0][0] != given[1][0][0]
    assert "c = 10 √(|P|/ρ)" in usual[0][0]


def test_a_stable_lattice_says_so(capsys):
    said, found = answer(capsys, Asked(kernel="hyperbolic", smoothing=1.3, state="compression"))
    assert said[-1].strip() == "stable: nothing grows"
    assert found["stable"] is True and found["growth_rate"] == 0.0


@pytest.mark.parametrize("name", REMEDIES)
def test_every_remedy_can_be_asked_for(capsys, name):
    value = "=0.3" if REMEDIES[name]._fields else ""
    plain = Asked(kernel="cubic", smoothing=1.2, state="tension")
    said, found = answer(capsys, plain._replace(remedies=(name + value,)))
    assert name.replace("_", " ") in said[0]
    of_density = {"spreading", "meeting"} & set(dir(REMEDIES[name]))
    if not of_density:  # what grows is under tension, whatever sound does
        assert found["growth_rate"] != pytest.approx(answer(capsys, plain)[1]["growth_rate"])


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (Asked(kernel="cubic"), "give --state compression or tension, or --pressure"),
        (Asked(kernel="cubic", state="tension", spacing=1.0), "--spacing: needs --pressure"),
        (Asked(kernel="cubic", state="tension", smoothing=0.0), "--smoothing 0: give 0.6 to 4"),
        (PAPER._replace(density=None), "give --density too"),
        (PAPER._replace(density=-1.0), "--density -1: give a number above zero"),
        (PAPER._replace(sound_speed=float("nan")), "--sound-speed nan: give a number above zero"),
        (PAPER._replace(pressure=0.0), "--pressure 0: give a number other than zero"),
        (PAPER._replace(state="compression"), "that is not compression"),
        (PAPER._replace(box=50), "at most 38"),
        (PAPER._replace(remedies=("magic",)), "--with magic: not known; one of normalised_grad"),
        (PAPER._replace(remedies=("viscosity",)), "give viscosity=VALUE"),
        (PAPER._replace(remedies=("viscosity=-1",)), "takes a number, zero or above"),
        (PAPER._replace(remedies=("normalised_gradient=1",)), "takes no value"),
        (Asked(smoothing=1.2), "--smoothing: the map has all kernels"),
        (Asked(box=3), "--box: the map has all kernels"),
        (Asked(form="symmetric", remedies=("magic",)), "not known"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line(asked, says):
    with pytest.raises(StabilityError, match="^stability --.*$") as caught:
        stability(MPI.COMM_SELF, asked)
    assert says in str(caught.value)


@pytest.fixture(scope="module")
def square(tmp_path_factory):
    """The folder of the map of the square lattice."""
    folder = tmp_path_factory.mktemp("maps") / "square"
    stability(MPI.COMM_SELF, Asked(out=folder))
    return folder


def test_the_map_holds_every_growth(square):
    rows = list(csv.DictReader(open(square / "map.csv", encoding="utf-8")))
    assert len(rows) == len(KERNELS) * len(SMOOTHINGS) * len(STATES)
    for row in rows[7::61]:
        sign = STATES[row["state"]]
        found = growth(Settings(row["kernel"], float(row["smoothing"]), "square", sign))
        assert float(row["growth_rate"]) == pytest.approx(found.rate)
        assert (row["stable"] == "True") == found.stable
    held = [r["smoothing"] for r in rows if r["kernel"] == "hyperbolic" and r["stable"] == "True"]
    assert held == ["1.25", "1.3", "1.35"]


def test_the_map_in_words_and_as_a_picture(square):
    text = (square / "map.md").read_text(encoding="utf-8")
    assert "`hyperbolic` 1.25–1.35" in text and "Under tension nothing is stable" in text
    cells = [line.split("|") for line in text.splitlines() if line.startswith("| `")]
    assert len(cells) == 2 * len(KERNELS) and {len(row) for row in cells} == {len(cells[0])}
    assert (square / "map.png").read_bytes()[:4] == b"\x89PNG"
    assert (square / "map.png").stat().st_size > 20_000


def test_the_table_for_a_terminal(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(survey_module, "KERNELS", {"hyperbolic": None, "cubic": None})
    said, found = answer(capsys, Asked(out=tmp_path, sound_speed=3.0))
    assert "c = 3 √(|P|/ρ)" in said[1]
    assert "compression" in said[3] and len(said[3]) == len(said[2])
    assert "Under compression stable at h/dx: hyperbolic 1.25–1.35; cubic 1.2." in said
    assert len(found) == 2 * 2 * len(SMOOTHINGS) and found[0]["kernel"] == "hyperbolic"


def test_sentences_of_neutral_forms(monkeypatch):
    monkeypatch.setattr(survey_module, "KERNELS", {"cubic": None})
    rows = list(survey(Settings("cubic", 1.0, "row", 1.0, form="minimum")))
    assert list(sentences(rows)) == [
        "Under compression stable at h/dx: `cubic` 1–2.",
        "Under tension stable at h/dx: `cubic` 1–2.",
    ]


def test_a_folder_that_cannot_be(monkeypatch, tmp_path):
    monkeypatch.setattr(survey_module, "KERNELS", {"cubic": None})
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="choose another folder with --out"):
        stability(MPI.COMM_SELF, Asked(lattice="row", out=tmp_path / "file"))


def test_a_page_is_renewed(square, tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("# A\n<!-- map: begin -->\nold\n<!-- map: end -->\n<!-- measured: begin -->\n")
    (tmp_path / "images").mkdir()
    assert on_page([str(page), str(square)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "old" not in text and "measured: begin" in text
    assert "| kernel | square |" in text and "| `hyperbolic` | 1.25–1.35 |" in text
    assert "(images/stability_square.png)" in text
    assert (tmp_path / "images" / "stability_square.png").exists()
    assert on_page([str(page), str(tmp_path)]) == 2 and on_page([]) == 2
    assert "give the folder of a map" in capsys.readouterr().err


def test_the_elastic_table(tmp_path, capsys):
    """One command writes the page of docs/lagrangian.md, the same."""
    elastic(MPI.COMM_SELF, tmp_path)
    page = (tmp_path / PAGE).read_text(encoding="utf-8").strip()
    assert page in Path("docs/lagrangian.md").read_text(encoding="utf-8")
    assert "| total, no control | (0 1), (1 0), (1 1) |" in page and str(tmp_path) in capsys.readouterr().out
