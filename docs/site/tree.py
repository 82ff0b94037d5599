"""The source of the site: ``python docs/site/tree.py FOLDER``, from the root of psph.

The folder gets the committed pages, and what is generated: every key of a case at the end of docs/case.md,
the tables of docs/acts.md, and a page of the gallery for each shipped case.
"""

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from psph.case import acts, reference
from psph.lab.gallery import pages
from psph.lab.gallery.shown import every

GENERATED: dict[str, Callable[[], str]] = {"docs/case.md": reference.reference, "docs/acts.md": acts.page}
"""What follows the text of a committed page."""
IMAGES = (Path("docs/images"), Path("docs/gallery/images"))
"""Folders of pictures."""
WHOLE = ("README.md", "CHANGELOG.md")
"""Pages beside docs."""


def make(folder: Path) -> None:
    """Write all pages into a folder; what was there goes."""
    shutil.rmtree(folder, ignore_errors=True)
    for page in map(Path, (*WHOLE, *sorted(map(str, Path("docs").rglob("*.md"))))):
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(page, folder / page)
    for name, text in GENERATED.items():
        with (folder / name).open("a", encoding="utf-8") as file:
            file.write(f"\n{text()}")
    pages.write_all(every(), folder)
    _link(folder)


def _link(folder: Path) -> None:
    """What pages show or lead to stays where it is."""
    for path in (*IMAGES, *(p for p in map(Path, os.listdir()) if _is_source(p))):
        (folder / path).symlink_to(path.resolve())


def _is_source(path: Path) -> bool:
    return path.name not in ("docs", "build", "dist", "results", *WHOLE) and not path.name.startswith(".")


if __name__ == "__main__":
    make(Path(sys.argv[1]))
