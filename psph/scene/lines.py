"""The lines of the bodies of a scene, how they begin, and those that cannot be."""

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np

from psph.case.keys import AXES
from psph.case.lines import ChainTable, Line
from psph.physics.motion import is_rigid
from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.chains import Chain, Hanging, bearing_of
from psph.physics.rigid.lines import Lines, SpringLine, ends_of
from psph.physics.rigid.pose import in_space
from psph.scene.body_parts import bodies_of
from psph.scene.joints import beyond
from psph.scene.scene import Scene
from psph.scene.volumes import volume_of

HALVINGS = 45
"""Of the range in which the length of a chain lies that has a pretension."""

MOST_PARTS = 200.0
"""Own steps of a line with weight within one that sound allows, without a warning."""

STRETCHED = 0.1
"""Strain at the start without a warning."""

LYING = 1e-9
"""Lengths of a line by which its ends may be below its bed."""


def lines_of(scene: Scene, order: Sequence[str]) -> tuple[SpringLine, ...]:
    """The lines of all bodies, whose rows have the names in ``order``."""
    rows = {name: row for row, name in enumerate(order)}
    return tuple(
        _line(scene, rows, name, line, table)
        for name, body in scene.case.bodies.items()
        for line, table in body.lines.items()
    )


def _line(scene: Scene, rows: dict[str, int], name: str, line: str, table: Line) -> SpringLine:
    """One of them."""
    one = next((one for one in scene.species if one.name == table.to), None)
    leader = one.motion if one and table.to not in rows and is_rigid(one.motion) else None
    chain, stiffness, damping = None, table.stiffness or 0.0, table.damping
    length = math.dist(table.at, table.anchor) if table.length is None else table.length
    if table.chain is not None:
        chain = _chain(scene, table, length)
        length, stiffness = chain.length, chain.stiffness / chain.length
        damping = chain.damping * math.sqrt(chain.stiffness * chain.mass)
    elif table.pretension:
        length -= table.pretension / stiffness
    places, periods = {one.name: one.reference for one in bodies_of(scene.census)}, scene.layout.periods
    at, anchor = in_space(table.at), in_space(table.anchor)
    away = beyond(at, places[name], periods), beyond(anchor, places.get(table.to or "", anchor), periods)
    at, anchor = (tuple(x - by for x, by in zip(end, far)) for end, far in zip((at, anchor), away))
    return SpringLine(
        f"{name}.{line}",
        rows[name],
        at,
        rows.get(table.to or ""),
        anchor,
        stiffness,
        max(length, 0.0),
        damping,
        table.pulls_only,
        leader,
        chain,
        table.break_load or math.inf,
        tuple(b - a for a, b in zip(*away)),
    )


def _chain(scene: Scene, table: Line, length: float) -> Chain:
    """What a line with weight is, in the heaviest fluid; of its pretension the one with the nearest."""
    told = table.chain
    assert told is not None
    water = max((one.density for one in scene.case.fluids.values()), default=0.0)
    displaced = 0.25 * math.pi * told.diameter**2 * water
    pull = in_space(scene.gravity)
    bed = told.bed
    chain = Chain(
        told.pieces,
        length,
        told.mass,
        told.axial_stiffness,
        told.damping_ratio,
        displaced,
        told.added_mass * displaced,
        0.5 * water * told.drag * told.diameter,
        0.5 * water * told.skin_drag * math.pi * told.diameter,
        pull,
        in_space(scene.layout.up),
        math.inf if told.water_level is None else told.water_level,
        in_space(bed.at) if bed else (0.0,) * 3,
        _normal(scene, told) if bed else (0.0,) * 3,
        bearing_of(told.mass, pull, told.axial_stiffness, length / told.pieces) if bed else 0.0,
        bed.friction if bed else 0.0,
    )
    if table.pretension is None:
        return chain
    return _tightened(chain, in_space(table.at), in_space(table.anchor), table.pretension)


def _normal(scene: Scene, told: ChainTable):
    """The unit vector out of the bed."""
    assert told.bed is not None
    way = in_space(told.bed.normal or scene.layout.up)
    size = math.hypot(*way)
    return tuple(x / size if size else 0.0 for x in way)


