"""Pictures of pixels: particles of many sizes in a plane, and what lines of sight through a scene meet."""

from functools import cached_property
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes

from psph.case.keys import AXES
from psph.composition.reflections import BELOW, Plane
from psph.fields import WALL
from psph.output.columns import Pixels, columns, kernel_column, mirrored, with_images
from psph.output.export.parts import Exported
from psph.output.grids import Cloud, Weighing, at_points
from psph.output.pictures.flat import Flat, Slice
from psph.output.pictures.quantities import Quantity
from psph.output.pictures.scale import Scale
from psph.output.pictures.view import Room
from psph.output.sizes import LENGTH, MASS
from psph.smoothing import unit_kernel

DENSITY = "density"
"""The field that columns of mass take the name of."""

FINE, FINEST = 160, 480
"""Pixels along the longer side of a plane, and of a column."""


class SpreadMass:
    """What particles of a run weigh, and how far they are spread, by its case."""

    def __init__(self, exported: Exported):
        self._exported = exported
        self.scene = exported.scene

    def of(self, frame: dict) -> tuple[dict, np.ndarray, np.ndarray]:
        """The particles of ``frame`` that are not walls, their masses (n,), kg, and h (n,), m; of finer
        regions by the ``width`` of each."""
        here = {name: rows[frame["kind"] != WALL] for name, rows in frame.items()}
        masses, part = self._exported.masses, here["width"] / self.scene.spacing
        if LENGTH in here:
            return here, here[MASS] if MASS in here else masses[here["group"]], here[LENGTH]
        return here, masses[here["group"]] * part**self.scene.dimensions, self.scene.smoothing_length * part

    @cached_property
    def unit_kernel(self):
        """That of the scene with h = 1 m."""
        return unit_kernel(self.scene.kernel, self.scene.dimensions)


class Raster(Flat):
    """A page of a ``room`` that pixels fill, by their values in a frame (up, across), NaN where there is
    nothing."""

    def __init__(self, room: Room, cut: Slice | None, most: int, mass: SpreadMass):
        self._mass, self._most = mass, most
        super().__init__(room, cut)

    def look(self, along: int | None) -> None:
        """Lay out the page; along axes that repeat it has one period, and it ends at mirrors."""
        super().look(along)
        layout = self._mass.scene.layout
        for n, axis in enumerate((self.across, self.up)):
            if layout.periods[axis]:
                self.lower[n], self.upper[n] = layout.lower[axis], layout.upper[axis]
        for n, plane in self._planes:
            (self.lower if plane.side == BELOW else self.upper)[n] = plane.at

    @property
    def _planes(self) -> list[tuple[int, Plane]]:
        """Mirrors that the page has the edge of, each with the axis of the page."""
        axes = {self.across: 0, self.up: 1}
        planes = self._mass.scene.layout.mirror_planes
        return [(axes[plane.axis], plane) for plane in planes if plane.axis in axes]

    def of(self, frame: dict) -> dict:
        """All of it, with ``pixels``."""
        return frame | {"pixels": self.pixels(frame)}

    @property
    def grid(self) -> Pixels:
        """The pixels of the page."""
        return Pixels.over(self.lower, self.upper, self._most)

    def pixels(self, frame: dict) -> np.ndarray:
        """The values of a frame (up, across)."""
        raise NotImplementedError

    def fill(self, axes: Axes, frame: dict, scale: Scale) -> None:
        """Its pixels."""
        colours = matplotlib.colormaps[scale.colours].copy()
        if scale.on_dark:
            colours.set_bad(colours(0.0))
        ends = (self.lower[0], self.upper[0], self.lower[1], self.upper[1])
        shown = {"norm": scale.norm, "cmap": colours, "origin": "lower", "aspect": "auto"}
        axes.imshow(frame["pixels"] * scale.factor, extent=ends, interpolation="nearest", **shown)


class CutThrough(Raster):
    """A plane ``cut`` through particles of many sizes: a straight function fitted at each pixel
    (psph.output.grids), by the size of each."""

    def __init__(self, room: Room, cut: Slice, mass: SpreadMass):
        super().__init__(room, cut, FINE, mass)

    def pixels(self, frame: dict) -> np.ndarray:
        """The values in the plane (up, across)."""
        here, mass, length = self._mass.of(frame)
        scene, pixels = self._mass.scene, self.grid
        places = np.empty((pixels.count[0] * pixels.count[1], 3))
        places[:, [self.across, self.up]], places[:, self.cut.axis] = pixels.middles, self.cut.place
        spread = Cloud(here["position"], mass / here["density"], length / scene.smoothing_length)
        around = Weighing(scene.kernel, scene.layout.lower, scene.layout.periods)
        none = Cloud(np.zeros((0, 3)), np.zeros(0))
        found, _ = at_points(spread, none, around, {"values": here["values"]}, places)
        return found["values"].reshape(pixels.count[::-1])


class LinesOfSight(Raster):
    """All of a room on the lines of sight ``along`` an axis: mass by area, or the mean by mass of ``values``.

    In 2D the mass by area is that of the plane itself.
    """

    def __init__(self, room: Room, along: str, mass: SpreadMass, of_mass: bool):
        super().__init__(room, None, FINEST, mass)
        self._of_mass, self.variant = of_mass, "column"
        if room.dimensions == 3:
            self.look(AXES.index(along))
            self.remark = f"along {along}"

    def pixels(self, frame: dict) -> np.ndarray:
        """Those of a frame (up, across)."""
        here, mass, length = self._mass.of(frame)
        kernel, scene = self._mass.unit_kernel, self._mass.scene
        axes = [self.across, self.up]
        reach, periods = kernel.support * length, [scene.layout.periods[axis] for axis in axes]
        ends = self.lower, self.upper
        places, who = with_images(here["position"][:, axes], reach, *ends, periods)
        places, who = mirrored(places, who, reach, [(n, plane.at) for n, plane in self._planes])
        amounts = [mass[who], (mass * here["values"])[who]] if not self._of_mass else [mass[who]]
        table = kernel_column(kernel, scene.dimensions)
        found = columns(places, amounts, reach[who], table, self.grid)
        total = np.where(found[0] > 0.0, found[0], np.nan)
        return total if self._of_mass else found[1] / total


def filled(room: Room, cut: Slice | None, along: str | None, folder: Path, shown: Quantity) -> Raster:
    """The page of the run in ``folder`` in the plane ``cut``, else ``along`` an axis."""
    mass = SpreadMass(Exported(folder, None))
    if along is None:
        return CutThrough(room, cut, mass)
    return LinesOfSight(room, along, mass, shown.steep)


def column_density(dimensions: int) -> Quantity:
    """The mass on a line of sight, kg/m²."""
    title = "column density" if dimensions == 3 else "density"
    return Quantity(DENSITY, title, "kg/m2", (), lambda frame: np.ones(len(frame["kind"])), steep=True)
