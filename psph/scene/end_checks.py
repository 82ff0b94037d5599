"""What `check` says of the open ends of a scene."""

from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.scene.ends import groups_of
from psph.scene.layout import NONE
from psph.scene.parts.end import rows_of, rows_reached
from psph.scene.shapes import shown


def end_faults(scene) -> Iterator[str]:
    """Ends through which nothing can come as it is told."""
    layout, census = scene.layout, scene.census
    for name, end in layout.case.ends.items():
        sites = int(census.sizes[list(groups_of(layout, name))].sum())
        if not sites and end.filled is not None:
            yield f"ends.{name}.span: no lattice site lies behind it that no wall holds; make it larger"
        elif not sites and end.given in ("velocity", "flow", "pump"):
            yield (
                f"ends.{name}: no fluid stands in front of its plane, so nothing can come in; name it with "
                f'filled = "{next(iter(layout.case.fluids))}", or move the plane'
            )
        if end.pump and not scene.has_free_surface:
            yield (
                f"ends.{name}.pump: gives a speed and no pressure, so without a free surface nothing "
                "drives the flow; give a pressure at both ends"
            )
        if end.layers and end.layers < (needed := rows_reached(layout.case)):
            says = f"the kernel reaches over {needed} rows; give {needed} or more"
            yield f"ends.{name}.layers: {end.layers}: {says}"


def end_warnings(scene) -> Iterator[str]:
    """Ends whose sides nothing holds."""
    for name, end in scene.case.ends.items():
        if (open_at := _open_side(scene, name, end)) is not None:
            axis, site = open_at
            depth = rows_of(scene.case, end) * scene.spacing
            yield (
                f"ends.{name}: nothing holds what stands behind its plane at {shown(site)}, towards {axis}; "
                f"let walls go on for {depth:.3g} m behind it"
            )


def _open_side(scene, name: str, end) -> tuple[str, tuple[float, ...]] | None:
    """A direction across an end, and a site behind its plane, beside which there is nothing; None where all
    is held, but for what is above it."""
    layout = scene.layout
    numbers = groups_of(layout, name)
    for first, last in layout.lattice.chunks():
        held = layout.materials(first, last)
        grid = layout.lattice.grid(first, last)
        own = np.isin(held, numbers)
        if not own.any():
            continue
        places = np.stack([np.broadcast_to(x, own.shape)[own] for x in grid], axis=1)
        for d in (d for d in range(layout.dimensions) if d != end.axis):
            for sign in (-1.0, 1.0):
                if layout.up[d] * sign > 0.0 or _repeats(layout, d):
                    continue
                beside = places.copy()
                beside[:, d] += sign * layout.spacing
                free = layout.held([*beside.T], (len(beside),)) == NONE
                free &= ~_mirrored(layout, d, beside[:, d])
                if free.any():
                    return f"{'+' if sign > 0 else '-'}{AXES[d]}", tuple(places[free][0].tolist())
    return None


def _repeats(layout, d: int) -> bool:
    return layout.periods[d] is not None


def _mirrored(layout, d: int, x: np.ndarray) -> np.ndarray:
    """Whether coordinates ``x`` (n,) along an axis are beyond a mirror, m."""
    beyond = np.zeros(len(x), bool)
    for plane in layout.mirror_planes:
        if plane.axis == d:
            beyond |= np.abs(x - plane.at) < layout.spacing
    return beyond
