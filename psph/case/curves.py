"""Measured curves that a case names: CSV files, checked when read."""

import math
from pathlib import Path

import numpy as np

from psph.case.columns import MOST_ROWS, named, rows_of
from psph.case.files import Unfit
from psph.errors import LONGEST_QUOTE, shortened


def read_curve(experiment, path: Path, where: str) -> tuple[np.ndarray, np.ndarray]:
    """Times in s and values of an ``experiment`` (psph.case.study) from its file, sorted by time.

    ``where`` is the key of the experiment in messages.  Raises Unfit.
    """
    if path.exists() and not path.is_file():  # a pipe or a device might never end
        raise Unfit(f"{where}.file: {path} is not a regular file; give a CSV file in the case's folder")
    try:
        names, *rows = [cells for _, cells in rows_of(path, MOST_ROWS)] or [[]]
    except Unfit as error:
        raise Unfit(f"{where}.file: {error}") from None
    where = f"{where}: {path}"
    columns = [_column(names, wanted, where) for wanted in (experiment.time, experiment.value)]
    for row in rows:
        if len(row) != len(names):
            shown = shortened(",".join(row), LONGEST_QUOTE)
            raise Unfit(
                f"{where}: {len(row)} values in '{shown}', {len(names)} names above; give "
                "each line a value for each name, with a point in its numbers"
            )
    if not rows:
        raise Unfit(f"{where} holds no rows; give a CSV file with a line of names")
    time, value = np.array(sorted([_number(row[k], where) for k in columns] for row in rows)).T
    return time * experiment.time_unit, value * experiment.value_unit


def _column(names: list[str], wanted: str, where: str) -> int:
    if names.count(wanted) != 1:
        how_many = "no column" if wanted not in names else "more than one column"
        raise Unfit(f"{where} has {how_many} '{wanted}'; give one of {named(names)}")
    return names.index(wanted)


def _number(word: str, where: str) -> float:
    try:
        number = float(word)
    except ValueError:
        shown = shortened(word, LONGEST_QUOTE)
        raise Unfit(f"{where}: '{shown}' is no number; let each line hold numbers") from None
    if not math.isfinite(number):
        raise Unfit(f"{where}: '{word}' is not finite; let each line hold numbers")
    return number
