"""The measured part of a page: ``python -m psph.lab.study.page PAGE FOLDER...``.

Each FOLDER holds a study; its table, its sentences and its picture come between the markers of
the page, the pictures into ``images/`` beside it.  Two tables join the studies: what ladders
predict for their finest run, and what the profiles cost.
"""

import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from psph.case.profiles import OFF, PROFILES
from psph.lab.study.ladder import PROFILE, SPACING, toml
from psph.lab.study.report import percent, seconds
from psph.lab.study.runs import DONE
from psph.lab.study.study import KEPT, PAGE, PICTURE, ladders_of
from psph.output.pages import command, picture, results


def studies(page: Path, folders: Iterable[Path]) -> str:
    """The results of the studies, for a page; their pictures are copied.  OutputError: no study there."""
    found = [(folder, _kept(folder)) for folder in folders]
    alone = [(folder, kept) for folder, kept in found if PROFILE not in kept["vary"]]
    of_profiles = [kept for _, kept in found if PROFILE in kept["vary"]]
    lines = [line for folder, _ in alone for line in _one(page, folder)]
    return "\n".join([*lines, *_predictions(alone), *(_profiles(of_profiles) if of_profiles else ())])


def _kept(folder: Path) -> dict:
    with results(folder, "study"):
        return json.loads((folder / KEPT).read_text(encoding="utf-8"))


def _predictions(found: list[tuple[Path, dict]]) -> Iterator[str]:
    """A line for each ladder whose coarser runs predict its finest, and the head of the table."""
    lines = [
        (folder.name, ladder.prediction)
        for folder, kept in found
        for shared, _, ladder in ladders_of(kept["rows"], kept["vary"], kept["dimensions"])
        if ladder and ladder.prediction and not shared
    ]
    if not lines:
        return
    yield "## Prediction of the finest run by the others"
    yield ""
    yield "| case | spacing | error predicted | measured | seconds predicted | measured |"
    yield "|---" * 6 + "|"
    for name, (run, error, took) in lines:
        yield (
            f"| {name} | {toml(run.spacing)} | {percent(error.value)} | {percent(run.error)} | "
            f"{took.value:.3g} | {run.seconds:.3g} |"
        )
    yield ""


def _profiles(every: list[dict]) -> Iterator[str]:
    """A line for each case and spacing: error and seconds of each profile."""
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


def _one(page: Path, folder: Path) -> Iterator[str]:
    shown = folder / PICTURE
    with results(folder, "study"):
        text = (folder / PAGE).read_text(encoding="utf-8").rstrip()
    title, _, rest = text.partition("\n")
    yield f"#{title.removesuffix(': what accuracy costs')}"
    yield rest.strip("\n")
    if shown.exists():
        yield ""
        yield picture(page, shown, f"accuracy_{folder.name}", "Error against seconds")
    yield ""


def main(arguments: list[str]) -> int:
    """Renew a page; the exit code."""
    return command("psph.lab.study.page PAGE FOLDER...", studies, arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
