"""What the default scheme costs beside plain SPH: what takes turns, the arithmetic, the page."""

import json

import pytest
from mpi4py import MPI

from psph.__main__ import main
from psph.errors import Refused
from psph.lab.bench import price_page
from psph.lab.bench.price import ALIKE, DEFAULT, USUAL, _price, price, words
from psph.lab.errors import BenchError


@pytest.fixture(scope="module")
def found():
    """A small fall in 2D."""
    return price(MPI.COMM_SELF, 2, 1500, 5)


def test_the_default_takes_turns_with_plain_sph_as_it_is_usually_run_and_with_as_many_neighbours(found):
    settings = found["settings"]
    assert [settings[n]["kernel"] for n in (DEFAULT, USUAL, ALIKE)] == 3 * ["wendland-c2"]
    assert [settings[n]["smoothing"] for n in (DEFAULT, USUAL, ALIKE)] == [1.4, 1.2, 1.4]
    assert [settings[n]["neighbours_in_bulk"] for n in (DEFAULT, USUAL, ALIKE)] == [24, 17, 24]
    assert 1000 < found["particles"] < 2000 and found["turns"] == 5
    steps = {name: one["steps"] for name, one in settings.items()}
    assert steps[USUAL] > 1.03 * steps[ALIKE]  # the step is limited by h/c, and the fall is as long
    assert set(found["price"]) == {USUAL, ALIKE}
    for one in found["price"].values():
        assert one["per_step"] > 0.0 and one["per_second_of_flow"] > 0.0 and one["spread"] > 0.0


def test_a_step_and_a_second_of_flow_are_told_apart():
    """The default takes 0.3 s for 20 steps, the other 0.4 s for 40 steps of half the length."""
    turns = [{DEFAULT: (0.3, 20), USUAL: (0.4, 40)}] * 10
    assert _price(turns, USUAL) == {
        "per_step": pytest.approx(1.5),
        "per_second_of_flow": pytest.approx(0.75),
        "spread": 0.0,
    }
    slow = [{DEFAULT: (0.6, 20), USUAL: (0.4, 40)}] * 2 + turns[2:]
    assert _price(slow, USUAL)["per_step"] == pytest.approx(1.5)
    assert _price(slow, USUAL)["spread"] == pytest.approx(1.0)


def test_words_and_page(found, tmp_path, capsys):
    said = "\n".join(words(found))
    told = found["price"][USUAL]
    assert f"{told['per_step']:.2f} times as long a step" in said and "wendland-c2 at h/dx 1.2, 17 " in said
    file, page = tmp_path / "price.json", tmp_path / "page.md"
    file.write_text("words\n" + json.dumps({"prices": [found]}) + "\n")
    page.write_text("<!-- price: begin -->\nold\n<!-- price: end -->\n")
    assert price_page.main([str(page), str(file)]) == 0
    rows = [line for line in page.read_text().splitlines() if line.startswith("| 2D")]
    assert len(rows) == 2 and f"| {told['per_second_of_flow']:.2f} |" in rows[0] and "old" not in rows
    file.write_text("{}")
    assert price_page.main([str(page), str(file)]) == 2
    assert "no prices; give a file" in capsys.readouterr().err


def test_the_command_line(monkeypatch, capsys):
    asked = []
    monkeypatch.setattr(
        "psph.lab.bench.price.price",
        lambda comm, *details: asked.append(details) or {"dimensions": details[0]},
    )
    monkeypatch.setattr("psph.lab.bench.price.words", lambda result: ["said"])
    assert main(["bench", "--price", "--json"]) == 0
    assert asked == [(2, None, None), (3, None, None)]
    assert json.loads(capsys.readouterr().out.splitlines()[-1]) == {
        "prices": [{"dimensions": 2}, {"dimensions": 3}]
    }
    assert main(["bench", "--price", "--dimensions", "3", "--particles", "9", "--turns", "7"]) == 0
    assert asked[2:] == [(3, 9, 7)]
    with pytest.raises(Refused, match="bench --price: has its own dam break; leave --against out"):
        main(["bench", "--price", "--against", "precision=mixed"])
    with pytest.raises(BenchError, match="bench --price --turns 2: give at least 5"):
        price(MPI.COMM_SELF, 2, 1500, 2)
