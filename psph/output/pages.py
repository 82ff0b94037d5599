"""Generated parts of pages of the documentation: the text between two markers."""

import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from psph.errors import Foreseen
from psph.output.errors import OutputError

MEASURED = "measured"


def markers(name: str = MEASURED) -> tuple[str, str]:
    """The lines around the part ``name`` of a page."""
    return f"<!-- {name}: begin -->", f"<!-- {name}: end -->"


BEGIN, END = markers()


def renew(page: Path, made: str, name: str = MEASURED) -> None:
    """Put a text between two markers of a page.  OutputError: it cannot be read, or has none."""
    first, last = markers(name)
    try:
        text = page.read_text(encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{page}: {error.strerror}; give a page with the two markers") from None
    before, begin, rest = text.partition(first)
    _, end, after = rest.partition(last)
    if not begin or not end:
        raise OutputError(f"{page}: no place for the results; add the lines {first} and {last}")
    page.write_text(f"{before}{first}\n{made}\n{last}{after}", encoding="utf-8")


@contextmanager
def results(folder: Path, kind: str) -> Iterator[None]:
    """Where a file is missing in the body: OutputError, ``folder`` shall be that of a ``kind``."""
    try:
        yield
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise OutputError(f"{folder}: {said}; give the folder of a {kind}") from None


def picture(page: Path, file: Path, name: str, caption: str) -> str:
    """Put a picture into ``images/`` beside the page; the line that shows it.  OSError: none there."""
    kept = page.parent / "images" / f"{name}{file.suffix}"
    shutil.copyfile(file, kept)
    return f"![{caption}](images/{kept.name})"


def command(
    usage: str,
    make: Callable[[Path, Sequence[Path]], str],
    arguments: Sequence[str],
    name: str = MEASURED,
) -> int:
    """``MODULE PAGE FOLDER...``: renew the part ``name`` of a page; the exit code.

    ``make`` writes it from the page's path and what follows.
    """
    if len(arguments) < 2:
        print(f"python -m {usage}", file=sys.stderr)
        return 2
    page, *sources = map(Path, arguments)
    try:
        renew(page, make(page, sources), name)
    except Foreseen as error:
        print(error, file=sys.stderr)
        return 2
    return 0
