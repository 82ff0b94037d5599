"""The measured part of a page: ``python -m psph.study.page PAGE FOLDER...``.

Each FOLDER holds a study; its table, its sentences and its picture come between the markers of
the page, the pictures into ``images/`` beside it.  Of studies of the profiles one table is made.
"""

import json
import shutil
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from psph.case.profiles import PROFILES
from psph.output.errors import OutputError
from psph.output.pages import renew
from psph.study.ladder import PROFILE, SPACING, toml
from psph.study.report import percent, seconds
from psph.study.runs import DONE
from psph.study.study import KEPT, PAGE, PICTURE


def studies(page: Path, folders: Iterable[Path]) -> str:
    """What the studies say, for a page; their pictures are copied.  OutputError: no study there."""
    found = [(folder, _kept(folder)) for folder in folders]
    lines = [line for folder, kept in found if PROFILE not in kept["vary"] for line in _one(page, folder)]
    of_profiles = [kept for _, kept in found if PROFILE in kept["vary"]]
    return "\n".join([*lines, *(_profiles(of_profiles) if of_profiles else ())])


def _kept(folder: Path) -> dict:
    try:
        return json.loads((folder / KEPT).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise OutputError(f"{folder}: {error}; give the folder of a study") from None


def _profiles(every: list[dict]) -> Iterator[str]:
    """A line for each case and spacing: error and seconds of each profile."""
    yield "## The price of profiles"
    yield ""
    yield f"| case | error of | spacing | {' | '.join(PROFILES)} |"
    yield "|---" * (3 + len(PROFILES)) + "|"
    for kept in every:
        rows = {(row.get(SPACING), row[PROFILE]): row for row in kept["rows"] if PROFILE in row}
        what = kept["error"].partition(" ")[0]
        for spacing in sorted({dx for dx, _ in rows if dx}, reverse=True):
            cells = (_cell(rows.get((spacing, name))) for name in PROFILES)
            yield f"| {Path(kept['case']).stem} | {what} | {toml(spacing)} | {' | '.join(cells)} |"
    yield ""


def _cell(row: dict | None) -> str:
    """``0.25 % in 4.2 s``, or how the run ended."""
    if row is None or row["status"] != DONE:
        return row["status"].partition(":")[0] if row else "–"
    return f"{percent(row['error_l2'])} in {seconds(row['seconds'])}"


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
