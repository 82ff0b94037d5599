"""The measured part of a page: ``python -m psph.lab.study.page PAGE FOLDER...``.

Each FOLDER holds a study.  Between the markers of the page come a row for each series of spacings, what the
profiles cost, and the pictures, which go into ``images/`` beside the page.
"""

import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from psph.case.profiles import OFF, PROFILES
from psph.lab.study.conclusions import ladders_of
from psph.lab.study.fit import Ladder
from psph.lab.study.ladder import PROFILE, SPACING, toml
from psph.lab.study.report import percent, seconds
from psph.lab.study.runs import DONE
from psph.lab.study.study import KEPT, PICTURE
from psph.lab.study.words import within
from psph.output.pages import command, picture, results


def studies(page: Path, folders: Sequence[Path]) -> str:
    """The results of the studies, for a page; their pictures are copied.  OutputError: no study there."""
    found = [(folder, _kept(folder)) for folder in folders]
    alone = [(folder, kept) for folder, kept in found if PROFILE not in kept["vary"]]
    of_profiles = [kept for _, kept in found if PROFILE in kept["vary"]]
    parts = [
        _series(alone),
        _profiles(of_profiles),
        _pictures(page, [folder for folder, _ in alone]),
    ]
    return "\n".join(line for part in parts for line in part)


def _kept(folder: Path) -> dict:
    with results(folder, "study"):
        return json.loads((folder / KEPT).read_text(encoding="utf-8"))


def _series(found: list[tuple[Path, dict]]) -> Iterator[str]:
    """A row for each series of spacings: its errors, and what the finest run costs."""
    if not found:
        return
    yield "## Error and seconds"
    yield ""
    yield "| study | error of | spacing | L2 error | finest run | order |"
    yield "|---" * 6 + "|"
    for folder, kept in found:
        what = kept["error"].partition(" ")[0]
        for shared, rows, ladder in ladders_of(kept["rows"], kept["vary"], kept["dimensions"]):
            name = ", ".join([folder.name, *map(str, shared.values())])
            places = ", ".join(toml(row[SPACING]) for row in rows if SPACING in row)
            errors = ", ".join(_error(row) for row in rows)
            cells = name, what, places, errors, _finest(rows[-1]), _order(ladder)
            yield f"| {' | '.join(cells)} |"
    yield ""


def _error(row: dict) -> str:
    return percent(row["error_l2"]) if row["status"] == DONE else "stopped"


def _finest(row: dict) -> str:
    return seconds(row["seconds"]) if row["status"] == DONE else "–"


def _order(ladder: Ladder | None) -> str:
    if ladder is None:
        return "–"
    return f"{ladder.order.value:.2f}{within(ladder.order, '.2f')}" if ladder.steady else "not steady"


def _profiles(every: list[dict]) -> Iterator[str]:
    """A line for each case and spacing: error and seconds of each profile."""
    if not every:
        return
    yield "## The cost of profiles"
    yield ""
    yield f"| case | error of | spacing | default scheme | {' | '.join(PROFILES)} |"
    yield "|---" * (4 + len(PROFILES)) + "|"
    for kept in every:
        rows = {(row.get(SPACING), row.get(PROFILE, OFF)): row for row in kept["rows"]}
        what = kept["error"].partition(" ")[0]
        for spacing in sorted({dx for dx, _ in rows if dx}, reverse=True):
            cells = (_cell(rows.get((spacing, name))) for name in (OFF, *PROFILES))
            yield f"| {Path(kept['case']).stem} | {what} | {toml(spacing)} | {' | '.join(cells)} |"
    yield ""


def _cell(row: dict | None) -> str:
    """``0.25 % in 4.2 s``, or how the run ended."""
    if row is None or row["status"] != DONE:
        return row["status"].partition(":")[0] if row else "–"
    return f"{percent(row['error_l2'])} in {seconds(row['seconds'])}"


def _pictures(page: Path, folders: Iterable[Path]) -> Iterator[str]:
    for folder in folders:
        if (folder / PICTURE).exists():
            yield picture(page, folder / PICTURE, f"accuracy_{folder.name}", f"{folder.name}: error, seconds")
            yield ""


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.study.page PAGE FOLDER...", studies, arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
