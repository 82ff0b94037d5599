"""The verbs ``stability --battery``, ``--remedies`` and ``--walls``."""

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from psph.case import CaseError, load
from psph.lab.battery import comparison, picture, tables
from psph.lab.battery.comparison import Comparison
from psph.lab.battery.measures import measure
from psph.lab.battery.trials import BATTERY, OURS, QUICK, Trial
from psph.lab.battery.verdicts import Row, judged
from psph.lab.errors import BatteryError
from psph.lab.maps.tables import write
from psph.lab.study.runs import perform
from psph.output.errors import NotThere
from psph.output.reader import Run

CASES = Path(__file__).parents[3] / "run" / "cases" / "hard"
REMEDIES = CASES.parents[1] / "remedies"
"""Effects and kernels that stand beside the cases."""

FOLDER = Path("battery")


def battery(comm, quick: bool, out: Path | None, trials: tuple[Trial, ...] | None = None) -> list[Row]:
    """Run the battery, or the quick part of it, into ``out``; rows on rank 0, collective.

    Runs that are finished there already are not done again.  Raises BatteryError where the cases
    are not at hand.
    """
    chosen = trials if trials is not None else QUICK if quick else BATTERY
    folder = out or FOLDER
    rows = _performed(comm, chosen, folder)
    if comm.rank == 0:
        _write(folder, chosen, rows)
        _say("", *tables.matrix(chosen, rows), "", *tables.sentences(rows))
        _say(f"wrote {folder}: {tables.CSV}, {tables.PAGE}, {picture.PICTURE}")
    return rows


def compare(comm, of: Comparison, out: Path | None) -> list[Row]:
    """Run the trials of a comparison under each of its choices; rows on rank 0."""
    folder = out or Path(of.name)
    rows = _performed(comm, of.trials, folder)
    if comm.rank == 0:
        write(folder / of.csv, tables.as_csv(rows))
        write(folder / of.page, "\n".join(comparison.markdown(of, rows)) + "\n")
        _say("", *comparison.matrix(of, rows))
        _say(f"wrote {folder}: {of.csv}, {of.page}")
    return rows


def _performed(comm, trials: Sequence[Trial], folder: Path) -> list[Row]:
    """Every run of every trial, said as it ends; rows on rank 0."""
    if not CASES.is_dir():
        raise BatteryError(f"stability: {CASES} is not there; run it from psph's own folder of sources")
    rows = []
    for trial in trials:
        for column in trial.columns:
            row = _run(comm, trial, column, folder)
            if comm.rank == 0:
                rows.append(row)
                _say(tables.line(row))
    return rows


def _say(*lines: str) -> None:
    """Lines at once; for rank 0."""
    for line in lines:
        print(line, flush=True)


def folder_of(folder: Path, trial: Trial, column: str) -> Path:
    """Where the files of a run are."""
    words = "".join(c if c.isalnum() or c in ".-" else " " for c in f"{trial.name} {column}")
    return folder / "-".join(words.split())


def _run(comm, trial: Trial, column: str, folder: Path) -> Row | None:
    """One run; its row on rank 0."""
    place = folder_of(folder, trial, column)
    try:
        case = load(file_of(comm, trial, column, folder), trial.overrides(column))
    except CaseError as error:
        case = error
    result = perform(case, place, comm, 1, lambda line: None)
    if comm.rank != 0:
        return None
    if isinstance(case, CaseError) or not _has_frames(place):
        return judged(trial, column, result, {}, 0.0)
    reached = float(Run(place).log()["time"][-1])
    return judged(trial, column, result, measure(place, case, trial.speed), reached)


def file_of(comm, trial: Trial, column: str, folder: Path) -> Path:
    """The file of a trial's case: where it uses a remedy, a copy beside copies of all.  Collective."""
    file = CASES / f"{trial.case}.toml"
    if not any(key.startswith("use=") for key in trial.changes[column]):
        return file
    beside = folder / "cases"
    if comm.rank == 0:
        beside.mkdir(parents=True, exist_ok=True)
        for one in (file, *REMEDIES.glob("*.py")):
            shutil.copy(one, beside)
    comm.Barrier()
    return beside / file.name


def _has_frames(place: Path) -> bool:
    try:
        return len(Run(place).times) > 0
    except NotThere:
        return False


def _write(folder: Path, trials: tuple[Trial, ...], rows: list[Row]) -> None:
    write(folder / tables.CSV, tables.as_csv(rows))
    write(folder / tables.PAGE, "\n".join(tables.markdown(trials, rows)) + "\n")
    picture.draw(folder / picture.PICTURE, trials, rows, snapshots(folder, trials))


SNAPSHOTS = ("patch", "dam_break", "drop", "strip", "jets", "taylor_green", "sloshing", "cavity")
"""Cases whose end under the default scheme is drawn beside the table."""


def snapshots(folder: Path, trials: tuple[Trial, ...]) -> Iterator[tuple[str, dict]]:
    """Name and last frame of a run of each of these, under the default scheme."""
    seen = set()
    for trial in trials:
        place = folder_of(folder, trial, OURS)
        if trial.case in SNAPSHOTS and trial.case not in seen and _has_frames(place):
            seen.add(trial.case)
            yield trial.name, Run(place).frame(-1, "position", "kind", "pressure")
