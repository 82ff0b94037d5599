"""What `check` says of the open ends of a scene."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from psph.case.courses import AcrossFace, Course
from psph.case.ends import LEVEL
from psph.case.keys import AXES
from psph.scene.end_columns import column_of
from psph.scene.end_levels import level_faults
from psph.scene.end_rides import ride_faults
from psph.scene.end_rows import across_up, raised, rows_behind
from psph.scene.ends import UNLIKE, groups_of, mean_of, unlike
from psph.scene.lattice import TOLERANCE
from psph.scene.layout import NONE
from psph.scene.moving import moving_parts
from psph.scene.parts.end import rows_of, rows_reached
from psph.scene.shapes import inside, shown

HELD = 0.5
"""Spacings that a wall may move and still hold what stands behind a plane."""

LEAST_MEAN = 1e-3
"""Part of its largest value below which the mean of a profile is none."""


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
        if end.given in ("pressure", LEVEL) and (height := beside(scene, name, end)) is not None:
            yield (
                f"ends.{name}.{end.given}: is that of layers, and fluids of different density stand beside "
                f"each other before its plane at {height:.4g} m; let them stand in layers, or give a velocity"
            )
        if sites and isinstance(end.profile, AcrossFace):
            yield from _flat_profile(scene, name, end)
        yield from ride_faults(scene, name, end)
        yield from level_faults(scene, name, end)
        if end.pump and not scene.has_free_surface:
            yield (
                f"ends.{name}.pump: gives a speed and no pressure, so without a free surface nothing "
                "drives the flow; give a pressure at both ends"
            )
        if end.layers and end.layers < (needed := rows_reached(layout.case)):
            says = f"the kernel reaches over {needed} rows; give {needed} or more"
            yield f"ends.{name}.layers: {end.layers}: {says}"


def beside(scene, name: str, end) -> float | None:
    """The height at which fluids of different density stand beside each other behind an end, m; else None."""
    groups = groups_of(scene.layout, name)
    box = scene.layout.parts[groups[0]].shape.form
    return column_of(scene, end, groups, np.array(box.lower), np.array(box.upper))[1]


def _flat_profile(scene, name: str, end) -> Iterator[str]:
    """A profile whose mean is nothing beside its values: it has no shape."""
    axis, half = AXES.index(end.profile.along), 0.5 * scene.spacing
    held = [n for n in groups_of(scene.layout, name) if scene.census.sizes[n]]
    ends = scene.census.lowest[held, axis].min() - half, scene.census.highest[held, axis].max() + half
    mean = mean_of(end.profile, *ends)
    if not abs(mean) > LEAST_MEAN * end.profile.largest:
        yield (
            f"ends.{name}.profile: {end.profile.file} has a mean of {mean:.3g} between {ends[0]:.4g} and "
            f"{ends[1]:.4g} m; its shape is by its mean, so give one that flows one way"
        )


def end_warnings(scene) -> Iterator[str]:
    """Ends whose sides nothing holds, or with fluid behind them, or that cannot let waves out."""
    for name, end in scene.case.ends.items():
        if end.waves == "out" and unlike(scene):
            yield (
                f"ends.{name}.waves: out: densities times speeds of sound of the fluids differ by more than "
                f"{UNLIKE:g}, so that no one answer fits all; waves come back"
            )
        if (heights := _above_water(scene, end)) is not None:
            low, water = heights
            yield (
                f"ends.{name}.span: begins at a height of {low:.4g} m, and fluid reaches {water:.4g} m, "
                "so that nothing passes before it rises there; let the span begin lower"
            )
        if (heights := _below_the_bed(scene, name, end)) is not None:
            low, bed = heights
            yield (
                f"ends.{name}.level: {low:.4g} m is below the bed behind its plane, at {bed:.4g} m, so that "
                "all of the fluid runs out; give a height above it, against gravity"
            )
        if (heights := _over_the_span(scene, name, end)) is not None:
            level, top = heights
            yield (
                f"ends.{name}.level: {level:.4g} m is above what the end reaches, to {top:.4g} m, so that "
                "water runs over it; let its span reach higher"
            )
        if (extent := _out_of_reach(scene, name, end)) is not None:
            low, high = extent
            yield (
                f"ends.{name}.at: {end.at:.4g} m, and fluids and walls stand from {low:.4g} to {high:.4g} m "
                f"along {AXES[end.axis]}, so that nothing may come to it; move the plane to the edge of the "
                "fluid"
            )
        if (found := _over_the_rim(scene, name, end)) is not None:
            level, axis, site = found
            yield (
                f"ends.{name}.level: {level:.4g} m is above what holds the fluid behind its plane towards "
                f"{axis}, at {shown(site)}, so that it runs over there; let walls reach higher"
            )
        if (body := _body_behind(scene, name)) is not None:
            yield (
                f"ends.{name}: {body} starts behind its plane, where a buffer stands that does not feel it; "
                "let it start in front"
            )
        if (site := _fluid_behind(scene, name, end)) is not None:
            yield (
                f"ends.{name}: fluid stands behind its buffer at {shown(site)} and stays there; move the "
                "plane to the edge of the fluid"
            )
        if (wall := _goes_away(scene, name, end)) is not None:
            yield (
                f"ends.{name}: {wall} holds what stands behind its plane and moves, and the plane does not; "
                f'let it go along with on = "{wall.partition(".")[2]}", or a wall at rest hold it'
            )
        if (open_at := _open_side(scene, name, end)) is not None:
            axis, site = open_at
            depth = rows_of(scene.case, end) * scene.spacing
            yield (
                f"ends.{name}: nothing holds what stands behind its plane at {shown(site)}, towards {axis}; "
                f"let walls go on for {depth:.3g} m behind it"
            )


def _above_water(scene, end) -> tuple[float, float] | None:
    """The heights, m, at which a span begins and up to which fluid stands or a level is given, where that is
    below; else None."""
    up = across_up(scene.layout, end)
    rising = int(np.abs(up).argmax())
    told = getattr(end.span, AXES[rising])
    if told is None or abs(up[rising]) < 1.0 or end.filled is not None:
        return None
    water = [scene.census.surface_of(n) for n in range(len(scene.case.fluids)) if scene.census.sizes[n]]
    water += [one.level for one in scene.case.ends.values() if isinstance(one.level, float)]
    water += [_levels(one)[1] for one in scene.case.ends.values() if isinstance(one.level, Course)]
    low = min(up[rising] * x for x in told)
    return (low, max(water)) if water and low >= max(water) - TOLERANCE * scene.spacing else None


def _below_the_bed(scene, name: str, end) -> tuple[float, float] | None:
    """The least level that an end is given and the height of the bed behind it, m, where that is above; else
    None."""
    if (rows := _rows(scene, name, end)) is None:
        return None
    low, half = _levels(end)[0], 0.5 * scene.spacing
    return (low, rows.heights[0] - half) if low < rows.heights[0] - half else None


def _over_the_span(scene, name: str, end) -> tuple[float, float] | None:
    """The largest level that an end is given and the height up to which it reaches, m, where that is lower
    and nothing lies upon it; else None."""
    if (rows := _rows(scene, name, end)) is None:
        return None
    level, top = _levels(end)[1], float(rows.heights[-1]) + 0.5 * scene.spacing
    upon = rows.sites[-1] + scene.spacing * rows.up
    free = scene.layout.held([*upon.T], (len(upon),)) == NONE
    return (level, top) if level > top + TOLERANCE * scene.spacing and free.any() else None


def _out_of_reach(scene, name: str, end) -> tuple[float, float] | None:
    """From where to where fluids and walls stand along the axis of an empty end, whose plane is beyond all of
    them; else None."""
    own, census = groups_of(scene.layout, name), scene.census
    if census.sizes[list(own)].any():
        return None
    ends = {number for one in scene.case.ends for number in groups_of(scene.layout, one)}
    others = [n for n, size in enumerate(census.sizes) if size and n not in ends]
    low = float(np.min(census.lowest[others, end.axis])) - 0.5 * scene.spacing
    high = float(np.max(census.highest[others, end.axis])) + 0.5 * scene.spacing
    return None if low <= end.at <= high else (low, high)


def _over_the_rim(scene, name: str, end) -> tuple[float, str, tuple[float, ...]] | None:
    """The largest level that an end is given, a direction across the end, and a site below that level beyond
    which there is nothing; None where all that may come to stand behind the plane is held."""
    if (rows := _rows(scene, name, end)) is None:
        return None
    layout, high = scene.layout, _levels(end)[1]
    filled = [row for row, height in zip(rows.sites, rows.heights) if height < high][rows.wet :]
    level = (d for d in range(layout.dimensions) if d != end.axis and not layout.up[d])
    for d, sign, row in product(level, (-1.0, 1.0), filled):
        beyond = row.copy()
        beyond[:, d] += sign * layout.spacing
        middle, half = 0.5 * (row[:, d].min() + row[:, d].max()), 0.5 * np.ptp(row[:, d])
        past = np.abs(beyond[:, d] - middle) > half + HELD * layout.spacing
        free = past & (layout.held([*beyond.T], (len(beyond),)) == NONE)
        free &= ~_mirrored(layout, d, beyond[:, d])
        if free.any() and not _repeats(layout, d):
            return high, f"{'+' if sign > 0 else '-'}{AXES[d]}", tuple(row[free][0].tolist())
    return None


def _body_behind(scene, name: str) -> str | None:
    """The key of a part that moves as a whole and has sites in the buffer of an end; None where none has."""
    layout = scene.layout
    box = layout.parts[groups_of(layout, name)[0]].shape
    for first, last in layout.lattice.chunks():
        grid = layout.lattice.grid(first, last)
        held = layout.materials(first, last)
        held = held[np.broadcast_to(inside(box, grid, TOLERANCE * layout.spacing), held.shape)]
        for number in np.unique(held[held != NONE]):
            if layout.parts[int(number)].moves_whole:
                return layout.parts[int(number)].key
    return None


def _rows(scene, name: str, end):
    """The rows behind an end that is given a level in numbers; None of any other."""
    groups = groups_of(scene.layout, name)
    if not isinstance(end.level, (float, Course)) or not groups:
        return None
    box = scene.layout.parts[groups[0]].shape.form
    corners = raised(scene.layout, end, np.array(box.lower), np.array(box.upper))
    return rows_behind(scene.layout, end, groups, *corners)


def _levels(end) -> tuple[float, float]:
    """The least and the largest level that an end is given, m."""
    return end.level.ends if isinstance(end.level, Course) else (end.level, end.level)


def _open_side(scene, name: str, end) -> tuple[str, tuple[float, ...]] | None:
    """A direction across an end, and a site behind its plane, beside which there is nothing; None where all
    is held, but for what is above it."""
    layout = scene.layout
    for d, sign, places, held in _beside(scene, name, end):
        if layout.up[d] * sign > 0.0 or _repeats(layout, d):
            continue
        free = (held == NONE) & ~_mirrored(layout, d, places[:, d] + sign * layout.spacing)
        if free.any():
            return f"{'+' if sign > 0 else '-'}{AXES[d]}", tuple(places[free][0].tolist())
    return None


def _beside(scene, name: str, end) -> Iterator[tuple[int, float, np.ndarray, np.ndarray]]:
    """For each direction across an end, an axis and a sign, its sites behind the plane (n, dim), m, and what
    is beside each (n,)."""
    layout = scene.layout
    numbers = groups_of(layout, name)
    for first, last in layout.lattice.chunks():
        own = np.isin(layout.materials(first, last), numbers)
        if not own.any():
            continue
        grid = layout.lattice.grid(first, last)
        places = np.stack([np.broadcast_to(x, own.shape)[own] for x in grid], axis=1)
        for d in (d for d in range(layout.dimensions) if d != end.axis):
            for sign in (-1.0, 1.0):
                beside = places.copy()
                beside[:, d] += sign * layout.spacing
                yield d, sign, places, layout.held([*beside.T], (len(beside),))


def _goes_away(scene, name: str, end) -> str | None:
    """The key of a wall that holds what stands behind an end, and moves; None where none does."""
    parts = (one for one in moving_parts(scene.census) if one[1] != f"walls.{end.on}")
    moving = {n: key for n, key, sweep in parts if sweep.way > HELD * scene.spacing}
    for _, _, _, held in _beside(scene, name, end) if moving else ():
        if found := sorted(set(held.tolist()) & set(moving)):
            return moving[found[0]]
    return None


def _fluid_behind(scene, name: str, end) -> tuple[float, ...] | None:
    """A place right behind the buffer of an end where fluid stands; None where there is none."""
    layout, numbers = scene.layout, groups_of(scene.layout, name)
    back = end.at - end.sign * (rows_of(scene.case, end) + 0.5) * scene.spacing
    for first, last in layout.lattice.chunks():
        own = np.isin(layout.materials(first, last), numbers)
        grid = [np.broadcast_to(x, own.shape)[own] for x in layout.lattice.grid(first, last)]
        grid[end.axis] = np.full_like(grid[end.axis], back)
        fluid = layout.flows(layout.held(grid, grid[0].shape))
        if fluid.any():
            return tuple(float(x[fluid][0]) for x in grid)
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
