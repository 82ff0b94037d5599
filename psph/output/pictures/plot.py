"""What ``plot`` draws of a run: a field at chosen times, the probes, the log, an overview; or a film."""

from collections.abc import Sequence
from pathlib import Path

from psph.output.pictures import charts, names, style
from psph.output.pictures.flat import Slice
from psph.output.pictures.show import Show
from psph.output.progress import with_progress
from psph.output.reader import Run


def plot(
    folder: Path,
    times: Sequence[float] | None = None,
    field: str | None = None,
    cut: Slice | None = None,
    smooth: bool = False,
    along: str | None = None,
    experiments: Sequence = (),
) -> list[Path]:
    """Draw ``field`` (default: psph.output.pictures.quantities.usual) at ``times`` (s; four over the run),
    probes, gauges, log and overview as PNG files.

    They stand in ``folder``; their paths are returned.  ``cut``, ``smooth``, ``along``: see :class:`Show`;
    ``experiments`` (psph.lab.study.beside) are drawn beside gauges.  Raises Refused if there is nothing
    to draw, no such field, or no means to draw it.
    """
    show = Show(Run(folder), times, field, cut, smooth, along)
    name, variant = show.quantity.name, show.panel.variant
    made = {
        names.name_of(name, variant, k): show.picture([k])
        for k in with_progress(show.chosen, "drawing", "pictures")
    }
    if column := charts.probe_charts(show.run, show.case):
        made[names.PROBES] = charts.picture(column, show.title, "probes")
    for gauge, column in charts.gauge_charts(show.run, show.case["space"]["dimensions"]).items():
        beside = charts.with_measured(column, gauge, experiments)
        made[names.GAUGE.format(gauge)] = charts.picture(beside, show.title, f"gauge {gauge}")
    if column := charts.log_charts(show.run, show.case["space"]["dimensions"]):
        made[names.LOG] = charts.picture(column, show.title, "log")
    made[names.OVERVIEW] = show.overview()
    return [style.save(figure, show.run.folder / name) for name, figure in made.items()]


def overview(folder: Path, times: Sequence[float] | None = None, field: str | None = None) -> Path:
    """Draw ``overview.png``: ``field`` at ``times`` side by side, below what probes read of it."""
    show = Show(Run(folder), times, field)
    return style.save(show.overview(), show.run.folder / names.OVERVIEW)


def film(
    folder: Path,
    path: Path | None,
    times: Sequence[float] | None = None,
    field: str | None = None,
    cut: Slice | None = None,
    smooth: bool = False,
    along: str | None = None,
) -> str:
    """Film ``field`` from the least to the greatest of ``times`` s, or all frames; what was made, in words.

    ``path`` ends with .gif or .mp4; without it the film stands in ``folder``.
    """
    from psph.output.pictures.film import film_of, kind_of

    kind_of(path)
    return film_of(Show(Run(folder), times, field, cut, smooth, along), path, times is None)
