"""The measured part of a page: ``python -m psph.study.page PAGE FOLDER...``.

Each FOLDER holds a study; its table, its sentences and its picture come between the markers of
the page, the pictures into ``images/`` beside it.
"""

import shutil
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from psph.output.errors import OutputError
from psph.output.pages import renew
from psph.study.study import PAGE, PICTURE


def studies(page: Path, folders: Iterable[Path]) -> str:
    """What the studies say, for a page; their pictures are copied.  OutputError: no study there."""
    return "\n".join(line for folder in folders for line in _one(page, folder))


def _one(page: Path, folder: Path) -> Iterator[str]:
    picture = page.parent / "images" / f"accuracy_{folder.name}.png"
    try:
        text = (folder / PAGE).read_text(encoding="utf-8").rstrip()
        if drawn := (folder / PICTURE).exists():
            shutil.copyfile(folder / PICTURE, picture)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}; give the folder of a study") from None
    title, _, rest = text.partition("\n")
    yield f"#{title.removesuffix(': what accuracy costs')}"
    yield rest.strip("\n")
    if drawn:
        yield ""
        yield f"![Error against seconds](images/{picture.name})"
    yield ""


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    if len(arguments) < 2:
        print("python -m psph.study.page PAGE FOLDER...", file=sys.stderr)
        return 2
    page, *folders = map(Path, arguments)
    try:
        renew(page, studies(page, folders))
    except OutputError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
