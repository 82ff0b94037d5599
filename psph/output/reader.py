"""A run's folder, read back: finished or still running."""

import csv
import json
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

import h5py
import numpy as np

from psph.errors import one_line
from psph.output.errors import NotThere, cause
from psph.output.frames import LINE, TENSION
from psph.output.tables import ERRORS, GAUGE, LOG, POSES, PROBES
from psph.output.xdmf import index_of

T = TypeVar("T")


class Run:
    """What a run has left in ``folder`` so far; every call reads again.

    ``name`` is that of the case, where the folder may hold the files of several.  Raises NotThere with one
    line when there is nothing to read.
    """

    def __init__(self, folder: Path, name: str | None = None):
        self.folder = Path(folder)
        files = sorted(self.folder.glob("*.h5" if name is None else f"{name}.h5"))
        files = [path for path in files if index_of(path)] or files
        if len(files) != 1:
            names = ", ".join(path.name for path in files) or "none"
            raise NotThere(
                f"{self.folder}: the folder of a run holds one file of frames (.h5), "
                f"here: {names}; give the folder that psph wrote to"
            )
        self.path = files[0]

    @property
    def attributes(self) -> dict:
        """The attributes of the file: the case, psph's version and so on."""
        return _read(self.path, lambda file: dict(file.attrs))

    @property
    def case_text(self) -> str:
        """The case with its defaults filled in, TOML."""
        return self.attributes["case"]

    @property
    def times(self) -> np.ndarray:
        """Times of the complete frames, s."""
        return _read(self.path, lambda file: np.array([_time(file, name) for name in _whole(file)]))

    def nearest(self, times: Sequence[float]) -> list[int]:
        """The frames nearest to ``times`` s, each once.  NotThere before the first or beyond the last."""
        there = self.times
        first, last = float(there[0]), float(there[-1])
        half = 0.5 * (last - first) / max(len(there) - 1, 1)
        for asked in times:
            if not first - half <= asked <= last + half:
                raise NotThere(
                    f"{self.path}: --times {asked:g}: there are frames from {first:g} to {last:g} s; "
                    "give times between these"
                )
        return sorted({int(np.abs(there - asked).argmin()) for asked in times})

    @property
    def fields(self) -> list[str]:
        """Names of what the last whole frame holds of each particle."""
        return _read(self.path, lambda file: _saved(file["frames"][_whole(file)[-1]]))

    def frame(self, k: int, *names: str) -> dict[str, np.ndarray]:
        """Fields of the k-th whole frame, ``-1`` the last: ``(n,)`` or ``(n, dim)`` each.

        All of them, or those with the given ``names``.
        """

        def read(file: h5py.File) -> dict[str, np.ndarray]:
            frames = _whole(file)
            if not -len(frames) <= k < len(frames):
                raise NotThere(f"{self.path}: frame: {k} is not one of the {len(frames)} frames so far")
            frame = file["frames"][frames[k]]
            saved = _saved(frame)
            for name in set(names) - set(saved):
                raise NotThere(f"{self.path}: field: {name} is not saved; choose one of {', '.join(saved)}")
            return {name: frame[name][...] for name in names or saved}

        return _read(self.path, read)

    def lines(self, k: int) -> dict[str, tuple[np.ndarray, float]]:
        """Points (m, dim), m, and tension, N, of each line of bodies in the k-th whole frame, by name."""

        def read(file: h5py.File) -> dict[str, tuple[np.ndarray, float]]:
            told = file["frames"][_whole(file)[k]].attrs
            names = [key.removeprefix(f"{LINE} ") for key in told if key.startswith(f"{LINE} ")]
            return {name: (told[f"{LINE} {name}"], float(told[f"{TENSION} {name}"])) for name in names}

        return _read(self.path, read)

    def unit(self, name: str) -> str:
        """The unit of a field, as the last whole frame says."""
        return _read(self.path, lambda file: str(file["frames"][_whole(file)[-1]][name].attrs["unit"]))

    def probes(self) -> dict[str, np.ndarray]:
        """The columns of ``probes.csv`` by name; empty if the case has no probes."""
        return _columns(self.folder / PROBES)

    def gauges(self) -> dict[str, dict[str, np.ndarray]]:
        """The columns of each gauge by the gauge's name."""
        begin, end = GAUGE.split("{}")
        tables = sorted(self.folder.glob(GAUGE.format("*")))
        return {path.name.removeprefix(begin).removesuffix(end): _columns(path) for path in tables}

    def poses(self) -> dict[float, tuple[float, dict]]:
        """By the time of each frame, s: the time step before, s, and the state of what forces or waves move
        as a whole; empty where nothing is."""
        path = self.folder / POSES
        if not path.exists():
            return {}
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = [row for row in csv.reader(file) if len(row) == 3][1:]
            return {float(time): (float(dt), json.loads(state)) for time, dt, state in rows}
        except (OSError, ValueError) as error:
            raise NotThere(f"{path}: {one_line(str(error))}; is it a table of psph?") from None

    def measured(self, column: str) -> dict[str, np.ndarray]:
        """The table, of the probes or of a gauge, that has a column such as ``tip.front``; empty: none."""
        tables = (self.probes(), *self.gauges().values())
        return next((table for table in tables if column in table), {})

    def log(self) -> dict[str, np.ndarray]:
        """The columns of ``log.csv`` by name."""
        return _columns(self.folder / LOG)

    def table(self, name: str) -> dict[str, np.ndarray]:
        """The columns of another table by name; empty if there is no such file."""
        return _columns(self.folder / name)

    def errors(self) -> dict[str, np.ndarray]:
        """The columns of ``errors.csv`` by name; empty if the case has no exact solution."""
        return _columns(self.folder / ERRORS)


def _read(path: Path, what: Callable[[h5py.File], T]) -> T:
    """``what`` of the file; tried again if a run is changing its structure just then (a millisecond)."""
    for attempt in range(8):
        try:
            with h5py.File(path, "r", locking=False) as file:
                return what(file)
        except NotThere:
            raise
        except (OSError, RuntimeError, KeyError) as error:  # all that h5py makes of it
            failure = error
            time.sleep(0.02 * attempt)
    raise NotThere(f"{path}: cannot be read: {cause(failure)}; is it a file of psph?")


def _whole(file: h5py.File) -> list[str]:
    """Names of the frames in their order; the time is the last thing that a frame gets.

    Only the last one can lack it, so that not all have to be opened.
    """
    if "frames" not in file:
        raise NotThere(f"{file.filename}: holds no frames; is it a file of psph?")
    names = sorted(file["frames"], key=int)
    while names and not np.isfinite(_time(file, names[-1])):
        names.pop()
    return names


def _saved(frame: h5py.Group) -> list[str]:
    return [name for name in frame if name != "points"]


def _time(file: h5py.File, name: str) -> float:
    return float(file["frames"][name].attrs.get("time", np.nan))


def _columns(path: Path) -> dict[str, np.ndarray]:
    if not path.exists():
        return {}
    try:
        names, *rows = path.read_text(encoding="utf-8").splitlines(keepends=True)
        names = names.strip().split(",")
        rows = [row for row in rows if row.endswith("\n")]  # the last one may be on its way
        table = np.loadtxt(rows, delimiter=",", ndmin=2) if rows else np.empty((0, len(names)))
        return dict(zip(names, table.T, strict=True))
    except (OSError, ValueError) as error:
        raise NotThere(f"{path}: {one_line(str(error))}; is it a table of psph?") from None
