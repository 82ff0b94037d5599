"""Measured curves that a case names: CSV files, checked when read."""

import csv
import math
from pathlib import Path

import numpy as np

from psph.case.files import Unfit


def read_curve(experiment, path: Path, where: str) -> tuple[np.ndarray, np.ndarray]:
    """Times in s and values of an ``experiment`` (psph.case.study) from its file, sorted by time.

    ``where`` is the key of the experiment in messages.  Raises Unfit.
    """
    lines = [line for line in _lines(path, f"{where}.file") if line.strip() and line[0] != "#"]
    where = f"{where}: {path}"
    names, *rows = _cells(lines, where) or [[]]
    columns = [_column(names, wanted, where) for wanted in (experiment.time, experiment.value)]
    for row in rows:
        if len(row) != len(names):
            raise Unfit(
                f"{where}: {len(row)} values in '{','.join(row)}', {len(names)} names above; give "
                "each line a value for each name, with a point in its numbers"
            )
    if not rows:
        raise Unfit(f"{where} holds no rows; give a CSV file with a line of names")
    time, value = np.array(sorted([_number(row[k], where) for k in columns] for row in rows)).T
    return time * experiment.time_unit, value * experiment.value_unit


def _lines(path: Path, where: str) -> list[str]:
    """The lines of a plain file: a pipe or a device might never end."""
    try:
        if path.exists() and not path.is_file():
            raise Unfit(f"{where}: {path} is not a regular file; give a CSV file in the case's folder")
        return path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or error
        raise Unfit(f"{where}: {path}: {why}; give a CSV file in the case's folder") from None


def _cells(lines: list[str], where: str) -> list[list[str]]:
    try:
        return list(csv.reader(lines, strict=True))
    except csv.Error as error:
        raise Unfit(f"{where}: {error}; give numbers with commas between them") from None


def _column(names: list[str], wanted: str, where: str) -> int:
    if names.count(wanted) != 1:
        found = "no column" if wanted not in names else "more than one column"
        raise Unfit(f"{where} has {found} '{wanted}'; give one of {', '.join(names)}")
    return names.index(wanted)


def _number(word: str, where: str) -> float:
    try:
        number = float(word)
    except ValueError as error:
        raise Unfit(f"{where}: {error}; let each line hold numbers") from None
    if not math.isfinite(number):
        raise Unfit(f"{where}: '{word}' is not finite; let each line hold numbers")
    return number
