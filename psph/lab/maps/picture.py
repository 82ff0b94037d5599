"""The map as a picture: kernels over h/dx, the colour is the growth."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from psph.lab.maps.survey import SurveyRow
from psph.lab.maps.tables import UNIT
from psph.output.pictures import style
from psph.theory.stability import STATES
from psph.theory.stability.windows import SMOOTHINGS, STEP

WIDTH, ROW, GAP, BAR = 5.6, 0.24, 0.55, 0.14
"""Of a panel, of a kernel in it, between panels, of the bar of colours, inches."""

SLOW, FAST = 0.03, 3.0
"""Growth at the ends of the colours, √(|P|/ρ)/dx."""

COLOURS = LinearSegmentedColormap.from_list("growth", ["#fff3e0", "#f5b041", "#d55e00", "#5b1a00"])
STABLE = style.LINES[0]


def draw(path: Path, rows: Sequence[SurveyRow], subtitle: str) -> Path:
    """Write the picture of a map."""
    norm = LogNorm(SLOW, FAST)
    kernels = list(dict.fromkeys(row.kernel for row in rows))
    tall, top, left = ROW * len(kernels), style.TOP + 0.35, style.LEFT + 0.4
    height = top + len(STATES) * (tall + GAP) - GAP + style.BOTTOM
    with style.look():
        figure = style.sheet(
            left + WIDTH + style.RIGHT,
            height,
            "Which lattices hold, and how fast the others fall apart",
            subtitle,
        )
        for k, state in enumerate(STATES):
            mine = [row for row in rows if row.state == state]
            _panel(figure, left, top + k * (tall + GAP), tall, mine, norm, k == len(STATES) - 1)
        _bar(figure, left + WIDTH + 0.25, top, height - top - style.BOTTOM, norm)
    return style.save(figure, path)


def _panel(
    figure: Figure, left: float, top: float, tall: float, rows: list[SurveyRow], norm, last: bool
) -> None:
    axes = style.panel(figure, left, top, WIDTH, tall)
    rates = np.array([[one.rate for one in row.found] for row in rows])
    stable = np.array([[one.stable for one in row.found] for row in rows])
    across = np.append(SMOOTHINGS, SMOOTHINGS[-1] + STEP) - STEP / 2
    down = np.arange(len(rows) + 1)
    look = {"edgecolors": "white", "linewidth": 0.6}
    axes.pcolormesh(
        across,
        down,
        np.ma.masked_array(np.maximum(rates, SLOW), stable),
        norm=norm,
        cmap=COLOURS,
        **look,
    )
    axes.pcolormesh(
        across,
        down,
        np.ma.masked_array(np.ones_like(rates), ~stable),
        vmin=0,
        vmax=1,
        cmap=LinearSegmentedColormap.from_list("stable", [STABLE, STABLE]),
        **look,
    )
    axes.set_ylim(len(rows), 0)
    axes.set_yticks(down[:-1] + 0.5, [row.kernel for row in rows])
    axes.tick_params(axis="y", length=0)
    axes.spines[:].set_visible(False)
    style.ticks(axes.xaxis, 10)
    axes.tick_params(labelbottom=last)
    axes.set_title(f"under {rows[0].state}", loc="left", size=9, weight="bold")
    if last:
        axes.set_xlabel("h/dx")
    else:
        axes.legend(
            handles=[Patch(color=STABLE, label="stable")],
            loc="lower right",
            bbox_to_anchor=(1, 1.05),
            handlelength=1.0,
            handleheight=1.0,
        )


def _bar(figure: Figure, left: float, top: float, tall: float, norm) -> None:
    axes = style.panel(figure, left, top, BAR, tall)
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), cax=axes, extend="min", extendfrac=0.03)
    bar.outline.set_visible(False)
    axes.yaxis.set_ticks([0.03, 0.1, 0.3, 1.0, 3.0])
    axes.yaxis.set_major_formatter(lambda number, _: f"{number:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    bar.set_label(f"fastest growth ({UNIT})")
