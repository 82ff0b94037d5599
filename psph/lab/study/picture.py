"""Error against seconds: the work–precision diagram."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.patheffects import withStroke
from matplotlib.ticker import Locator, LogLocator, MaxNLocator, NullLocator

from psph.lab.study.fit import Estimate
from psph.lab.study.ladder import SPACING, toml
from psph.lab.study.numbers import NumberLadder
from psph.output.pictures import style

WIDTH, HEIGHT = 6.4, 4.0
"""Of the diagram, inches."""

LABELLED = 12
"""Points up to which all have their spacing written beside them; of more those of the first curve."""


def draw(
    path: Path,
    title: str,
    subtitle: str,
    curves: Sequence[tuple[str, list[dict]]],
    front: Sequence[dict],
    goal: tuple[float, dict] | None,
) -> Path:
    """Write the diagram: each of ``curves`` a named list of rows, the Pareto ``front`` beneath.

    ``goal``: an error to reach and the cheapest row that does.
    """
    top = style.TOP + 0.2
    with style.look():
        figure = style.sheet(style.LEFT + WIDTH + 2.2, top + HEIGHT + style.BOTTOM, title, subtitle)
        axes = style.panel(figure, style.LEFT, top, WIDTH, HEIGHT)
        axes.set_xscale("log")
        axes.set_yscale("log")
        if len(front) > 1:
            x, y = zip(*((r["seconds"], 100.0 * r["error_l2"]) for r in front))
            axes.plot(x, y, color=style.WALLS, lw=6, solid_capstyle="round", zorder=1, label="best choices")
        few = sum(len(rows) for _, rows in curves) <= LABELLED
        for k, (name, rows) in enumerate(curves):
            colour = style.LINES[k % len(style.LINES)]
            x = [r["seconds"] for r in rows]
            y = [100.0 * r["error_l2"] for r in rows]
            axes.plot(x, y, "o-", color=colour, ms=4, label=name, zorder=3)
            for row in rows if few or k == 0 else ():
                _label(axes, row, colour if few and len(curves) > 1 else style.PALE, below=k % 2 == 1)
        if goal:
            error, row = goal
            axes.axhline(100.0 * error, color=style.INK, lw=0.9, ls=(0, (5, 3)), zorder=2)
            axes.plot(
                [row["seconds"]],
                [100.0 * row["error_l2"]],
                "o",
                ms=11,
                mfc="none",
                mec=style.INK,
                label=f"cheapest within {100.0 * error:g} %",
                zorder=4,
            )
        axes.margins(0.12)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(_numbers(*axis.get_view_interval()))
            axis.set_major_formatter(lambda number, _: f"{number:g}")
            axis.set_minor_locator(NullLocator())
        axes.grid(color=style.WALLS, lw=0.4)
        axes.set_xlabel("seconds")
        axes.set_title("error, L2 (%)", loc="left", size=9, weight="bold")
        axes.legend(loc="upper left", bbox_to_anchor=(1.03, 1.0))
    return style.save(figure, path)


def draw_number(path: Path, title: str, ladders: Sequence[tuple[str, NumberLadder]]) -> Path:
    """Write the values of a number over the spacing, with bars for their reach, and its limit at zero spacing
    with its interval; of several ``ladders`` each has a name."""
    (_, first), several = ladders[0], len(ladders) > 1
    theory, legend = first.theory, several or first.theory is not None
    right, top = 2.2 if legend else style.RIGHT, style.TOP + 0.2
    with style.look():
        figure = style.sheet(style.LEFT + WIDTH + right, top + HEIGHT + style.BOTTOM, title, first.of)
        axes = style.panel(figure, style.LEFT, top, WIDTH, HEIGHT)
        if theory is not None:
            axes.axhline(theory, color=style.INK, lw=0.9, ls=(0, (5, 3)), zorder=1, label="theory")
        for k, (name, found) in enumerate(ladders):
            colour = style.LINES[k % len(style.LINES)]
            bars = [0.0 if reach != reach else reach for reach in found.reaches]
            axes.errorbar(
                found.spacings, found.values, bars, fmt="o-", ms=4, capsize=3, color=colour, label=name
            )
            if found.limit:
                _limit(axes, found.limit.value, colour if several else style.LINES[1])
        axes.set_xlim(left=-0.03 * max(max(found.spacings) for _, found in ladders))
        axes.margins(y=0.12)
        axes.grid(color=style.WALLS, lw=0.4)
        axes.set_xlabel("spacing (m); the limit at 0")
        axes.set_title(f"{first.name} ({first.unit})", loc="left", size=9, weight="bold")
        if legend:
            axes.legend(loc="upper left", bbox_to_anchor=(1.03, 1.0))
    return style.save(figure, path)


def _limit(axes, value: Estimate, colour: str) -> None:
    """A limit at zero spacing, with its interval where that is known."""
    known = value.high == value.high
    reach = [[value.value - value.low], [value.high - value.value]] if known else None
    axes.errorbar([0.0], [value.value], reach, fmt="D", ms=5, capsize=3, color=colour)


def _label(axes, row: dict, colour: str, below: bool) -> None:
    """The spacing of a run beside its point, to the right above or to the left ``below``: errors fall along a
    curve."""
    if SPACING not in row:
        return
    text = axes.annotate(
        f"dx {toml(row[SPACING])}",
        (row["seconds"], 100.0 * row["error_l2"]),
        xytext=(-5, -11) if below else (5, 5),
        ha="right" if below else "left",
        textcoords="offset points",
        size=8,
        color=colour,
        zorder=5,
    )
    text.set_path_effects([withStroke(linewidth=3, foreground="white")])


def _numbers(low: float, high: float) -> Locator:
    """Numbers along a logarithmic axis from ``low`` to ``high``: some even where it is far from a decade."""
    if high < 2.0 * low:
        return MaxNLocator(4, steps=[1, 2, 5, 10])
    return LogLocator(subs=(1.0, 2.0, 5.0) if high > 10.0 * low else (1.0, 1.5, 2.0, 3.0, 5.0, 7.0))
