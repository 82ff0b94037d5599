"""Studies from Python: error and run time over choices of a case."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from psph.api.case import Case, load
from psph.api.changes import toml
from psph.api.reading import Results, Table
from psph.errors import Refused
from psph.parallel.reductions import world


class StudyResults:
    """What a study has found: ``table`` has a row for each run, ``runs`` the results of each.

    ``error`` says what the errors are of, ``table["error_l2"]`` has them; docs/study.md has all columns.
    """

    def __init__(self, folder: str | Path):
        from psph.lab.study.study import KEPT

        self.folder = Path(folder)
        path = self.folder / KEPT
        if not path.is_file():
            raise Refused(f"{path}: no such file; give the folder of a study that is finished")
        kept = json.loads(path.read_text(encoding="utf-8"))
        self.error: str = kept["error"]
        self.vary: list[str] = kept["vary"]
        self.table = _table(kept["rows"])

    @property
    def runs(self) -> list[Results]:
        """The results of each run that is finished, in the order of the table."""
        from psph.lab.study.runs import DONE

        return [
            Results(self.folder / f"run-{k + 1:02d}")
            for k, status in enumerate(self.table["status"])
            if status == DONE
        ]

    def report(self) -> Path:
        """Write report.html into the folder; its path (docs/output.md)."""
        from psph.lab.report.page import report

        return report(self.folder)

    def __repr__(self) -> str:
        return f"<psph.StudyResults {self.folder}: {self.table.rows} runs over {', '.join(self.vary)}>"


def study(
    case: Case | str | Path,
    vary: Mapping[str, Sequence[Any]] | None = None,
    *,
    grid: bool = False,
    out: str | Path | None = None,
    comm=None,
    quiet: bool = False,
    threads: int = 1,
) -> StudyResults:
    """Run a case with several spacings, kernels or other choices; error and run time of each.

    ``vary`` has the values of each key, such as ``{"space.spacing": [0.04, 0.02]}`` (default: what the
    case says under ``[study]``), ``grid`` makes all combinations.  Physics of your own come with
    :meth:`psph.Case.using`.  Raises CaseError or Refused before the first run.
    """
    from psph.engine.threads import use_threads
    from psph.lab.study import command

    use_threads(threads)
    loaded = case if isinstance(case, Case) else load(case)
    comm = world() if comm is None else comm
    wanted = [f"{key}={','.join(map(_word, values))}" for key, values in (vary or {}).items()]
    folder = Path(out or f"{loaded.name}-study")
    command.study(
        comm,
        loaded.file,
        list(loaded.changes),
        wanted,
        grid,
        effects=False,
        out=folder,
        error=None,
        seconds=None,
        quiet=quiet,
        make=lambda file, sets: loaded.made(sets),
    )
    comm.Barrier()
    return StudyResults(folder)


def _word(value: Any) -> str:
    return value if isinstance(value, str) else toml(value)


def _table(rows: Sequence[Mapping[str, Any]]) -> Table:
    """Columns of rows that need not have the same keys: nan or an empty word where one has none."""
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {}
    for name in names:
        values = [row.get(name) for row in rows]
        words = any(isinstance(value, str) for value in values)
        gap: Any = "" if words else np.nan
        columns[name] = np.array([gap if value is None else value for value in values])
    return Table(columns)
