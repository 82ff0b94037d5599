"""The maps of a page: ``python -m psph.maps.page PAGE FOLDER...``.

Each FOLDER holds a map; its table, its sentences and its picture come between the markers of the
page, the pictures into ``images/`` beside it.
"""

import shutil
import sys
from pathlib import Path

from psph.maps.tables import PAGE, PICTURE
from psph.output.errors import OutputError
from psph.output.pages import renew

MARKER = "map"


def maps(page: Path, folders: list[Path]) -> str:
    """What the maps say; their pictures are copied.  OutputError: no map there."""
    parts = []
    for folder in folders:
        picture = page.parent / "images" / f"stability_{folder.name}.png"
        try:
            text = (folder / PAGE).read_text(encoding="utf-8")
            shutil.copyfile(folder / PICTURE, picture)
        except OSError as error:
            raise OutputError(f"{folder}: {error.strerror}; give the folder of a map") from None
        parts.append(f"{text}\n![Growth by kernel and h/dx](images/{picture.name})\n")
    return "\n".join(parts)


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    if len(arguments) < 2:
        print("python -m psph.maps.page PAGE FOLDER...", file=sys.stderr)
        return 2
    page, *folders = map(Path, arguments)
    try:
        renew(page, maps(page, folders), MARKER)
    except OutputError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
