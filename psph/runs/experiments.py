"""Whether a run measures what the experiments and the numbers of its case are of."""

from collections.abc import Iterator
from pathlib import Path

from psph.case import CaseError
from psph.case.curves import read_curve
from psph.case.errors import advise
from psph.case.files import Unfit, lies_in
from psph.runs.record import columns_of


def refuse_unfit_experiments(scene) -> None:
    """Raise CaseError, a line each, where a file, a column of it, or the column to compare is not there."""
    if faults := list(_faults(scene)):
        raise CaseError(faults)


def _faults(scene) -> Iterator[str]:
    case, folder = scene.case, Path(scene.case.file).parent
    columns = columns_of(scene) if case.experiments or case.numbers else []

    def unmeasured(where: str, column: str) -> Iterator[str]:
        if column not in columns:
            known = advise(column, columns) if columns else "add a probe or a gauge"
            yield f'{case.file}: {where}: "{column}" is not measured in this case; {known}'

    for name, number in case.numbers.items():
        for which, column in zip(("of", "wave"), number.columns):
            yield from unmeasured(f"numbers.{name}.{which}", column)
    for name, experiment in case.experiments.items():
        where, path = f"{case.file}: experiments.{name}", folder / experiment.file
        yield from unmeasured(f"experiments.{name}.probe", experiment.probe)
        if path.is_file() and not lies_in(folder, experiment.file):
            continue  # a study reads it, where it is told to
        try:
            read_curve(experiment, path, where)
        except Unfit as error:
            yield str(error)
