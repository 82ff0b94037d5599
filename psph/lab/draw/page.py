"""The page of a scene that turns in the browser."""

from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.fields import FLUID
from psph.lab.draw.marks import Mark
from psph.lab.draw.picture import colour_of
from psph.lab.draw.start import AtStart
from psph.lab.report.turning import EYE, short
from psph.output.pictures import style
from psph.output.pictures.walls import surface
from psph.scene.layout import Layout
from psph.scene.parts.part import Part

PARTICLES, TRIANGLES = 12_000, 60_000
"""Of a part, at most: a browser turns them without a pause."""

WIDE, HIGH = 1000, 710
"""Of the view, pixels."""


def turning(layout: Layout, start: AtStart, marks: list[Mark]):
    """A figure of plotly: parts and marks that a click on their names hides and shows."""
    import plotly.graph_objects as go

    traces = [*_parts(go, layout, start), *_marks(go, layout.dimensions, marks)]
    figure = go.Figure(traces)
    figure.update_layout(
        template="plotly_white",
        height=HIGH,
        margin={"l": 10, "r": 0, "t": 20, "b": 20},
        legend={"itemsizing": "constant"},
    )
    if layout.dimensions == 3:
        titles = {f"{axis}axis": {"title": {"text": f"{axis} (m)"}} for axis in AXES}
        figure.update_scenes(aspectmode="data", camera={"eye": EYE}, **titles)
    else:
        figure.update_xaxes(title="x (m)")
        figure.update_yaxes(title="y (m)", scaleanchor="x")
    return figure


def _parts(go, layout: Layout, start: AtStart) -> Iterator:
    groups = start.frame["group"]
    colours = iter(style.LINES * len(start.parts))
    for number, part in enumerate(start.parts):
        rows = np.flatnonzero(groups == number)
        free = len(rows) and start.frame["kind"][rows[0]] == FLUID
        colour = next(colours) if free else style.WHOLE if part.moves_whole else style.WALLS
        label = {"name": f"{part.key} ({len(rows):,})", "legendgroup": part.name, "showlegend": True}
        faces = _faces(layout, part) if not free else None
        if faces is not None:
            x, y, z = short(faces.reshape(-1, 3)).T
            i, j, k = np.arange(len(x)).reshape(-1, 3).T
            opacity = 0.9 if part.moves_whole else 0.45
            yield go.Mesh3d(
                x=x, y=y, z=z, i=i, j=j, k=k, color=colour, opacity=opacity, hoverinfo="name", **label
            )
            continue
        places = start.frame["position"][rows[:: -(-len(rows) // PARTICLES) or 1]]
        yield _scatter(go, places, mode="markers", marker={"size": 3, "color": colour}, **label)


def _faces(layout: Layout, part: Part) -> np.ndarray | None:
    """The surface of a part in 3D, drawn coarsely enough; None where that is too fine, or flat."""
    if layout.dimensions < 3 or not part.drawn:
        return None
    shape, dx = part.shape, layout.spacing
    for coarse in (2.0, 4.0, 8.0, 16.0):
        faces = surface(shape, coarse * dx, np.array(layout.lower), np.array(layout.upper))
        if 0 < len(faces) <= TRIANGLES:
            return faces
    return None


def _marks(go, dimensions: int, marks: list[Mark]) -> Iterator:
    gap = np.full((1, dimensions), np.nan)
    for mark in (one for one in marks if not one.matter):
        points = np.concatenate([part for line in mark.lines for part in (line, gap)])
        colour = colour_of(mark)
        group = {"legendgroup": mark.label, "name": mark.label}
        how = {"line": {"color": colour, "width": 3}, "marker": {"size": 3, "color": colour}}
        dots = all(len(line) == 1 for line in mark.lines)
        yield _scatter(go, points, mode="markers" if dots else "lines", **how, **group)
        text = {"text": [mark.label], "textfont": {"color": colour, "size": 11}, "showlegend": False}
        yield _scatter(go, mark.middle[None], mode="text", **text, **group)


def _scatter(go, places: np.ndarray, **more):
    """Points (n, dim), m, on the axes that there are."""
    axes = dict(zip(AXES, short(places).T))
    axes.setdefault("y", np.zeros(len(places)))
    kind = go.Scatter3d if len(axes) == 3 else go.Scatter
    return kind(**axes, hoverinfo="name+x+y" + "+z" * (len(axes) == 3), **more)
