"""The battery's part of a page: ``python -m psph.lab.battery.page PAGE FOLDER``.

FOLDER holds a battery; what it tells in words comes between the markers of the page, its picture goes into
``images/`` beside it.  The tables stay in the folder.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from psph.lab.battery.picture import PICTURE
from psph.lab.battery.tables import DETAILS, PAGE
from psph.output.pages import command, picture, results

MARKER = "battery"


def part(page: Path, folders: Sequence[Path]) -> str:
    """What the page tells of the last battery: all but its tables.  OutputError: none there."""
    folder = folders[-1]
    with results(folder, "battery"):
        text = (folder / PAGE).read_text(encoding="utf-8")
        shown = picture(page, folder / PICTURE, "battery", "Verdicts of the battery")
    told = [line for line in text.partition(DETAILS)[0].splitlines() if not line.startswith("|")]
    return "\n".join([shown, "", *told]).rstrip() + "\n"


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.battery.page PAGE FOLDER", part, arguments, MARKER)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
