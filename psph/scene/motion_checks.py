"""What is said of walls, bodies and frames that move, and what they run into."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from psph.case.errors import dotted
from psph.case.keys import AXES, Table
from psph.case.motion import BUILT_IN, RADIANS
from psph.physics.motion import goes_free, is_rigid, moments
from psph.physics.rigid.motion import MotionPart, Rigid
from psph.scene.moving import frame_sweep, moved_on, moving_parts, taken_back
from psph.scene.scene import Scene
from psph.scene.sweeps import MOMENTS, Sweep

FARTHEST = 2e9
"""Spacings from 0 at most: farther out a coordinate does not tell a small part of one."""

LOOKS, LOOKED_AT = 100, 4000
"""Times at which walls that meet are looked for, and sites of a wall that are looked at."""

QUICK = 0.1
"""Part of the speed of sound above which a wall is said to be fast: it compresses the fluid by a tenth."""

FAR_OFF = 0.25
"""Part of a column's range that a spline may go beyond two rows; a sine in four rows a period goes 0.21."""


def motion_faults(scene: Scene) -> Iterator[str]:
    """Motions that leave what numbers can tell."""
    for _, key, sweep in moving_parts(scene.census):
        far = max(np.abs(sweep.lower).max(), np.abs(sweep.upper).max())
        if not far <= FARTHEST * scene.spacing:
            yield (
                f"{key}.motion: goes {far:.3g} m from 0, {far / scene.spacing:.2g} spacings, too far "
                "for double precision; correct its numbers, or give it an end"
            )


def motion_lines(scene: Scene) -> Iterator[str]:
    """What moves, in words, for `explain`."""
    tables: dict[str, Any] = {
        key: (sweep, scene.census.motions[n]) for n, key, sweep in moving_parts(scene.census)
    }
    if framed := frame_sweep(scene.layout):
        tables["frame"] = (framed, scene.frame)
    told = {".".join(loc): parts for loc, parts in scene.case.motions.items()}
    for key, (sweep, moved) in tables.items():
        parts = [_part_in_words(part) for part in told[f"{key}.motion"]]
        yield f"  motion      {key}: {'; then '.join(parts)}"
        yield (
            f"              at most {sweep.way:.3g} m from its start, {sweep.speed:.3g} m/s "
            f"({sweep.speed / scene.sound_speed:.2g} c), {sweep.acceleration:.3g} m/s2"
        )
        motion = getattr(moved, "motion", moved)  # of a body or clamp that one
        yield from (f"              {line}" for line in _turns_in_words(motion, scene.case.time.end))
        if sweep.jump > 0.0:
            yield f"              it begins at once with {sweep.jump:.3g} m/s"


def _turns_in_words(motion, end: float) -> Iterator[str]:
    """How far and how fast each part of a motion turns that does."""
    parts = motion.parts if isinstance(motion, Rigid) else ()
    for part in (one for one in parts if isinstance(one, MotionPart)):
        told = [part.law.ways(part.schedule, t) for t in moments(end, MOMENTS)]
        angle, rate = (max(abs(one[k][3]) for one in told) for k in (0, 1))
        if angle or rate:
            yield (
                f"turns by at most {angle:.3g} rad ({math.degrees(angle):.3g} degrees), at {rate:.3g} rad/s "
                f"({math.degrees(rate):.3g} degrees/s)"
            )


def _part_in_words(part) -> str:
    if part.way not in BUILT_IN:
        return part.way
    told = (
        f"{name} {_plain(value)}"
        for name, value in getattr(part, part.way)
        if value is not None and (name, value) not in (("phase", 0.0), ("angle_unit", RADIANS))
        if not isinstance(value, Table)  # of which other lines tell
    )
    when = [f"from {part.start:g} s"] if part.start else []
    when += [f"to {part.end:g} s"] if part.end is not None else []
    when += [f"ramp {part.ramp:g} s"] if part.ramp else []
    return " ".join([part.way, ", ".join([*told, *when])])


def _plain(value) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_plain, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def motion_warnings(scene: Scene) -> Iterator[str]:
    """What of the motions of walls and bodies may not be meant so."""
    compresses = any(part.flows and not part.keeps_form for part in scene.layout.parts)
    for number, part, sweep in moving_parts(scene.census):
        key = f"{part}.motion"
        share = sweep.speed / scene.sound_speed
        if share > QUICK and compresses:
            yield (
                f"{key}: {sweep.speed:.3g} m/s is {share:.2g} of the speed of sound, which compresses the "
                f"fluid before it; give physics.sound_speed = {10.0 * sweep.speed:.3g} or more"
            )
        yield from _leaving(scene, key, sweep)
        if met := None if goes_free(scene.census.motions[number]) else _first_met(scene, number):
            time, other, place = met
            yield (
                f"{key}: at {time:.3g} s it is in {other}, near "
                f"({', '.join(f'{x:.3g}' for x in place)}): they run through each other"
            )


def overshoots(scene: Scene) -> Iterator[str]:
    """Series whose rows are too few where they bend for a smooth curve to stay near them."""
    for loc, parts in scene.case.motions.items():
        for series in (part.series for part in parts if part.series):
            share, first, last = series.law().overshoot()
            if share > FAR_OFF:
                yield (
                    f"{dotted(loc)}.series: between its rows at {first:g} and {last:g} s the smooth curve "
                    f"through {series.file} goes beyond both by {share:.2g} of the whole way of that column; "
                    "give more rows there"
                )


def _leaving(scene: Scene, key: str, sweep: Sweep) -> Iterator[str]:
    """Where a wall leaves the domain that the case gives, along an axis that does not repeat."""
    for end, given, reached in (
        ("lower", scene.case.space.lower, sweep.lower),
        ("upper", scene.case.space.upper, sweep.upper),
    ):
        for d in (d for d, period in enumerate(scene.layout.periods) if given and period is None):
            beyond = reached[d] - given[d] if end == "upper" else given[d] - reached[d]
            if beyond > 1e-6 * scene.spacing:
                yield (
                    f"{key}: it comes to {AXES[d]} = {reached[d]:.3g} m, beyond space.{end}; this works, but "
                    "lists take longer than with a larger domain"
                )


def _first_met(scene: Scene, number: int) -> tuple[float, str, np.ndarray] | None:
    """The first time looked at when a part is within another one whose place is known, the key of that,
    and where."""
    sites = _sites(scene, number)
    motions, dimensions = scene.census.motions, scene.dimensions
    known = [
        part.number for part in scene.layout.parts if not part.flows and not goes_free(motions[part.number])
    ]
    others = [n for n in known if motions[n] != motions[number]]
    for time in np.sort(moments(scene.case.time.end, LOOKS)):
        places = moved_on(motions[number], sites, time, dimensions)
        for rest in {id(motions[n]): motions[n] for n in others}.values():
            back = taken_back(rest, places, time, dimensions) if is_rigid(rest) else places
            grid = [scene.layout.folded(d, x) for d, x in enumerate(back.T)]
            held = scene.layout.held(grid, grid[0].shape)
            for n in (n for n in others if motions[n] is rest or motions[n] == rest):
                if (within := held == n).any():
                    return float(time), scene.layout.parts[n].key, places[np.argmax(within)]
    return None


def _sites(scene: Scene, number: int) -> np.ndarray:
    """Places of some of a wall's particles at the start (n, dim)."""
    places = []
    for first, last in scene.layout.lattice.chunks():
        held = scene.layout.materials(first, last) == number
        grid = scene.layout.lattice.grid(first, last)
        places.append(np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1))
    sites = np.concatenate(places)
    return sites[:: max(1, len(sites) // LOOKED_AT)]
