"""Drawings of what words say badly: ``python docs/site/figures.py FOLDER`` (docs/images)."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.patches import Circle, Polygon, Rectangle  # noqa: E402
from matplotlib.transforms import Affine2D  # noqa: E402

WATER, WALL, INK = "#9ecae1", "#969696", "#08306b"
ARROW = {"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0}
TO = ARROW | {"arrowstyle": "->"}
AT = {"arrowstyle": "-", "color": INK, "lw": 0.6}
ROLL = 15
"""Degrees by which the tank of :func:`frames` has turned."""


def _axes(width: float, height: float, *, columns: int = 1) -> tuple[plt.Figure, list[Axes]]:
    figure, axes = plt.subplots(1, columns, figsize=(width, height), squeeze=False, layout="constrained")
    for ax in axes[0]:
        ax.set_aspect("equal")
        ax.axis("off")
    return figure, list(axes[0])


def _said(ax: Axes, text: str, at: tuple[float, float], of: tuple[float, float]) -> None:
    ax.annotate(text, xy=of, xytext=at, color=INK, fontsize=8, ha="center", va="center", arrowprops=AT)


def walls() -> plt.Figure:
    """A corner of a tank: layers, faces, and where the water begins."""
    figure, [ax] = _axes(6.0, 3.4)
    x, y = np.meshgrid(np.arange(-3, 9) + 0.5, np.arange(-3, 6) + 0.5)
    wet = (x > 0) & (y > 0)
    ax.scatter(x[wet & (y < 4)], y[wet & (y < 4)], s=110, color=WATER)
    ax.scatter(x[~wet], y[~wet], s=110, color=WALL)
    ax.plot([0, 0, 9], [6, 0, 0], color=INK, lw=1.5)
    ax.plot([0, 9], [4, 4], color=INK, lw=0.8, ls=":")
    ax.annotate("", xy=(-3, -3.5), xytext=(0, -3.5), arrowprops=ARROW)
    ax.text(-1.5, -4.2, "three layers: 3 dx", color=INK, fontsize=8, ha="center")
    ax.annotate("", xy=(5, 4.6), xytext=(6, 4.6), arrowprops=ARROW)
    ax.text(5.5, 5.0, "dx", color=INK, fontsize=8, ha="center")
    _said(ax, "face of the wall:\nhalf a spacing from both rows", (13.2, 1.6), (9.0, 0.0))
    _said(ax, "free surface", (11.4, 4.0), (9.0, 4.0))
    _said(ax, "dry wall:\nbears no pressure", (-5.2, 5.0), (-1.4, 5.4))
    _said(ax, "corner: belongs to the wall", (-6.2, -1.6), (-2.7, -1.5))
    ax.set(xlim=(-8.8, 17.0), ylim=(-4.6, 6.2))
    return figure


def gauges() -> plt.Figure:
    """A level, a run-up, a sensor, a point and a flow section in a flume with a slope."""
    figure, [ax] = _axes(7.2, 2.9)
    surface = [(0, 2.0), (1, 2.2), (2, 2.0), (3, 1.8), (4, 2.05), (5, 2.2), (6.2, 2.3), (7.4, 2.6)]
    ax.add_patch(Polygon([(0, 0), *surface, (4.4, 0)], color=WATER))
    ground = [(10, 4.9), (10.4, 4.9), (10.4, -0.3), (-0.3, -0.3), (-0.3, 4), (0, 4), (0, 0)]
    ax.add_patch(Polygon([(4.4, 0), *ground], color=WALL))
    ax.plot([2, 2], [0, 3.6], color=INK, lw=1.2)
    _said(ax, "top", (2.6, 3.7), (2.0, 3.6))
    _said(ax, "foot", (2.6, 0.3), (2.0, 0.0))
    ax.annotate("", xy=(1.8, 0), xytext=(1.8, 2.02), arrowprops=ARROW)
    ax.text(1.7, 1.0, "level", color=INK, fontsize=8, ha="right", va="center")
    ax.plot([5.2, 9.0], [0.7, 4.02], color=INK, lw=1.2)
    _said(ax, "foot", (5.6, 0.2), (5.2, 0.7))
    _said(ax, "top", (9.5, 4.1), (9.0, 4.02))
    ax.annotate("", xy=(5.0, 0.95), xytext=(7.2, 2.87), arrowprops=ARROW)
    ax.text(5.9, 2.55, "run_up", color=INK, fontsize=8, ha="right", va="center")
    ax.plot([0, 0], [0.9, 1.3], color="#cb181d", lw=4)
    _said(ax, "sensor: position,\ndiameter", (-1.9, 1.1), (0.0, 1.1))
    ax.plot([3.4, 3.4], [0, 2.6], color=INK, lw=1.0, ls="--")
    _said(ax, "flow: lower", (4.5, 0.35), (3.4, 0.02))
    _said(ax, "upper", (4.0, 2.8), (3.4, 2.6))
    ax.add_patch(Circle((0.8, 0.6), 0.08, color=INK))
    _said(ax, "point", (1.0, 0.2), (0.8, 0.6))
    ax.set(xlim=(-3.4, 10.5), ylim=(-0.4, 4.3))
    return figure


def frames() -> plt.Figure:
    """The same tank twice: it moves in a frame that rests, and it rests in a frame that moves."""
    figure, axes = _axes(6.4, 2.6, columns=2)
    rise = 1.5 * np.tan(np.radians(ROLL))
    for ax, roll, title, gravity in zip(axes, (ROLL, 0), ("walls.tank.motion", "frame.motion"), ("g", "Rᵀg")):
        turn = Affine2D().rotate_deg(roll) + ax.transData
        ax.add_patch(Rectangle((-1.6, -0.9), 3.2, 1.8, fill=False, ec=WALL, lw=5, transform=turn))
        water = [(-1.5, -0.82), (-1.5, rise), (1.5, -rise), (1.5, -0.82)]
        ax.add_patch(Polygon(water, color=WATER, transform=turn))
        down = Affine2D().rotate_deg(roll - ROLL).transform((0.0, -0.8))
        ax.annotate("", xy=down, xytext=(0, 0), arrowprops=TO)
        ax.text(0.12, -0.5, gravity, color=INK, fontsize=9)
        for end, name in (((-1.3, -1.5), "x"), ((-2.3, -0.5), "y")):
            ax.annotate("", xy=end, xytext=(-2.3, -1.5), arrowprops=TO)
            ax.text(end[0] + 0.12, end[1], name, color=INK, fontsize=8, va="center")
        ax.set_title(title, fontsize=9, family="monospace", color=INK)
        ax.set(xlim=(-2.5, 2.2), ylim=(-1.7, 1.5))
    return figure


FIGURES = {"figure_walls": walls, "figure_gauges": gauges, "figure_frames": frames}


def draw(folder: Path) -> list[Path]:
    """Draw all into a folder; their files."""
    files = []
    for name, make in FIGURES.items():
        figure = make()
        files.append(folder / f"{name}.png")
        figure.savefig(files[-1], dpi=110, metadata={"Software": None})
        plt.close(figure)
    return files


if __name__ == "__main__":
    print(*draw(Path(sys.argv[1])))
