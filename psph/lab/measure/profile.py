"""Profiles: means over shells around a place, as a table and as a picture."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from psph.case.loader import load_to_read
from psph.fields import FLUID, GAS
from psph.lab.errors import MeasureError
from psph.output.checkpoint import COPY
from psph.output.flowing import ALL, counted, groups_named
from psph.output.gauges.fit import nearest
from psph.output.pictures import style
from psph.output.pictures.names import PROFILE, PROFILE_PICTURE
from psph.output.pictures.view import spread
from psph.output.progress import with_progress
from psph.output.reader import Run
from psph.output.sizes import MASS, of_sizes
from psph.output.tables import CsvTable
from psph.parallel.reductions import alone
from psph.scene import Scene

DENSITY = "density"
"""The field whose mean is by volume."""

DRAWN = 6
"""Times in a picture, at most."""

MOST = 100_000
"""Shells of a frame."""

WIDTH, HEIGHT, GAP = 6.4, 1.8, 0.35
"""Of the curves of a field, and between two of them, inches."""


class Shells(NamedTuple):
    """Shells around a place that hold particles: in the middle of each ``r`` (shells,), m, its ``mass`` and
    that ``within`` its outer radius, kg, and means of ``fields``."""

    r: np.ndarray
    mass: np.ndarray
    within: np.ndarray
    fields: dict[str, np.ndarray]


def shells(
    away: np.ndarray, mass: np.ndarray, density: np.ndarray, values: dict[str, np.ndarray], step: float
) -> Shells:
    """Means over the particles in shells, ``away`` (n, dim) from their middle, m.

    The mean density is Σm/Σ(m/ρ), that of other ``values``, (n,) or (n, dim), Σmf/Σm; of a vector the part
    along r, as ``velocity_r``.
    """
    distance = np.sqrt((away**2).sum(axis=1))
    number = np.floor(distance / step).astype(np.int64)
    held, shell = np.unique(number, return_inverse=True)

    def sums(of: np.ndarray) -> np.ndarray:
        return np.bincount(shell, of, len(held))

    total, fields = sums(mass), {}
    for name, rows in values.items():
        if name == DENSITY:
            fields[name] = total / sums(mass / density)
        elif rows.ndim == 1:
            fields[name] = sums(mass * rows) / total
        else:
            along = np.einsum("nd,nd->n", rows, away) / np.where(distance > 0.0, distance, 1.0)
            fields[f"{name}_r"] = sums(mass * along) / total
    return Shells((held + 0.5) * step, total, np.cumsum(total), fields)


class Profile:
    """Means of ``fields`` over shells around ``center`` (dim,), m, ``step`` m thick (the spacing where None),
    of what flows in the run in ``folder``, or of one of it, ``of``.  Raises NotThere, CaseError or
    MeasureError."""

    def __init__(
        self,
        folder: Path,
        center: Sequence[float],
        step: float | None,
        fields: Sequence[str],
        of: str | None = None,
    ):
        self.run, self.fields = Run(folder), tuple(fields)
        case, _ = load_to_read(self.run.folder / COPY)
        self._scene, self._center = Scene(case), np.array(center, float)
        self._step = self._scene.spacing if step is None else step
        given, asked = len(self._center), self._scene.dimensions
        if given != asked:
            raise MeasureError(f"measure --profile: {given} given; a place in {asked}D has {asked} numbers")
        if not self._step > 0.0:
            raise MeasureError(f"measure --profile: --step {self._step:g}: not above 0; leave it out")
        for name in self.fields:
            if name not in self.run.fields or self.run.frame(0, name)[name].dtype.kind != "f":
                raise MeasureError(f"{self.run.path}: --fields {name}: frames hold no such number")
        names = [one.name for one in self._scene.species]
        if of is not None and of not in names:
            raise MeasureError(f"measure --of {of}: nothing has this name; there are {', '.join(names)}")
        groups = ALL if of is None else tuple(groups_named(self._scene, of))
        kinds = np.array([part.kind for part in self._scene.species])
        self._counting = counted(kinds, groups)
        self._masses = np.array([one.mass for one in self._scene.species])

    def frames(self, times: Sequence[float] | None = None) -> Iterator[tuple[float, Shells]]:
        """Time, s, and shells of those nearest to ``times`` s, or of all."""
        moments = self.run.times
        chosen = range(len(moments)) if times is None else self.run.nearest(times)
        reads = ("position", "kind", "group", DENSITY, *of_sizes(self.run.fields), *self.fields)
        for k in with_progress(list(chosen), "measuring", "frames"):
            frame = self.run.frame(k, *dict.fromkeys(reads))
            rows = np.isin(frame["kind"], (FLUID, GAS)) & self._counting[frame["group"]]
            if not rows.any():
                raise MeasureError(f"{self.run.path}: nothing flows at {moments[k]:g} s; give other --times")
            mass = frame[MASS] if MASS in frame else self._masses[frame["group"]]
            away = nearest(frame["position"][rows] - self._center, self._scene.layout.periods)
            if np.nanmax(np.abs(away)) > MOST * self._step:
                raise MeasureError(f"measure --profile: --step {self._step:g} m: too thin; give a larger one")
            values = {name: frame[name][rows] for name in self.fields}
            yield float(moments[k]), shells(away, mass[rows], frame[DENSITY][rows], values, self._step)

    def written(self, folder: Path, times: Sequence[float] | None = None) -> Path:
        """Write ``profile.csv`` and ``profile.png`` into ``folder``; the path of the former."""
        folder.mkdir(parents=True, exist_ok=True)
        found = list(self.frames(times))
        path = folder / PROFILE
        table = CsvTable(path, ["time", "r", "mass", "mass_within", *found[0][1].fields], alone())
        for time, one in found:
            for row in zip(one.r, one.mass, one.within, *one.fields.values()):
                table.write([time, *map(float, row)])
        table.close()
        style.save(self._picture([found[k] for k in spread(len(found), DRAWN)]), folder / PROFILE_PICTURE)
        return path

    def _picture(self, found: Sequence[tuple[float, Shells]]) -> Figure:
        names = list(found[0][1].fields)
        above = style.TOP + 0.2
        size = style.LEFT + WIDTH + 0.3, above + len(names) * (HEIGHT + GAP) - GAP + style.BOTTOM
        end = self._scene.case.time.end
        with style.look():
            title = self._scene.case.title or self.run.path.stem
            figure = style.sheet(*size, title, "means over shells around one place")
            for n, name in enumerate(names):
                axes = style.panel(figure, style.LEFT, above + n * (HEIGHT + GAP), WIDTH, HEIGHT)
                field = next(field for field in self.fields if name.startswith(field))
                largest = max(np.abs(one.fields[name]).max() for _, one in found)
                factor, unit = style.readable(self.run.unit(field), largest)
                for k, (time, one) in enumerate(found):
                    colour = style.LINES[k % len(style.LINES)]
                    axes.plot(one.r, factor * one.fields[name], color=colour, label=style.moment(time, end))
                axes.set_title(f"{name.replace('_', ' ')} ({unit})", loc="left", size=9)
                style.ticks(axes.yaxis, 4)
                axes.set_xlim(0.0, None)
                axes.tick_params(labelbottom=n == len(names) - 1)
                if n == 0:
                    axes.legend(loc="upper right")
            axes.set_xlabel("r (m)")
        return figure
