"""The gallery: each shipped case is in it, as its file says; pictures are small and of cases."""

import shlex
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from psph.__main__ import VERBS, _with_verb
from psph.case import load
from psph.errors import Refused
from psph.lab.gallery import drawing, pages
from psph.lab.gallery.__main__ import chosen, main
from psph.lab.gallery.shown import PAGES, every, read
from psph.options import parser

ROOT = Path(__file__).parents[3]
RENEW = "run ./run/gallery --pages"
CASE = """\
# A drop that
# falls.
#
# Source:   none; *own*
# Expect:   It falls | and
#           stays.
# Particles: 4
# Picture:  --field pressure --times 0.5 --set time.end=0.7 --set space.spacing=0.02
# Command:  mpirun -n 2 python -m psph run/cases/drop.toml

space = { dimensions = 2, spacing = 0.01 }
time.end = 1.0
fluids.drop.shape.disc = { center = [0.0, 0.0], radius = 0.1 }
"""


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    monkeypatch.chdir(ROOT)


def test_every_case_is_in_the_gallery():
    shown = every()
    assert len(shown) == len(list(Path("run/cases").rglob("*.toml"))) > 50
    assert pages.INDEX.read_text(encoding="utf-8") == pages.index(shown), RENEW
    listed, whole = pages.index(shown), pages.index(shown, site=True)
    for one in shown:
        assert f"/{one.name}.toml)" in listed and f"]({one.name}.md): {one.sentence[:9]}" in whole
        assert one.said["Command"] in pages.page(one)


def test_the_commands_of_each_case_are_accepted():
    for one in every():
        for words in (shlex.split(one.said["Command"]), one.run(), one.plot(), one.plot(Path("f.gif"))):
            after = words[words.index("psph") + 1 :]
            options = parser(VERBS).parse_args(_with_verb(after))
            assert not hasattr(options, "case") or load(options.case, options.set).time.end > 0.0


def test_pictures_are_those_of_cases_and_small():
    images = set((PAGES / "images").iterdir())
    assert images <= {path for one in every() for path in (one.still, one.film)}
    assert sum(path.stat().st_size for path in images) < 10_000_000


def test_the_keys_that_a_picture_changes_are_keys():
    """Also those of cases that are not drawn yet."""
    changed = [one for one in every() if one.overrides]
    assert len(changed) > 10 and all(one.case().time.end > 0.0 for one in changed)


@pytest.fixture
def drop(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = Path("run/cases/mud/drop.toml")
    path.parent.mkdir(parents=True)
    path.write_text(CASE, encoding="utf-8")
    return path


def test_a_head_is_read(drop):
    one = read(drop)
    assert (one.name, one.sentence) == ("mud/drop", "A drop that falls.")
    assert one.said["Expect"] == "It falls | and stays."
    assert one.overrides == ["time.end=0.7", "space.spacing=0.02"] and one.case().time.end == 0.7
    assert one.run()[3:6] == [str(drop), "--set", "time.end=0.7"]
    assert one.plot()[5:] == ["--field", "pressure", "--times", "0.5"]
    assert one.plot(Path("f.gif"))[5:] == ["--field", "pressure", "--film", "f.gif"]


def test_a_page_says_whether_it_has_a_picture(drop):
    one = read(drop)
    page = pages.page(one)
    assert "no picture yet: `./run/gallery mud/drop`" in page and "![" not in page
    assert r"\*own\*" in page and r"It falls \| and stays." in page
    assert page.count("space = {") == 1 and "# Expect" not in page
    one.film.parent.mkdir(parents=True)
    one.film.touch()
    page = pages.page(one)
    assert "](../images/mud-drop-film.webp)" in page and "no picture" not in page
    assert "of fewer particles, or shorter" in page
    pages.write([one])
    assert "0 of 1 cases have a picture" in pages.INDEX.read_text(encoding="utf-8")


def test_a_head_that_lacks_something_is_refused(drop):
    drop.write_text(CASE.replace("# Source", "# Sauce"), encoding="utf-8")
    with pytest.raises(Refused, match=r"drop.toml: its head lacks Source; docs/\S+ shows a whole one"):
        read(drop)
    assert main([]) == 2


def test_cases_are_chosen_by_name_or_where_they_lack_a_picture(drop):
    one = read(drop)
    assert chosen([one], []) == chosen([one], ["mud/drop"]) == chosen([one], ["--missing"]) == [one]
    assert chosen([one], ["--pages"]) == []
    with pytest.raises(Refused, match="gallery drip: no such case"):
        chosen([one], ["drip"])


def noise(path, frames, shape):
    rng = np.random.default_rng(1)
    images = [Image.fromarray(rng.integers(0, 255, (*shape, 3), np.uint8)) for _ in range(frames)]
    images[0].save(path, save_all=True, append_images=images[1:], duration=100)


@pytest.mark.parametrize(("frames", "height", "kept"), [(2, 60, 2), (12, 400, 4)])
def test_films_of_disorder_become_small(tmp_path, frames, height, kept):
    noise(tmp_path / "a.gif", frames, (height, 500))
    drawing._keep_film(tmp_path / "a.gif", tmp_path / "a.webp")
    with Image.open(tmp_path / "a.webp") as film:
        assert film.n_frames == kept
        assert film.width == (480 if frames == kept else 240)


def test_a_command_that_fails_is_told(drop):
    with pytest.raises(Refused, match="nothere.toml.*failed: .*nothere.toml"):
        drawing._done(["python", "-m", "psph", "check", "nothere.toml"])
