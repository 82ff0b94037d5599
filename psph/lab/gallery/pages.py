"""The pages of the gallery: all cases with small pictures, and, on the site, one page for each case."""

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

*For whoever looks for a case to start from: a picture of each case of `run/cases/`.*

The head of each case file says what is simulated, where the case comes from, what to expect, and the command
that runs it. On the site each case has a page with its film. {drawn} of {all} cases have a picture; some show
a coarser or shorter run. `./run/gallery` draws all of them again, `./run/gallery dam_break` only one,
`./run/gallery --missing` those without a picture.
"""
ACROSS, ACROSS_WITHOUT_WORDS = 3, 5
"""Pictures beside each other, with sentences below them and without."""
TITLES = {"": "Flows", "hard": "Hard cases of the [battery](../stability.md#the-battery)"}
"""Headings for folders of cases; another has its name."""


def index(shown: list[Shown], *, site: bool = False) -> str:
    """All cases with pictures; each leads to its file, or on the site, with its sentence, to its page."""
    drawn = sum(one.still.exists() for one in shown)
    return "\n".join([HEAD.format(drawn=drawn, all=len(shown)), *_groups(shown, site)])


def _groups(shown: list[Shown], site: bool) -> Iterator[str]:
    for folder, group in groupby(shown, key=lambda s: s.path.parent.relative_to(CASES).as_posix()):
        title = TITLES.get(folder.removeprefix("."), folder.capitalize())
        yield f"## {title}\n"
        cells = [_small(one) + (_told(one) if site else _named(one, one.path)) for one in group]
        across = ACROSS if site else ACROSS_WITHOUT_WORDS
        yield f"{'| ' * across}|\n{'|---' * across}|"
        for k in range(0, len(cells), across):
            row = cells[k : k + across]
            yield f"| {' | '.join(row + [''] * (across - len(row)))} |"
        yield ""


def _told(one: Shown) -> str:
    return f"{_named(one, one.page)}: {_cell(one.sentence)}"


def _named(one: Shown, target: Path) -> str:
    return f"[{one.name.rpartition('/')[2]}]({_from(INDEX, target)})"


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
    """Write the committed page."""
    INDEX.parent.mkdir(parents=True, exist_ok=True)
    INDEX.write_text(index(shown), encoding="utf-8")


def write_all(shown: list[Shown], folder: Path) -> None:
    """Write the pages of the site below a folder: the list, and a page for each case."""
    texts = {one.page: page(one) for one in shown} | {INDEX: index(shown, site=True)}
    for path, text in texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
