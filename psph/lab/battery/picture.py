"""The battery as a picture: trials × schemes by verdict, and the last frames of the default scheme."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from psph.fields import FLUID
from psph.lab.battery.tables import cell, columns_of
from psph.lab.battery.trials import Trial
from psph.lab.battery.verdicts import BLEW_UP, FAILS, GOOD, HOLDS, REFUSED, VERDICTS, Row
from psph.output.pictures import style

PICTURE = "battery.png"

COLOURS = {
    GOOD: "#0072b2",
    HOLDS: "#9ecae1",
    FAILS: "#f5b041",
    BLEW_UP: "#d55e00",
    REFUSED: style.WALLS,
}
DARK = (GOOD, BLEW_UP)
"""Verdicts whose colour takes white letters."""

NAME, CELL, ROW, GAP, SNAPSHOT = 3.1, 0.92, 0.23, 0.4, 1.9
"""Width of the names and of a cell, height of a row, a gap, the edge of a snapshot, inches."""


def draw(path: Path, trials: Sequence[Trial], rows: Sequence[Row], ends: Iterable[tuple[str, dict]]) -> Path:
    """Write the picture; ``ends``: name and last frame of some runs."""
    columns, ends = columns_of(trials), list(ends)
    wide, tall = CELL * len(columns), ROW * len(trials)
    left, top = 0.3 + NAME, style.TOP + 0.45
    across = max(int((NAME + wide) / (SNAPSHOT + 0.15)), 1)
    deep = -(-len(ends) // across) * (SNAPSHOT + 0.35)
    with style.look():
        figure = style.sheet(
            left + wide + 0.3,
            top + tall + GAP + deep + 0.25,
            "What holds, and what does not",
            "each cell with what the trial is judged by; × or a loss with the time at which it ended a run",
        )
        _matrix(style.panel(figure, left, top, wide, tall), trials, columns, rows)
        for k, (name, frame) in enumerate(ends):
            down, along = divmod(k, across)
            _end(
                figure,
                0.3 + along * (SNAPSHOT + 0.15),
                top + tall + GAP + 0.2 + down * (SNAPSHOT + 0.35),
                name,
                frame,
            )
    return style.save(figure, path)


def _matrix(axes, trials: Sequence[Trial], columns: list[str], rows: Sequence[Row]) -> None:
    down = {trial.name: k for k, trial in enumerate(trials)}
    for row in rows:
        x, y = columns.index(row.column), down[row.trial]
        axes.add_patch(Rectangle((x, y), 1, 1, fc=COLOURS[row.verdict], ec="white", lw=1.5))
        axes.text(
            x + 0.5,
            y + 0.52,
            cell(row)[2:],
            ha="center",
            va="center",
            size=7.5,
            color="white" if row.verdict in DARK else style.INK,
        )
    axes.set_xlim(0, len(columns))
    axes.set_ylim(len(trials), 0)
    axes.set_xticks(np.arange(len(columns)) + 0.5, columns)
    names = [f"{trial.name}  ({trial.shown.replace('_', ' ')})" for trial in trials]
    axes.set_yticks(np.arange(len(trials)) + 0.5, names)
    axes.tick_params(length=0, labeltop=True, labelbottom=False, labelsize=8)
    axes.spines[:].set_visible(False)
    found = {row.verdict for row in rows}
    axes.legend(
        handles=[Patch(color=COLOURS[v], label=v) for v in VERDICTS if v in found],
        loc="upper left",
        bbox_to_anchor=(0, 0),
        borderaxespad=0.6,
        ncol=5,
        handlelength=1.0,
        handleheight=1.0,
    )


def _end(figure: Figure, left: float, top: float, name: str, frame: dict) -> None:
    """The particles of a frame, fluid coloured by its pressure."""
    axes = style.panel(figure, left, top, SNAPSHOT, SNAPSHOT)
    x, fluid = frame["position"][:, :2], frame["kind"] == FLUID
    edge = max(np.ptp(x[:, 0]), np.ptp(x[:, 1]), 1e-300)
    p = frame["pressure"][fluid]
    size = (72.0 * SNAPSHOT) ** 2 / max(len(x), 400) * 0.5
    axes.scatter(*x[~fluid].T, s=size, c=style.WALLS, lw=0)
    axes.scatter(
        *x[fluid].T, s=size, c=p, cmap="viridis", lw=0, vmin=np.percentile(p, 2), vmax=np.percentile(p, 98)
    )
    middle = 0.5 * (x.max(axis=0) + x.min(axis=0))
    axes.set_xlim(middle[0] - 0.52 * edge, middle[0] + 0.52 * edge)
    axes.set_ylim(middle[1] - 0.52 * edge, middle[1] + 0.52 * edge)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(name, loc="left", size=8)
