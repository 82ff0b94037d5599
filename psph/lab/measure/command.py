"""The verb ``measure``."""

from collections.abc import Callable, Sequence
from pathlib import Path

from psph.lab.measure.gauging import readings
from psph.output.tables import MEASURED, CsvTable
from psph.parallel.reductions import alone


def measure(
    folder: Path,
    gauges: Sequence[str],
    times: Sequence[float] | None,
    out: Path | None,
    say: Callable[[str], None],
) -> None:
    """Write ``measured-NAME.csv`` for each gauge into ``out``, or the folder of the run; by one rank.

    ``gauges`` and ``times`` are those of :func:`psph.lab.measure.gauging.readings`, which says what is
    raised, and OutputError.
    """
    found = readings(folder, gauges, times)
    target = folder if out is None else out
    target.mkdir(parents=True, exist_ok=True)
    for line in found.refused:
        say(line)
    for name, columns in found.tables.items():
        path = target / MEASURED.format(name)
        table = CsvTable(path, list(columns), alone())
        for row in zip(*columns.values()):
            table.write(map(float, row))
        table.close()
        say(f"wrote {path}: {len(columns['time'])} rows")
