"""The verb ``stability --battery``: run, measured, judged and said."""

from collections.abc import Callable, Iterator
from pathlib import Path

import psph
from psph.battery import picture, tables
from psph.battery.errors import BatteryError
from psph.battery.measures import measure
from psph.battery.trials import BATTERY, OURS, QUICK, Trial
from psph.battery.verdicts import Row, judged
from psph.case import CaseError, load
from psph.maps.tables import write
from psph.output.errors import OutputError
from psph.output.reader import Run
from psph.study.runs import perform

CASES = Path(psph.__file__).parents[1] / "run" / "cases" / "hard"
FOLDER = Path("battery")


def battery(
    comm, quick: bool, out: Path | None, trials: tuple[Trial, ...] | None = None
) -> list[Row]:
    """Run the battery, or the quick part of it, into ``out``; rows on rank 0, collective.

    Runs that are finished there already are not done again.  Raises BatteryError where the cases
    are not at hand.
    """
    chosen = trials if trials is not None else QUICK if quick else BATTERY
    folder = out or FOLDER
    if not CASES.is_dir():
        raise BatteryError(
            f"stability --battery: {CASES} is not there; run it from psph's own folder of sources"
        )

    def say(line: str) -> None:
        if comm.rank == 0:
            print(line, flush=True)

    rows = []
    for trial in chosen:
        for column in trial.columns:
            row = _run(comm, trial, column, folder, say)
            if comm.rank == 0:
                rows.append(row)
                say(tables.line(row))
    if comm.rank == 0:
        _write(folder, chosen, rows)
        say("")
        for line in (*tables.matrix(chosen, rows), "", *tables.sentences(rows)):
            say(line)
        say(f"wrote {folder}: {tables.CSV}, {tables.PAGE}, {picture.PICTURE}")
    return rows


def folder_of(folder: Path, trial: Trial, column: str) -> Path:
    """Where the files of a run are."""
    words = "".join(c if c.isalnum() or c in ".-" else " " for c in f"{trial.name} {column}")
    return folder / "-".join(words.split())


def _run(comm, trial: Trial, column: str, folder: Path, say: Callable[[str], None]) -> Row | None:
    """One run; its row on rank 0."""
    place = folder_of(folder, trial, column)
    try:
        case = load(CASES / f"{trial.case}.toml", trial.overrides(column))
    except CaseError as error:
        case = error
    result = perform(case, place, comm, 1, lambda line: None)
    if comm.rank != 0:
        return None
    if isinstance(case, CaseError) or not _has_frames(place):
        return judged(trial, column, result, {}, 0.0)
    reached = float(Run(place).log()["time"][-1])
    return judged(trial, column, result, measure(place, case, trial.speed), reached)


def _has_frames(place: Path) -> bool:
    try:
        return len(Run(place).times) > 0
    except OutputError:
        return False


def _write(folder: Path, trials: tuple[Trial, ...], rows: list[Row]) -> None:
    write(folder / tables.CSV, tables.as_csv(rows))
    write(folder / tables.PAGE, "\n".join(tables.markdown(trials, rows)) + "\n")
    picture.draw(folder / picture.PICTURE, trials, rows, snapshots(folder, trials))


SNAPSHOTS = ("patch", "dam_break", "drop", "strip", "jets", "taylor_green", "sloshing", "cavity")
"""Cases whose end under our scheme is drawn beside the table."""


def snapshots(folder: Path, trials: tuple[Trial, ...]) -> Iterator[tuple[str, dict]]:
    """Name and last frame of a run of each of these, under our scheme."""
    seen = set()
    for trial in trials:
        place = folder_of(folder, trial, OURS)
        if trial.case in SNAPSHOTS and trial.case not in seen and _has_frames(place):
            seen.add(trial.case)
            yield trial.name, Run(place).frame(-1, "position", "kind", "pressure")
