"""A run beside the experiments that its case names."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from psph.case import CaseError
from psph.case.loader import load_to_read
from psph.lab.errors import StudyError
from psph.lab.study.experiment import read_experiment
from psph.lab.study.judge import series_errors, value_at
from psph.output.checkpoint import COPY
from psph.output.reader import Run


class Beside(NamedTuple):
    """An experiment of a ``name`` beside the ``column`` of a run: ``time`` s and ``value`` as measured,
    and the relative ``error`` of the run over the times that both have, NaN where there are none."""

    name: str
    column: str
    time: np.ndarray
    value: np.ndarray
    error: float

    def in_words(self) -> str:
        """One line: how far apart they are."""
        return f"{self.column} beside {self.name}: {100.0 * self.error:.3g} % apart (L2)"


def beside(folder: Path) -> list[Beside]:
    """The experiments of the run in ``folder`` whose file and column are there."""
    run, found = Run(folder), []
    try:
        case, _ = load_to_read(Path(folder) / COPY)
    except CaseError:  # of another version; the frames can be drawn all the same
        return []
    for name, experiment in case.experiments.items():
        table = run.measured(experiment.probe)
        if not table or not (Path(folder) / experiment.file).is_file():
            continue
        try:
            time, value = read_experiment(case, name)
        except StudyError:  # what a study refuses, a picture does without
            continue
        ours = value_at(time, table, experiment.probe)
        known, rows = np.isfinite(ours), table["time"]
        error = series_errors(ours[known], value[known]).l2
        both = (time >= rows[0]) & (time <= rows[-1]) if len(rows) else known
        found.append(Beside(name, experiment.probe, time[both], value[both], error))
    return found
