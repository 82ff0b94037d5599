"""The view of a run that turns in the browser: particles of some frames, coloured by speed."""

import math
import tomllib

import numpy as np

from psph.case.keys import AXES
from psph.fields import WALL
from psph.output.pictures import style
from psph.output.pictures.groups import first_whole, wholes_of
from psph.output.pictures.once import once, reads_of
from psph.output.pictures.view import spread
from psph.output.reader import Run

FRAMES, PARTICLES, WALL_PARTICLES = 8, 8000, 4000
"""Frames, particles of a frame, and of its walls, at most: a browser turns them without a pause."""

DOTS, ALIKE = (1.0, 20.0), 0.01
"""Diameters of the least and the largest dots, and how much of their width particles may differ by that have
one."""

LINE = {"color": style.INK, "width": 2}
"""Of bodies."""

GREY = "#9aa1ab"
"""Of walls."""

EYE = {"x": -0.7, "y": -2.0, "z": 1.1}
"""From the front, the left and above, as the pictures in 3D."""


def turning(run: Run):
    """The view with its slider over time, a figure of plotly."""
    import plotly.graph_objects as go

    shown = spread(len(run.times), FRAMES)
    case = tomllib.loads(run.case_text)
    frames = [_particles(run, k, case) for k in shown]
    fastest = max((speed.max(initial=0.0) for _, speed, _ in frames), default=1.0) or 1.0
    usual = float(np.median(frames[-1][2])) if len(frames[-1][2]) else 1.0
    rigid = _Rigid(run, shown, case)
    dimensions = rigid.standing.shape[1]
    kind = go.Scatter3d if dimensions == 3 else go.Scattergl
    size = 3 if dimensions == 3 else 5

    def fluid(k: int):
        places, speed, width = frames[k]
        colours = {"color": short(speed), "cmin": 0.0, "cmax": fastest, "colorscale": "Viridis"}
        wide = np.clip(size * width / usual, *DOTS)
        wide = size if np.ptp(width / usual) < ALIKE else short(wide)
        return _points(kind, places, wide, **colours, colorbar={"title": "speed (m/s)"})

    def walls(places: np.ndarray):
        return _points(kind, places, size - 1, color=GREY, opacity=0.25 if dimensions == 3 else 1.0)

    def seen(k: int) -> list:
        strung = _lines(run, shown[k])
        return [
            fluid(k),
            *([] if strung is None else [kind(**_axes(strung), mode="lines", line=LINE)]),
            *([walls(rigid.walls[k])] if rigid.has_moving_walls else []),
            *([_points(kind, rigid.wholes[k], size, color=style.WHOLE)] if rigid.has_wholes else []),
        ]

    count = max(len(seen(k)) for k in range(len(frames)))
    figure = go.Figure(
        [walls(rigid.standing), *seen(-1)],
        frames=[
            go.Frame(data=seen(k), traces=list(range(1, 1 + count)), name=str(k)) for k in range(len(frames))
        ],
    )
    steps = [
        {
            "label": f"{run.times[shown[k]]:.3g} s",
            "method": "animate",
            "args": [[str(k)], {"mode": "immediate", "frame": {"duration": 0, "redraw": True}}],
        }
        for k in range(len(frames))
    ]
    figure.update_layout(
        sliders=[{"steps": steps, "active": len(frames) - 1, "currentvalue": {"prefix": "time: "}}],
        margin={"l": 10, "r": 0, "t": 40, "b": 110},
        height=710,
        showlegend=False,
        template="plotly_white",
    )
    if dimensions == 3:
        titles = {f"{axis}axis": {"title": {"text": f"{axis} (m)"}} for axis in AXES}
        figure.update_scenes(aspectmode="data", camera={"eye": EYE}, **titles)
    else:
        figure.update_yaxes(scaleanchor="x", title="y (m)")
        figure.update_xaxes(title="x (m)")
    return figure


def _points(kind, places: np.ndarray, size: int | np.ndarray, opacity: float = 1.0, **marker):
    marker |= {"size": size, "opacity": opacity}
    return kind(**_axes(places), mode="markers", marker=marker, hoverinfo="skip")


def _axes(places: np.ndarray) -> dict[str, np.ndarray]:
    """Places (n, dim) by the names that plotly has for their axes."""
    axes = {axis: short(places[:, d]) for d, axis in enumerate(AXES[: places.shape[1]])}
    return axes if len(axes) > 1 else {**axes, "y": np.zeros(len(places))}


def _lines(run: Run, k: int) -> np.ndarray | None:
    """Points of all lines of bodies in a frame (n, dim), with gaps between; None of a run that had none."""
    if not (first := run.lines(0)):
        return None
    gap = np.full_like(next(iter(first.values()))[0][:1], np.nan)
    return np.concatenate([gap, *(part for points, _ in run.lines(k).values() for part in (points, gap))])


def _particles(run: Run, k: int, case: dict) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places, speeds and widths, m, of all but walls in a frame, no more than a browser takes."""
    frame = once(run.frame(k, "position", "velocity", *reads_of(case, run.fields)), case)
    chosen = _some(np.flatnonzero(frame["kind"] != WALL), PARTICLES)
    speed = np.linalg.norm(frame["velocity"][chosen], axis=1)
    return frame["position"][chosen], speed, frame["width"][chosen]


class _Rigid:
    """Places (n, dim) of what is rigid: of walls that stand, and in each frame of moving ``walls`` and of
    ``wholes``."""

    def __init__(self, run: Run, shown, case: dict):
        self.has_wholes = bool(wholes_of(case))
        first = first_whole(case) if self.has_wholes else math.inf
        frames = [once(run.frame(k, "position", "kind", "group", "id"), case) for k in shown]
        moved = set().union(*(_moved(frames[0], frame) for frame in frames[1:]))
        moving = {group for group in moved if group < first}
        self.has_moving_walls = bool(moving)
        self.walls = [_chosen(frame, np.isin(frame["group"], [*moving])) for frame in frames]
        self.wholes = [_chosen(frame, frame["group"] >= first) for frame in frames]
        last = frames[-1]["group"]
        self.standing = _chosen(frames[-1], (last < first) & ~np.isin(last, [*moving]))


def _moved(before: dict, after: dict) -> set[int]:
    """The groups of what is rigid and does not stand where it stood."""
    _, was, now = np.intersect1d(before["id"], after["id"], return_indices=True)
    away = (before["position"][was] != after["position"][now]).any(axis=1)
    return set(after["group"][now][away & (after["kind"][now] == WALL)].tolist())


def _chosen(frame: dict, these: np.ndarray) -> np.ndarray:
    """Places of those of ``these`` that are rigid."""
    return frame["position"][_some(np.flatnonzero(these & (frame["kind"] == WALL)), WALL_PARTICLES)]


def _some(rows: np.ndarray, most: int) -> np.ndarray:
    return rows[:: -(-len(rows) // most) or 1]


def short(values: np.ndarray) -> np.ndarray:
    """With five digits of how far they lie apart: what a screen shows, in few bytes."""
    known = values[np.isfinite(values)]
    size = float(np.ptp(known) or np.abs(known).max()) if len(known) else 0.0
    rounded = values.round(5 - math.ceil(math.log10(size))) if size else values
    half = rounded.astype(np.float32)
    return half if np.abs(half[np.isfinite(values)] - known).max(initial=0.0) <= 1e-4 * size else rounded
