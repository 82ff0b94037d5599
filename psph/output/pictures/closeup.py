"""A picture of a particle and its neighbours: pressure, velocity, and the kernel's support."""

from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.patches import Circle

from psph.fields import BUFFER, WALL
from psph.output.pictures import style
from psph.output.pictures.flat import circles
from psph.output.pictures.scale import SIGNS

SIZE = 4.6
"""Of the panel, inches."""
LONGEST = 1.6
"""Spacings of the longest arrow."""
PALE = 0.45
"""Opacity of what is led by others."""
SPREAD = (4.0, 96.0)
"""Percentiles of the pressure at the ends of the colours, so that an outlier does not hide the rest."""


def draw(path: Path, title: str, time: float, scene, around, offset, column: int, place) -> Path:
    """Draw the particles ``around`` (Store), at ``offset`` m (n, dim) from the one in ``column``.

    That one is at ``place`` (dim,) m.  What is led by others, as what follows another size, is pale.  In 3D
    it is the slice through it that holds the direction of gravity, but for a periodic axis; in 1D the
    pressure stands upwards.
    """
    across, up, seen = _slice(scene, offset)
    fluid = around.shown("kind") != WALL
    subtitle = f"particle {around.shown('id')[column]} and its neighbours, t = {time:.6g} s"
    subtitle += ", pale: led by others" if (around.shown("kind") == BUFFER).any() else ""
    with style.look():
        figure = style.sheet(
            style.LEFT + SIZE + style.RIGHT, style.TOP + SIZE + style.BOTTOM, title, subtitle
        )
        axes = style.panel(figure, style.LEFT, style.TOP, SIZE, SIZE)
        reach = np.abs(offset).max(initial=scene.spacing) + 0.6 * scene.spacing
        axes.set_xlim(place[across] - reach, place[across] + reach)
        pressure = around.shown("pressure")
        norm, factor, unit = _scale(pressure[seen & fluid])
        if scene.dimensions == 1:
            _line(axes, place[across] + offset[:, 0], pressure * factor, fluid, column)
            axes.set_ylabel(f"pressure ({unit})")
        else:
            axes.set_ylim(place[up] - reach, place[up] + reach)
            spots = place[[across, up]] + offset[:, [across, up]]
            circles(axes, spots[seen & ~fluid], scene.spacing, facecolors=style.WALLS)
            led = around.shown("kind") == BUFFER
            for some, alpha in ((seen & led, PALE), (seen & fluid & ~led, 1.0)):
                drawn = circles(axes, spots[some], scene.spacing, norm=norm, cmap=SIGNS, alpha=alpha)
                drawn.set_array(pressure[some] * factor)
            velocity = around.shown("velocity")[:, [across, up]]
            _arrows(axes, spots, velocity, seen & fluid, scene.spacing)
            _mark(axes, spots[column], scene)
            bar = style.panel(figure, style.LEFT + SIZE + 0.15, style.TOP, 0.13, SIZE)
            colours = figure.colorbar(ScalarMappable(norm, SIGNS), cax=bar, extend="both")
            colours.outline.set_visible(False)
            colours.set_label(f"pressure ({unit})")
            axes.set_ylabel(f"{'xyz'[up]} (m)")
        axes.set_xlabel(f"{'xyz'[across]} (m)")
        style.ticks(axes.xaxis, 4)
        style.ticks(axes.yaxis, 4)
        return style.save(figure, path)


def _slice(scene, offset: np.ndarray) -> tuple[int, int, np.ndarray]:
    """The axes to the right and upwards, and which particles are seen."""
    if scene.dimensions == 1:
        return 0, 0, np.ones(len(offset), bool)
    pull = np.abs(scene.layout.height_gravity)
    up = int(pull.argmax()) if pull.any() else scene.dimensions - 1
    across, *cut = (d for d in range(scene.dimensions) if d != up)
    seen = np.ones(len(offset), bool)
    for d in cut:
        seen &= np.abs(offset[:, d]) < 0.75 * scene.spacing
    return across, up, seen


def _scale(pressure: np.ndarray) -> tuple[Normalize, float, str]:
    """Colours around zero, and the factor and unit of their numbers."""
    known = pressure[np.isfinite(pressure)]
    largest = np.abs(np.percentile(known, SPREAD)).max() if len(known) else 0.0
    largest = float(largest) or 1.0
    factor, unit = style.readable("Pa", largest)
    return Normalize(-largest * factor, largest * factor), factor, unit


def _arrows(axes, spots, velocity, seen, spacing: float) -> None:
    """Velocities, the fastest as long as ``LONGEST`` spacings; a key gives its speed."""
    speed = np.linalg.norm(velocity, axis=1)
    seen = seen & np.isfinite(speed) & np.isfinite(spots).all(axis=1)
    fastest = speed[seen].max(initial=0.0)
    if fastest > 0.0:
        arrows = axes.quiver(
            *spots[seen].T,
            *velocity[seen].T,
            angles="xy",
            scale_units="xy",
            color=style.INK,
            scale=fastest / (LONGEST * spacing),
            width=0.0035,
            zorder=3,
        )
        axes.quiverkey(
            arrows, 0.86, 1.03, fastest, f"{fastest:.3g} m/s", labelpos="W", fontproperties={"size": 9}
        )


def _mark(axes, spot, scene) -> None:
    """A ring around the particle, and a dashed one around the kernel's support."""
    reach = scene.support
    for radius, how in (
        (0.75 * scene.spacing, {"lw": 1.8, "ec": style.LINES[1]}),
        (reach, {"lw": 0.9, "ec": style.PALE, "ls": (0, (5, 3))}),
    ):
        axes.add_patch(Circle(spot, radius, fill=False, zorder=4, **how))


def _line(axes, x, values, fluid, column: int) -> None:
    for chosen, colour in ((~fluid, style.WALLS), (fluid, style.LINES[0])):
        axes.plot(x[chosen], values[chosen], ".", ms=6, mew=0, color=colour)
    axes.plot(x[column], values[column], "o", ms=11, mfc="none", mec=style.LINES[1], mew=1.8)
