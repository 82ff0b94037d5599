"""The pages of the gallery: a list with small pictures, and one page for each case."""

import os
import shlex
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from psph.lab.gallery.shown import CASES, FRAMES, PAGES, WORDS, Shown

INDEX = PAGES / "index.md"
HEAD = """\
# Gallery

<!-- Written by `./run/gallery --pages`; change the heads of the cases instead. -->

*For whoever looks for a case to start from: a picture of each case of `run/cases/`, its text, and the command
that runs it.*

{drawn} of {all} cases have a picture{films}. A picture comes from the case as it stands, or from a coarser or
shorter run: the page of the case has the commands. `./run/gallery` draws all of them again, `./run/gallery
dam_break` one, `./run/gallery --missing` those without a picture.
"""
ACROSS = 3
"""Pictures beside each other."""
TITLES = {"": "Flows", "hard": "Hard cases of the [battery](../stability.md#the-battery)"}
"""Headings for folders of cases; another has its name."""


def index(shown: list[Shown]) -> str:
    """The list of all cases."""
    drawn, films = (
        sum(path.exists() for path in paths) for paths in zip(*((s.still, s.film) for s in shown))
    )
    said = f", {films} of them a film" if films else ""
    return "\n".join([HEAD.format(drawn=drawn, all=len(shown), films=said), *_groups(shown)])


def _groups(shown: list[Shown]) -> Iterator[str]:
    for folder, group in groupby(shown, key=lambda s: s.path.parent.relative_to(CASES).as_posix()):
        title = TITLES.get(folder.removeprefix("."), folder.capitalize())
        yield f"## {title}\n"
        cells = [
            f"{_small(s)}[{s.name.rpartition('/')[2]}]({_from(INDEX, s.page)}): {_cell(s.sentence)}"
            for s in group
        ]
        yield "| | | |\n|---|---|---|"
        for k in range(0, len(cells), ACROSS):
            row = cells[k : k + ACROSS]
            yield f"| {' | '.join(row + [''] * (ACROSS - len(row)))} |"
        yield ""


def _small(one: Shown) -> str:
    return f"![{one.name}]({_from(INDEX, one.still)})<br>" if one.still.exists() else ""


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def page(one: Shown) -> str:
    """The page of a case."""
    return "\n".join(_page(one))


def _page(one: Shown) -> Iterator[str]:
    yield f"# {one.case().title or one.name.rpartition('/')[2]}\n"
    yield f"*{one.sentence}*\n"
    shown = one.film if one.film.exists() else one.still
    if shown.exists():
        yield f"![{_alternative(one)}]({_from(one.page, shown)})\n"
    else:
        yield f"This case has no picture yet: `./run/gallery {one.name}` draws it.\n"
    for word in WORDS:
        yield f"- **{word}:** {_plain(one.said[word])}"
    if "Run time" in one.said:
        yield f"- **Run time:** {one.said['Run time']}"
    yield f"\nThe case: [{one.path}]({_from(one.page, one.path)}). Run it with\n"
    yield f"```sh\n{one.said['Command']}\n```\n"
    if shown.exists():
        changed = " of fewer particles, or shorter," if one.overrides else ""
        yield f"The picture shows a run{changed} made by `./run/gallery {one.name}`, that is by\n"
        yield f"```sh\n{shlex.join(one.run())}\n{shlex.join(one.plot())}\n```\n"
        yield f"with {FRAMES} frames over the run.\n"
    yield f"## The case file\n\n```toml\n{_body(one.text)}```"
    yield ""


def _body(text: str) -> str:
    """The case without its head."""
    return text.partition("\n\n")[2]


def _plain(text: str) -> str:
    """A text of a head as Markdown: its signs are signs."""
    return "".join(f"\\{sign}" if sign in "*_<[|" else sign for sign in text) if "`" not in text else text


def _alternative(one: Shown) -> str:
    return f"{one.name}: {one.sentence}".replace("[", "(").replace("]", ")")


def _from(page: Path, target: Path) -> str:
    return Path(os.path.relpath(target, page.parent)).as_posix()


def write(shown: list[Shown]) -> None:
    """Write the list and all pages; pages of cases that are no more go."""
    pages = {one.page: page(one) for one in shown}
    pages[INDEX] = index(shown)
    for old in set(PAGES.rglob("*.md")) - set(pages):
        old.unlink()
    for path, text in pages.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
