"""Rigid bodies that cannot be in their scene, and numbers of bodies that are likely a slip."""

import math
from collections.abc import Iterator

import numpy as np

from psph.case.bodies import SLIDES, TURNS
from psph.case.keys import AXES
from psph.scene.bodies import body_step, density_ratio
from psph.scene.body_parts import bodies_of
from psph.scene.lattice import TOLERANCE
from psph.scene.lattice_fit import is_of_boxes
from psph.scene.scene import Scene
from psph.scene.volumes import drawn_volume, volume_of

LIGHTEST, HEAVIEST = 0.05, 20.0
"""Densities over that of the fluid that are tried (docs/bodies.md), and beyond which little floats or is
made."""

LONGEST_ARM = 10.0
"""Sizes of a body: a pivot farther from it is likely a slip."""

MOST_MISFILLED = 0.02
"""Part of its volume by which a body's particles may fill more or less without a warning."""

ASLANT = 0.02
"""Slope by which a body's particles may lean more than its surface without a warning."""

MOST_SHORTER = 10.0
"""How many times bodies may shorten the time steps that sound allows without a warning."""

MOST_CRUSHED, SAFE = 0.5, 0.4
"""Strain of the water under a body that lands, beyond which the guard of density stops a run, and one that
it bears."""


def body_faults(scene: Scene) -> Iterator[str]:
    """A line for each body that a plane of symmetry cuts and that is free to leave it."""
    for number, (name, table) in zip(scene.layout.parts.bodies, scene.case.bodies.items()):
        freed = set(table.freed(scene.dimensions))
        for plane in scene.layout.mirror_planes:
            ends = (scene.census.lowest[number, plane.axis], scene.census.highest[number, plane.axis])
            if min(abs(end - plane.at) for end in ends) > 0.75 * scene.spacing:
                continue
            off = {SLIDES[plane.axis], *(turn for d, turn in enumerate(TURNS) if d != plane.axis)}
            if leaving := [one for one in (*SLIDES, *TURNS) if one in freed & off]:
                yield (
                    f"bodies.{name}.free: {', '.join(leaving)} would take it off the mirror at "
                    f"{AXES[plane.axis]} = {plane.at:g} m, which it touches; leave them out of free"
                )


def period_faults(scene: Scene) -> Iterator[str]:
    """A line for each body that turns and reaches half a period, or more, from the point it turns about.

    The arms of its torque are those of the nearest images, which are others there.  Turns about the axis
    that repeats ask for no arm along it.
    """
    for number, one in zip(scene.layout.parts.bodies, bodies_of(scene.census)):
        for d, period in enumerate(scene.layout.periods):
            if period is None or not any(free for axis, free in enumerate(one.turns) if axis != d):
                continue
            ends = scene.census.lowest[number, d], scene.census.highest[number, d]
            far = max(abs(end - one.reference[d]) for end in ends) + 0.5 * scene.spacing
            if far > 0.5 * period - TOLERANCE * scene.spacing:
                point = "centre" if one.pivot is None else "pivot"
                yield (
                    f"bodies.{one.name}: it reaches {far:.4g} m from the {point} that it turns about along "
                    f"{AXES[d]}, half of the period of {period:g} m or more; bodies must not cross the seam "
                    "at the start, move space.lower and space.upper; or move the pivot, or make the domain "
                    "longer"
                )


def _far_points(scene: Scene) -> Iterator[str]:
    """A line for each point told of a body that is far from it, over its size."""
    half = 0.5 * scene.spacing
    ends = {
        name: (scene.census.lowest[number] - half, scene.census.highest[number] + half)
        for number, name in zip(scene.layout.parts.bodies, scene.case.bodies)
    }
    told = [
        (f"bodies.{name}.{key}", getattr(table, key), name, sizes)
        for name, table in scene.case.bodies.items()
        for key, sizes in (("centre", 1.0), ("pivot", LONGEST_ARM))
    ]
    for key, point, name, sizes in told:
        if point is None:
            continue
        low, high = ends[name]
        size = math.dist(low, high)
        away = math.hypot(*np.maximum(np.maximum(low - point, point - high), 0.0))
        if away > sizes * size:
            yield (
                f"{key}: lies {away:.3g} m from bodies.{name}, which is {size:.3g} m long; correct it if it "
                "is a point of the body"
            )


def _slight(scene: Scene) -> Iterator[str]:
    """A line for each body that is given less inertia than one of its cells would have."""
    for one in bodies_of(scene.census):
        if scene.case.bodies[one.name].inertia is None:
            continue
        moments = np.linalg.eigvalsh(np.reshape(one.inertia, (3, 3)))
        given = one.inertia[8] if scene.dimensions == 2 else float(moments[0])
        least = one.mass * scene.spacing**2 / 6.0
        if given < least:
            yield (
                f"bodies.{one.name}.inertia: {given:.3g} kg m2 is less than its mass would have in a cube of "
                f"one spacing, {least:.3g}; leave it out for that of its particles"
            )


