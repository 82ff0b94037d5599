"""The verb ``study``."""

from pathlib import Path

from psph.case import load
from psph.errors import Failed
from psph.lab.errors import StudyError
from psph.lab.study.effects import effects_words, without_each
from psph.lab.study.ladder import rows, wanted
from psph.lab.study.runs import DONE, Make
from psph.lab.study.study import StudyRuns


def study(
    comm,
    file,
    sets: list[str],
    vary: list[str],
    grid: bool,
    effects: bool,
    out: Path | None,
    error: float | None,
    seconds: float | None,
    files: Path | None = None,
    quiet: bool = False,
    make: Make = load,
) -> None:
    """Run the study and print its results, unless it is to be ``quiet``; collective.

    ``make`` loads the case, where that is not in a file.  Raises CaseError or StudyError before the first
    run.
    """
    for name, value in (("error", error), ("seconds", seconds)):
        if value is not None and not value > 0.0:
            raise StudyError(f"study --{name} {value:g}: give a number above zero")
    if error is not None and error >= 1.0:
        raise StudyError(f"study --error {error:g}: a relative error below 1; for 3 % give 0.03")
    case = make(file, sets)
    if effects:
        named = without_each(case)
        if not named:
            raise StudyError(f"{file}: study --effects: the case has no effect that can be switched off")
        every = [{}, *named.values()]
    else:
        every = rows(wanted(case.study.vary, vary), grid or case.study.grid)
    folder = out or Path(f"{case.name}-study")
    asked = StudyRuns(file, sets, every, folder, comm, files, make)
    if not effects:
        asked.refuse_nonsense()

    def say(line: str) -> None:
        if comm.rank == 0 and not quiet:
            print(line, flush=True)

    found = asked.run(say)
    if comm.rank == 0:
        sentences = effects_words(asked.named(named, found)) if effects else asked.sentences(found)
        say("")
        for line in asked.conclude(found, list(sentences), error, seconds):
            say(line)
        say(f"wrote {folder}: {', '.join(p.name for p in sorted(folder.glob('study.*')))}")
    if not comm.bcast(any(row["status"] == DONE for row in found)):  # rank 0 alone has the rows
        raise Failed(f"{file}: study: no run has finished, see their status; {folder} tells more")
