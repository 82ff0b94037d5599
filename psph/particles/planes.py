"""Particles that have crossed a mirror."""

from collections.abc import Iterable

from psph.composition.mirrors import Plane
from psph.fields import Place, Stress, StressUnderWeight, indices


def bring_back(store, planes: Iterable[Plane], free: int) -> None:
    """A particle of ``store`` that has crossed a plane changes places with its image.

    Seen from the particles around it nothing changes: its image stood where it comes to stand.  Along a plane
    that sticks it keeps its own velocity.  Those of groups from number ``free`` on stay where their motion
    has them.
    """
    # Owned particles alone: a ghost is brought back by its owner, before the halo shows it.
    for plane in planes:
        x = store["position"][plane.axis][store.inner]
        crossed = ((x - plane.at) * plane.side > 0.0) & (store.group[store.inner] < free)
        if crossed.any():
            x[crossed] = 2.0 * plane.at - x[crossed]
            for row in _odd_rows(store, plane):
                store.data[row, store.inner][crossed] *= -1.0


def _odd_rows(store, plane: Plane) -> Iterable[int]:
    """The rows of components that a mirror turns round; behind one that sticks a stress goes on."""
    shapes = indices(store.dimensions)
    for name, field in store.fields.items():
        goes_on = field.image is Place or field.image in (Stress, StressUnderWeight) and plane.sticks
        if field.composed and not goes_on:
            for row, axes in zip(store.rows[name], shapes[field.shape]):
                if axes.count(plane.axis) % 2:
                    yield row
