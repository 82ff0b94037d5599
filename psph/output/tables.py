"""Numbers over time as CSV; each row is written at once."""

import csv
import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from psph.output.errors import OutputError, cause, together

LOG, PROBES, ERRORS = "log.csv", "probes.csv", "errors.csv"
"""The tables of a run: log, probes, errors against the exact solution."""

POSES = "poses.csv"
"""At the time of each frame the state of what forces, or waves, move as a whole, as JSON."""

GAUGE = "gauge-{}.csv"
"""The table of a gauge of that name."""

MEASURED = "measured-{}.csv"
"""The same of a gauge on the frames of a run (psph.lab.measure)."""


def tables_of(case: Mapping[str, Any]) -> list[str]:
    """Names of the files of all tables that a run may have, from the keys of its ``case``."""
    gauges = (GAUGE.format(name) for name in case.get("gauges", {}))
    return [LOG, PROBES, ERRORS, POSES, *gauges, *(f"{name}.csv" for name in case.get("tables", {}))]


class CsvTable:
    """A CSV file with a line of names, written by rank 0; the other ranks may call it all the same.

    Floats stand with all their digits: what is read back is what was computed.  Created here;
    or, with ``kept``, the file of a run that goes on, cut back to so many bytes.
    Raises OutputError: on every rank when it is opened, on rank 0 when a row cannot be written.
    """

    def __init__(self, path: Path, columns: Sequence[str], comm, kept: int | None = None):
        self.path, self.columns = Path(path), tuple(columns)
        self._file = None
        with together(comm, self.path):
            if comm.rank == 0:
                if kept is not None:
                    _cut(self.path, kept)
                mode = "w" if kept is None else "a"
                self._file = open(self.path, mode, newline="", encoding="utf-8")
                self._rows = csv.writer(self._file, lineterminator="\n")
        if kept is None:
            self.write(self.columns)

    def write(self, values: Iterable) -> None:
        """Append a row: one value for each column."""
        if self._file is None:
            return
        try:
            self._rows.writerow(values)
            self._file.flush()
        except OSError as error:
            with suppress(OSError):  # it tries once more to write what it holds
                self.close()
            raise OutputError(
                f"{self.path}: cannot be written: {cause(error)}; check the free space"
            ) from error

    def size(self) -> int:
        """Bytes so far, all of them on the disk; 0 on the other ranks."""
        if self._file is None:
            return 0
        os.fsync(self._file.fileno())
        return os.fstat(self._file.fileno()).st_size

    def close(self) -> None:
        """End the file; a second call does nothing."""
        if self._file is not None:
            file, self._file = self._file, None
            file.close()


def _cut(path: Path, size: int) -> None:
    """Remove what follows after ``size`` bytes; raise OSError if there are fewer."""
    if path.stat().st_size < size:
        raise OSError(f"rows are missing, it had {size:,} bytes at the checkpoint")
    os.truncate(path, size)
