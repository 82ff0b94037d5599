"""Particles that have crossed a mirror."""

from collections.abc import Iterable

from psph.composition.reflections import ABOVE, BELOW, Plane
from psph.fields import Moving, Place, Stress, StressUnderWeight, indices
from psph.particles.sizes import TooLarge


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
            if plane.motion:
                for name in (name for name, field in store.fields.items() if field.image is Moving):
                    store[name][plane.axis][store.inner][crossed] += 2.0 * plane.velocity[plane.axis]


def check_apart(planes: Iterable[Plane], reach: float) -> None:
    """Raise TooLarge where two ``planes`` across an axis are nearer than particles ``reach``, m: images of
    images would be seen."""
    pairs = ((one, other) for one in planes for other in planes if one.axis == other.axis)
    for low, high in (
        (one.at, other.at) for one, other in pairs if one.side == BELOW and other.side == ABOVE
    ):
        if high - low < reach:
            raise TooLarge(
                f"mirrors have come to {low:.4g} and {high:.4g} m, nearer to each other than particles "
                f"reach, {reach:.4g} m; let them stop before, or give more particles"
            )


def _odd_rows(store, plane: Plane) -> Iterable[int]:
    """The rows of components that a mirror turns round; behind one that sticks a stress goes on."""
    shapes = indices(store.dimensions)
    for name, field in store.fields.items():
        goes_on = field.image is Place or field.image in (Stress, StressUnderWeight) and plane.sticks
        if field.composed and not goes_on:
            for row, axes in zip(store.rows[name], shapes[field.shape]):
                if axes.count(plane.axis) % 2:
                    yield row
