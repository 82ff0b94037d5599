"""Measured curves for a study: files in the folder of a case, or in one that a person allows."""

from pathlib import Path

import numpy as np

from psph.case.curves import read_curve
from psph.case.files import Unfit
from psph.lab.errors import StudyError


def read_experiment(case, name: str, files: Path | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Times in s and values of an experiment of the case, sorted by time.

    ``files`` is the folder that the file must lie in or below, links followed; None: the case's
    own.  Raises StudyError.
    """
    experiment, where = case.experiments[name], f"{case.file}: experiments.{name}"
    path = path_of(case) / experiment.file
    _refuse_outside(path, files or path_of(case), f"{where}.file")
    try:
        return read_curve(experiment, path, where)
    except Unfit as error:
        raise StudyError(str(error)) from None


def path_of(case) -> Path:
    """The folder of a case."""
    return Path(case.file).parent


def _refuse_outside(path: Path, files: Path, where: str) -> None:
    try:
        inside = path.resolve().is_relative_to(files.resolve())
    except (OSError, RuntimeError) as error:  # links in a circle
        raise StudyError(f"{where}: {path}: {error}; give a CSV file in the case's folder") from None
    if not inside:
        raise StudyError(
            f"{where}: {path} lies outside {files}; move it into that folder, or allow another one "
            "with --files DIR"
        )
