"""Fields of the frames of a run on a grid: as arrays, as NPZ, and for VTK."""

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from psph.case.keys import AXES
from psph.case.loader import load_to_read
from psph.lab.errors import MeasureError
from psph.output.checkpoint import COPY
from psph.output.export.parts import in_space
from psph.output.export.vtk import collection, image, replace
from psph.output.flowing import ALL, counted, groups_named
from psph.output.grids import GridPoints, Weighing, at_points, clouds
from psph.output.progress import with_progress
from psph.output.reader import Run
from psph.output.sizes import of_sizes
from psph.scene import Scene
from psph.scene.shapes import shown
from psph.simulation.materials import Materials
from psph.simulation.plan import make_plan

SHARE = "share"
"""The field that says how much of the kernel is in the fluid."""

USUAL = ("velocity", "pressure")

WHOLE_NUMBERS = ("id", "kind", "group")
"""Between which nothing lies."""


class Gridded(NamedTuple):
    """A frame on a grid: its ``number`` and ``time``, s, the ``axes``, m, and the ``fields``, each
    (nx, ny, nz) or (nx, ny, nz, components) with as many axes as the case has, NaN outside the fluid."""

    number: int
    time: float
    axes: list[np.ndarray]
    fields: dict[str, np.ndarray]


class Gridding:
    """The frames of the run in ``folder`` at the points that are asked for.

    ``step``, m, is the spacing of particles where None, the corners ``lower`` and ``upper``, m, those of the
    domain; ``plane`` an axis and a place there; ``of`` the fluid that counts, all where None.  Raises
    NotThere, CaseError, Refused or MeasureError.
    """

    def __init__(
        self,
        folder: Path,
        step: float | None = None,
        plane: tuple[int, float] | None = None,
        lower: Sequence[float] | None = None,
        upper: Sequence[float] | None = None,
        fields: Sequence[str] = USUAL,
        of: str | None = None,
    ):
        self.run, self.fields = Run(folder), tuple(fields)
        case, _ = load_to_read(self.run.folder / COPY)
        self.scene = Scene(case)
        self.dimensions = self.scene.dimensions
        self._materials: Materials = make_plan(self.scene).materials
        self._counting = counted(np.array(self._materials.kinds), self._groups(of))
        if not len(self.run.times):
            raise MeasureError(f"{self.run.path}: no frame yet; wait for the first one")
        saved = [name for name in self.run.fields if name not in (*WHOLE_NUMBERS, "position")]
        for name in self.fields:
            if name not in saved:
                raise MeasureError(
                    f"{self.run.path}: --fields {name}: not saved; give some of {', '.join(saved)}"
                )
        layout, dx = self.scene.layout, self.scene.spacing
        self._around = Weighing(self.scene.kernel, layout.lower, layout.periods)
        ends = [tuple(layout.lower), tuple(layout.upper)]
        for place, given in enumerate((lower, upper)):
            if given is not None and len(given) != self.dimensions:
                raise MeasureError(
                    f"measure --{('from', 'to')[place]}: {len(given)} numbers, not {self.dimensions}"
                )
            ends[place] = ends[place] if given is None else tuple(given)
        if plane is not None and plane[0] >= self.dimensions:
            raise MeasureError(f"measure --plane: no such axis in {self.dimensions}D")
        self._plane = "" if plane is None else f"-{AXES[plane[0]]}{plane[1]:g}"
        self.points = GridPoints.over(*ends, dx if step is None else step, plane)

    def _groups(self, of: str | None) -> tuple[int, ...]:
        names = [one.name for one in self.scene.species]
        if of is None:
            return ALL
        if of not in names:
            raise MeasureError(f"measure --of {of}: no fluid has this name; there are {', '.join(names)}")
        return tuple(groups_named(self.scene, of))

    def frames(self, times: Sequence[float] | None = None) -> Iterator[Gridded]:
        """Those nearest to ``times`` s, or all."""
        moments = self.run.times
        chosen = range(len(moments)) if times is None else self.run.nearest(times)
        places = self.points.places(self.dimensions)
        for number in with_progress(list(chosen), "interpolating", "frames"):
            yield self._frame(number, float(moments[number]), places)

    def _frame(self, number: int, time: float, places: np.ndarray) -> Gridded:
        reads = ("position", "kind", "group", "density", *of_sizes(self.run.fields), *self.fields)
        frame = self.run.frame(number, *dict.fromkeys(reads))
        fluid, walls, rows = clouds(frame, self._materials, self._counting, self.scene.smoothing_length)
        values = {name: frame[name][rows] for name in self.fields}
        found, share = at_points(fluid, walls, self._around, values, places)
        shape = self.points.counts[: self.dimensions]
        gridded = {name: one.reshape(*shape, *one.shape[1:]) for name, one in found.items()}
        return Gridded(
            number, time, self.points.axes(self.dimensions), gridded | {SHARE: share.reshape(shape)}
        )

    def written(self, folder: Path, times: Sequence[float] | None = None) -> Path:
        """Write a ``.vti`` and an ``.npz`` for each frame into ``folder``, with the place of a plane in their
        names; the path of the ``.pvd`` that lists the former.  Raises MeasureError where no point is near
        fluid in any of the frames."""
        folder.mkdir(parents=True, exist_ok=True)
        units = {name: self.run.unit(name) for name in self.fields} | {SHARE: "1"}
        stem, files, met = f"{self.run.path.stem}{self._plane}", [], False
        for one in self.frames(times):
            met |= bool(one.fields[SHARE].any())
            path = folder / f"{stem}_{one.number:05d}.vti"
            fields = {name: self._in_space(values) for name, values in one.fields.items()}
            replace(path, image(self.points.origin, self.points.step, fields, units, one.time))
            files.append((one.time, path.name))
            stored = io.BytesIO()
            np.savez_compressed(stored, time=one.time, **dict(zip("xyz", one.axes)), **one.fields)
            replace(path.with_suffix(".npz"), stored.getvalue())
        if not met:
            for name in (folder / name for _, name in files):
                name.unlink()
                name.with_suffix(".npz").unlink()
            corners = " to ".join(shown(one) for one in (self.scene.layout.lower, self.scene.layout.upper))
            raise MeasureError(
                f"{self.run.path}: no point is in the fluid; the domain at the start is {corners} m"
            )
        index = folder / f"{stem}.pvd"
        replace(index, collection(files))
        return index

    def _in_space(self, values: np.ndarray) -> np.ndarray:
        """A field (nx, ny, nz) or (nx, ny, nz, components), vectors with three."""
        components = values.shape[self.dimensions :]
        rows = values.reshape(-1, *components)
        return in_space(rows, self.dimensions).reshape(
            *self.points.counts, *in_space(rows, self.dimensions).shape[1:]
        )