@lru_cache(maxsize=256)
def _tightened(chain: Chain, at, anchor, tension: float) -> Chain:
    """The longest that pulls at its first end with a ``tension``, N; where its weight does so with more, that
    with which it pulls least."""
    ends = np.array([at, anchor])

    def long(length: float) -> Chain:
        bears = bearing_of(chain.mass, chain.pull, chain.stiffness, length / chain.pieces)
        return chain._replace(length=length, bearing=bears if chain.bearing else 0.0)

    def pull(length: float) -> float:
        return _pulls(long(length), ends)

    low, by = math.dist(at, anchor) / (1.0 + tension / chain.stiffness), 1e-3
    while pull(low) < tension:
        low /= 1.0 + by
        by *= 2.0
    by, high, now = 1e-4, low, pull(low)
    while now >= tension:
        low, before, high = high, now, high * (1.0 + by)
        now, by = pull(high), 1.5 * by
        if now > before:
            return long(low)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pull(middle) >= tension else (low, middle)
    return long(low)


def _pulls(chain: Chain, ends: np.ndarray) -> float:
    """Tension at the first end of a chain at rest, N."""
    return float(np.linalg.norm(Hanging(chain, ends, np.zeros((2, 3))).pulls[0]))


def _begun(scene: Scene) -> tuple[Bodies, Lines]:
    """Bodies and their lines at the start."""
    own = bodies_of(scene.census)
    bodies = Bodies(own, scene.gravity)
    lines = Lines(lines_of(scene, [one.name for one in own]), bodies)
    lines.pulls(bodies, 0.0, 0.0)
    return bodies, lines


def strung_at_start(scene: Scene) -> dict[str, np.ndarray]:
    """The points (n, dim), m, of each line by its key, as it hangs at the start."""
    bodies, lines = _begun(scene)
    keys = [key for key, _, _ in _tables(scene)]  # in the order of the lines
    return {key: one.points[:, : scene.dimensions] for key, one in zip(keys, lines.shapes(bodies, 0.0))}


def _tables(scene: Scene) -> Iterator[tuple[str, str, Line]]:
    """The key, the body and the table of each line."""
    for name, body in scene.case.bodies.items():
        for line, table in body.lines.items():
            yield f"bodies.{name}.lines.{line}", name, table


def line_faults(scene: Scene) -> Iterator[str]:
    """A line of text for each line that has an end off its body or below its bed, or no bed, or that is
    broken at the start."""
    found = [one for table in _tables(scene) for one in _misplaced(scene, *table)]
    yield from found
    if found or not any(body.lines for body in scene.case.bodies.values()):
        return
    _, lines = _begun(scene)
    for (key, _, table), tension, parted in zip(_tables(scene), lines.tensions.tolist(), lines.parted):
        if parted <= 0.0:
            yield (
                f"{key}.break_load: {table.break_load:g} N, and it is pulled with more at the start; give "
                "more, or a greater length"
            )
        elif table.pretension is not None and not math.isclose(tension, table.pretension, rel_tol=1e-6):
            says = f"its weight pulls with {tension:.4g} N at least; give more"
            if table.chain is None:
                says = f"all of it is stretch at {tension:.4g} N; give less, or a greater stiffness"
            yield f"{key}.pretension: {table.pretension:g} N, but {says}"


def _misplaced(scene: Scene, key: str, name: str, table: Line) -> Iterator[str]:
    """Ends of a line that are where they cannot be."""
    places = {part: number for number, part in enumerate(scene.layout.names)}
    for what, point, of in (("at", table.at, name), ("anchor", table.anchor, table.to)):
        if of is None or of not in places or not scene.census.sizes[places[of]]:
            continue
        low, high = (ends[places[of]] for ends in (scene.census.lowest, scene.census.highest))
        point = np.array(point) - beyond(point, 0.5 * (low + high), scene.layout.periods)[: len(low)]
        away = np.maximum(np.maximum(low - point, point - high) - 0.5 * scene.spacing, 0.0)
        if (far := math.hypot(*away)) > scene.spacing:
            yield f"{key}.{what}: lies {far:.3g} m off {of}, which it is to be a point of; move it there"
    if table.chain is None:
        return
    if not any(scene.layout.up):
        told = table.chain.bed
        if told is not None and told.normal is None:
            yield f"{key}.chain.bed: without gravity nothing is upwards; give normal"
            return
        if table.chain.water_level is not None:
            yield f"{key}.chain.water_level: without gravity there is no height; remove it"
            return
    if table.chain.bed is not None:
        normal = np.array(_normal(scene, table.chain))
        for what, point in (("at", table.at), ("anchor", table.anchor)):
            deep = float((np.array(in_space(table.chain.bed.at)) - in_space(point)) @ normal)
            if deep > LYING * math.dist(table.at, table.anchor):
                yield f"{key}.{what}: is {deep:.3g} m below chain.bed; move it up, or the bed down"