def _lopsided(scene: Scene) -> Iterator[str]:
    """A line for each body from a geometry file whose particles lean to a side, and its surface does not.

    The slope is Σ (x − c_x)(z − c_z) / Σ (x − c_x)², with z upwards.  A site on a face belongs to the body on
    its low side alone, so a hull in round numbers may get sites on one side that it lacks on the other.
    """
    if scene.layout.mirror_planes or not any(scene.gravity):  # planes cut bodies
        return
    for name, table in scene.case.bodies.items():
        mesh = table.shape.mesh
        if mesh is None or mesh.shell or table.shape.is_placed or table.centre is not None:
            continue
        from psph.scene.meshes.mass import enclosed_by

        filled, drawn = volume_of(scene.layout, scene.layout.names.index(name)), enclosed_by(mesh)
        up = int(np.abs(scene.gravity).argmax())
        for d in (d for d in range(scene.dimensions) if d != up and not scene.gravity[d]):
            mean = -drawn.inertia[d, up] / drawn.volume  # of (x − c)(z − c), as filled.spread has it
            lean = (filled.spread[d, up] - mean) / filled.spread[d, d]
            if abs(lean) > ASLANT:
                yield (
                    f"bodies.{name}.shape.mesh: its particles lean along {AXES[d]}, by {abs(lean):.2g} rad "
                    "more than its surface: it will float aslant, since faces go through sites; move it by "
                    "part of a spacing, or make space.spacing smaller"
                )


def _misfilled(scene: Scene) -> Iterator[str]:
    """A line for each body whose particles fill another volume than its shape, where that is no box.

    Of boxes psph.scene.lattice_fit tells.
    """
    for number, (name, table) in zip(scene.layout.parts.bodies, scene.case.bodies.items()):
        if table.density is None or is_of_boxes(table.shape):
            continue
        own, drawn = volume_of(scene.layout, number).volume, drawn_volume(scene.layout, table.shape)
        if abs(own / drawn - 1.0) > MOST_MISFILLED:
            unit = "m2" if scene.dimensions == 2 else "m3"
            between = "weighs what they fill, and displaces what is between both"
            yield (
                f"bodies.{name}: its particles fill {own:.4g} {unit} of the {drawn:.4g} {unit} of its shape, "
                f"and it {between if table.fitted else 'weighs and displaces what they fill'}; make "
                "space.spacing smaller"
            )


def _crushing(scene: Scene) -> Iterator[str]:
    """A line for each heavy body under which water gives way where it lands on the floor.

    The last row of water, and contact, are as stiff as the fluid: they stop a body of the density ρ_b and
    the height h_b at the strain ε with ½ ρc² ε² dx = ½ ρ_b h_b v², ε = (v/c) √(ρ_b h_b/(ρ dx)).  v is that
    of a fall to the floor, of which friction and the water that must get out of the way leave less.
    """
    gravity = scene.layout.height_gravity
    pull = math.hypot(*gravity)
    flowing = [part.number for part in scene.layout.parts if part.flows]
    floor = float(scene.census.bottom[flowing].min(initial=math.inf))
    for number, one in zip(scene.layout.parts.bodies, bodies_of(scene.census)):
        ratio, bottom = density_ratio(scene, one), float(scene.census.bottom[number])
        if ratio <= 1.0 or not any(slides and g for slides, g in zip(one.slides, gravity)):
            continue
        fall = max(bottom - floor, 0.0) * (1.0 - 1.0 / ratio)
        speed = math.sqrt(2.0 * pull * fall + sum(v * v for v in one.velocity))
        layers = round((float(scene.census.top[number]) - bottom) / scene.spacing) + 1
        strain = speed / scene.sound_speed * math.sqrt(ratio * layers)
        if strain > MOST_CRUSHED:
            yield (
                f"bodies.{one.name}: {ratio:.3g} times as dense as its fluid, {layers} spacings high; where "
                f"it lands on the floor at up to {speed:.3g} m/s it may press water into it; give "
                f"physics.sound_speed = {math.ceil(scene.sound_speed * strain / SAFE)} or more"
            )


def body_warnings(scene: Scene) -> Iterator[str]:
    """A line for each body whose density, inertia or points are likely a slip, and for steps that bodies make
    short."""
    yield from _slight(scene)
    yield from _far_points(scene)
    yield from _misfilled(scene)
    if scene.case.flowing:
        yield from _afloat(scene)


def _afloat(scene: Scene) -> Iterator[str]:
    """A line for each body that will not float, or fall, as is likely meant."""
    yield from _lopsided(scene)
    yield from _crushing(scene)
    for one in bodies_of(scene.census):
        ratio = density_ratio(scene, one)
        if not LIGHTEST <= ratio <= HEAVIEST:
            depth = " per metre of depth" if scene.dimensions == 2 else ""
            yield (
                f"bodies.{one.name}: {one.mass:.4g} kg, {ratio:.3g} times the density of its fluid; give "
                f"mass in kg{depth}, or density in kg/m3"
            )
    if scene.case.bodies:
        by_sound = scene.case.time.cfl * scene.smoothing_length / scene.sound_speed
        if by_sound > MOST_SHORTER * (step := body_step(scene)):
            yield (
                f"bodies: lines, contact or small mass make time steps {by_sound / step:.3g} times shorter "
                "than sound does; make lines softer, or bodies heavier"
            )
