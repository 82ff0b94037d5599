"""The verb ``measure``."""

from collections.abc import Callable, Sequence
from pathlib import Path

from psph.lab.measure.fields import USUAL, Gridding
from psph.lab.measure.gauging import readings
from psph.lab.measure.profile import Profile
from psph.output.errors import OutputError, cause
from psph.output.numbers import extents, in_lines, numbers_in_lines
from psph.output.pictures.flat import slice_of
from psph.output.pictures.names import GRID
from psph.output.reader import Run
from psph.output.tables import MEASURED, CsvTable
from psph.parallel.reductions import alone


def grid(options) -> Path:
    """Write the fields that the ``options`` of the verb ask for; the file to be opened.  Raises what
    :class:`psph.lab.measure.fields.Gridding` does, and OutputError."""
    cut = slice_of(options.plane, "measure --plane") if options.plane else None
    asked = (options.step, cut, options.lower, options.upper, options.fields or USUAL, options.of)
    target = options.out or options.folder / GRID
    try:
        return Gridding(options.folder, *asked).written(target, options.times)
    except OSError as error:
        raise OutputError(f"{target}: cannot be written: {cause(error)}") from None


def profile(options) -> Path:
    """Write the profile that the ``options`` of the verb ask for; its table.  Raises what
    :class:`psph.lab.measure.profile.Profile` does, and OutputError."""
    asked = (options.profile, options.step, options.fields or USUAL, options.of)
    target = options.out or options.folder
    try:
        return Profile(options.folder, *asked).written(target, options.times)
    except OSError as error:
        raise OutputError(f"{target}: cannot be written: {cause(error)}") from None


def measure(
    folder: Path,
    gauges: Sequence[str],
    numbers: Sequence[str],
    times: Sequence[float] | None,
    out: Path | None,
    say: Callable[[str], None],
) -> None:
    """Write ``measured-NAME.csv`` for each gauge into ``out``, or the folder of the run, and say mean,
    extremes and numbers, those of the case where none are given; by one rank.

    ``gauges``, ``numbers`` and ``times`` are those of :func:`psph.lab.measure.gauging.readings`, which says
    what is raised, and OutputError.
    """
    found = readings(folder, gauges, times, numbers)
    target, run, case = folder if out is None else out, Run(folder), found.case
    target.mkdir(parents=True, exist_ok=True)
    for name, columns in found.tables.items():
        path = target / MEASURED.format(name)
        table = CsvTable(path, list(columns), alone())
        for row in zip(*columns.values()):
            table.write(map(float, row))
        table.close()
        say(f"wrote {path}: {len(columns['time'])} rows")
    for line in in_lines(extents(found.tables.values(), case.space.dimensions)):
        say(line)
    # What the run has written has more rows than there are frames; a new gauge of the same name is another.
    own = {name: table for name, table in run.gauges().items() if name not in found.new}
    tables = [
        *(found.tables[name] for name in found.new),
        run.probes(),
        *own.values(),
        *found.tables.values(),
    ]
    asked = {text.partition("=")[0].strip() for text in numbers} or set(case.numbers)
    told = {name: one for name, one in case.numbers.items() if name in asked}
    for line in (*found.refused, *numbers_in_lines(told, tables, case.space.dimensions)):
        say(line)