def line_warnings(scene: Scene) -> Iterator[str]:
    """A line of text for each that is stretched a lot at the start, or takes very many steps."""
    if not any(body.lines for body in scene.case.bodies.values()):
        return
    _, lines = _begun(scene)
    by_sound = scene.case.time.cfl * scene.smoothing_length / scene.sound_speed
    fluids = scene.case.fluids
    heaviest = max(fluids, key=lambda name: fluids[name].density, default="")
    for (key, _, table), line in zip(_tables(scene), lines.lines):
        if table.chain and len(fluids) > 1 and table.chain.water_level is None:
            yield f"{key}.chain: hangs in {heaviest} everywhere; give water_level, above which it is dry"
        strain = math.dist(table.at, table.anchor) / line.length - 1.0 if line.chain else 0.0
        if strain > STRETCHED:
            yield (
                f"{key}.length: {line.length:.4g} m, and its ends are {100.0 * strain:.3g} % farther apart "
                "at the start; give more, or pretension"
            )
        if line.chain and by_sound > MOST_PARTS * line.chain.longest_step:
            parts = by_sound / line.chain.longest_step
            yield (
                f"{key}.chain: takes {parts:.3g} steps of its own in each that sound allows; give fewer "
                "pieces, or a smaller axial_stiffness"
            )


def line_words(scene: Scene) -> Iterator[str]:
    """What each line is, and how bodies swing on theirs."""
    if not any(body.lines for body in scene.case.bodies.values()):
        return
    bodies, lines = _begun(scene)
    for number, line in enumerate(lines.lines):
        pulls = f"{lines.tensions[number]:.4g} N at the start"
        if line.chain:
            one = line.chain
            weight = (one.mass - one.displaced) * math.hypot(*one.pull)
            yield (
                f"{line.name}: {line.length:.4g} m in {one.pieces} pieces, {weight:.4g} N/m in water, "
                f"{pulls}, {lines.tensions_far[number]:.4g} N at its anchor; own steps of "
                f"{one.longest_step:.3g} s"
            )
        else:
            yield f"{line.name}: {line.length:.4g} m without tension, {line.stiffness:.4g} N/m, {pulls}"
    for row, body in enumerate(bodies.bodies):
        for d in range(scene.dimensions):
            if not body.slides[d] or not any(row in (line.body, line.other) for line in lines.lines):
                continue
            held, floats = _stiffness(lines.lines, bodies, row, d), _afloat(scene, body.name, d)
            if held + floats > 0.0:
                period = 2.0 * math.pi * math.sqrt(body.mass / (held + floats))
                beside = f" and buoyancy with {floats:.3g}" if floats else ""
                yield (
                    f"{body.name} along {AXES[d]}: lines hold it with {held:.3g} N/m{beside}; period "
                    f"{period:.3g} s, and more with the water that goes along"
                )


def _stiffness(lines: Sequence[SpringLine], bodies: Bodies, row: int, d: int) -> float:
    """Force of lines at rest on a body by its way along an axis, N/m."""
    found = 0.0
    for line in lines:
        if row not in (line.body, line.other):
            continue
        ends, small = ends_of(line, bodies, 0.0)[0], 1e-4 * max(line.length, 1e-12)
        if line.chain:  # longer ways, where it hangs: its masses leave the bed one by one
            loose = line.length - math.dist(*ends)
            small = max(small, min(0.2 * loose, 0.5 * line.length / line.chain.pieces))
        pulls = []
        for way in (-small, small):
            moved = ends.copy()
            moved[0 if line.body == row else 1, d] += way
            pulls.append(_resting(line, moved)[0 if line.body == row else 1, d])
        found -= (pulls[1] - pulls[0]) / (2.0 * small)
    return found


def _resting(line: SpringLine, ends: np.ndarray) -> np.ndarray:
    """What a line at rest does to its ends (2, 3), N."""
    if line.chain:
        return Hanging(line.chain, ends, np.zeros((2, 3))).pulls
    apart = ends[1] - ends[0]
    length = float(np.linalg.norm(apart))
    tension = line.stiffness * (length - line.length)
    pull = (max(tension, 0.0) if line.pulls_only else tension) * apart / (length or 1.0)
    return np.array([pull, -pull])


def _afloat(scene: Scene, name: str, d: int) -> float:
    """ρgA of a body in the surface of its fluid, as of a box of its volume and height, N/m."""
    g, number = abs(scene.layout.height_gravity[d]), scene.layout.names.index(name)
    flowing = [part.number for part in scene.layout.parts if part.flows]
    if not g or not flowing or any(x for e, x in enumerate(scene.layout.height_gravity) if e != d):
        return 0.0
    level = float(scene.census.top[flowing].max())
    if not scene.census.bottom[number] < level < scene.census.top[number]:
        return 0.0
    filled = volume_of(scene.layout, number)
    area = filled.volume / math.sqrt(12.0 * filled.spread[d, d])
    return scene.species[number].density * g * area
