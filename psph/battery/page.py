"""The battery's part of a page: ``python -m psph.battery.page PAGE FOLDER``.

FOLDER holds a battery; its tables come between the markers of the page, its picture goes into
``images/`` beside it.
"""

import shutil
import sys
from pathlib import Path

from psph.battery.picture import PICTURE
from psph.battery.tables import DETAILS, PAGE
from psph.output.errors import OutputError
from psph.output.pages import renew

MARKER = "battery"


def part(page: Path, folder: Path) -> str:
    """What the page tells: all but the details.  OutputError: no battery there."""
    picture = page.parent / "images" / "battery.png"
    try:
        text = (folder / PAGE).read_text(encoding="utf-8")
        shutil.copyfile(folder / PICTURE, picture)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}; give the folder of a battery") from None
    told = text.partition(DETAILS)[0].rstrip()
    return f"{told}\n\n![Verdicts of the battery](images/{picture.name})\n"


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    if len(arguments) != 2:
        print("python -m psph.battery.page PAGE FOLDER", file=sys.stderr)
        return 2
    page, folder = map(Path, arguments)
    try:
        renew(page, part(page, folder), MARKER)
    except OutputError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
