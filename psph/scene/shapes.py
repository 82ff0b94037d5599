"""Which points lie inside a shape of a case."""

from collections.abc import Sequence

import numpy as np

from psph.case.shapes import Shape
from psph.scene.forms.form import ASKEW, Corner, Grid
from psph.scene.forms.make import form_of

__all__ = ["Corner", "Grid", "bounds", "inside", "shown"]


def inside(shape: Shape, grid: Grid, tolerance: float) -> np.ndarray:
    """True where a point of ``grid`` lies in the shape; broadcasts like the grid.

    ``tolerance`` (m, far below the spacing) settles points on an edge in spite of rounding: a
    straight edge keeps its points on the low side of the shape, so that two shapes with a common
    edge share no point and leave none out; a round edge keeps none.
    """
    form = form_of(shape)
    return form.holds(grid, tolerance * ASKEW[: form.dimensions], tolerance)


def bounds(shape: Shape) -> tuple[Corner, Corner]:
    """Lowest and highest corner of a box around the shape, m."""
    return form_of(shape).bounds


def shown(x: Sequence[float]) -> str:
    """A point in a message."""
    return f"[{', '.join(f'{value:.6g}' for value in x)}]"
