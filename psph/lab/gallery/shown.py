"""A case as the gallery shows it: what its head says, and how it is run and drawn."""

import re
import shlex
from pathlib import Path
from typing import NamedTuple

from psph.case import Case, load
from psph.errors import Refused

CASES = Path("run/cases")
PAGES = Path("docs/gallery")
FRAMES = 24
"""Pictures of a film."""
WORDS = ("Source", "Expect", "Particles")
"""What the head of a case says under a name, in the order of its page."""
PICTURE = "Picture"
"""What the head says of its picture: options of ``plot``, and ``--set KEY=VALUE`` for its run."""
COLOURED = ("--field", "speed")
"""The options of a case without that line."""


class Shown(NamedTuple):
    """A case file and its head."""

    path: Path
    text: str
    sentence: str
    """The first of the head: what is simulated."""
    said: dict[str, str]
    """What the head says, by its words."""

    @property
    def name(self) -> str:
        """``mud/bingham_slump``, as below the folder of the cases."""
        return self.path.relative_to(CASES).with_suffix("").as_posix()

    @property
    def page(self) -> Path:
        """The file of its page."""
        return PAGES / f"{self.name}.md"

    @property
    def still(self) -> Path:
        """The file of its picture."""
        return PAGES / "images" / f"{self.name.replace('/', '-')}.webp"

    @property
    def film(self) -> Path:
        """The file of its film."""
        return PAGES / "images" / f"{self.name.replace('/', '-')}-film.webp"

    @property
    def folder(self) -> Path:
        """Where its run stands."""
        return Path("results/gallery") / self.name

    @property
    def overrides(self) -> list[str]:
        """The keys that its run for the gallery changes, such as ``time.end=1.0``."""
        words = self._words()
        return [value for word, value in zip(words, words[1:]) if word == "--set"]

    def case(self) -> Case:
        """The case with these changes."""
        return load(self.path, self.overrides)

    def run(self) -> list[str]:
        """The command of its run, without the frames that a film needs."""
        sets = [word for override in self.overrides for word in ("--set", override)]
        return ["python", "-m", "psph", str(self.path), *sets, "--out", str(self.folder)]

    def plot(self, film: Path | None = None) -> list[str]:
        """The command of its picture, or of its film."""
        options = _without("--set", self._words())
        if film is not None:
            options = [*_without("--times", options), "--film", str(film)]
        return ["python", "-m", "psph", "plot", str(self.folder), *options]

    def _words(self) -> list[str]:
        return shlex.split(self.said.get(PICTURE, "")) or list(COLOURED)


def _without(option: str, words: list[str]) -> list[str]:
    """The words without an option and its one value."""
    return [word for word, before in zip(words, [None, *words]) if word != option and before != option]


def read(path: Path) -> Shown:
    """A case file with its head.  Raises Refused where the head does not say what every head says."""
    text = path.read_text(encoding="utf-8")
    head = re.match(r"(?:#.*\n)+", text)
    lines = [line.removeprefix("#").strip() for line in head[0].splitlines()] if head else []
    sentence, said, word = "", {}, ""
    for line in lines:
        named = re.match(r"([A-Z][a-z]+(?: time)?): +(.*)", line)
        if named:
            word = named[1]
            said[word] = named[2]
        elif word:
            said[word] = f"{said[word]} {line}".strip()
        else:
            sentence = f"{sentence} {line}".strip()
    missing = [word for word in (*WORDS, "Command") if word not in said]
    if not sentence or missing:
        raise Refused(
            f"{path}: its head lacks {', '.join(missing) or 'a first sentence'}; "
            "docs/recipes/case.md shows a whole one"
        )
    return Shown(path, text, sentence, said)


def every() -> list[Shown]:
    """All shipped cases: by folder, and there by name."""
    return [read(path) for path in sorted(CASES.rglob("*.toml"), key=lambda p: (len(p.parts), p.parts))]
