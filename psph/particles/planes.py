"""Particles that have crossed a mirror."""

from collections.abc import Iterable

from psph.composition.mirrors import Plane
from psph.fields import MATRIX, SYMMETRIC, VECTOR


def bring_back(store, planes: Iterable[Plane], free: int) -> None:
    """A particle of ``store`` that has crossed a plane changes places with its image.

    Seen from the particles around it nothing changes: its image stood where it comes to stand.  Those of
    groups from number ``free`` on stay where their motion has them.
    """
    for plane in planes:
        x = store["position"][plane.axis][store.inner]
        crossed = ((x - plane.at) * plane.side > 0.0) & (store.group[store.inner] < free)
        if crossed.any():
            x[crossed] = 2.0 * plane.at - x[crossed]
            for row in _odd_rows(store, plane.axis):
                store.data[row, store.inner][crossed] *= -1.0


def _odd_rows(store, axis: int) -> Iterable[int]:
    """The rows of components that a mirror across ``axis`` turns round."""
    dimensions = store.dimensions
    full = [(d, e) for d in range(dimensions) for e in range(dimensions)]
    shapes = {VECTOR: [(d,) for d in range(dimensions)], MATRIX: full}
    shapes[SYMMETRIC] = [(d, e) for d, e in full if d <= e]
    for name, field in store.fields.items():
        if field.composed and name not in ("position", "listed_position"):
            for row, axes in zip(store.rows[name], shapes[field.shape]):
                if axes.count(axis) == 1:
                    yield row
