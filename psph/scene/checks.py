"""Errors of a scene, and warnings, in lines that say what to do."""

import math
from collections.abc import Iterator
from itertools import chain

import numpy as np

from psph.case import CaseError
from psph.case.consistency import MOST_STEPS
from psph.case.keys import AXES
from psph.kinds import kinds_in
from psph.scene.gauging import off_parts, outside_domain
from psph.scene.lattice import TOLERANCE
from psph.scene.lattice_fit import misfits
from psph.scene.meshes import report as meshes
from psph.scene.mirrors import distances
from psph.scene.motion_checks import FARTHEST, motion_warnings, overshoots
from psph.scene.parts import Part
from psph.scene.scene import Scene
from psph.scene.shapes import bounds, shown
from psph.scene.solved import exact_faults
from psph.scene.units import in_degrees, in_millimetres

SLABS_IN_A_PERIOD = 3
"""A periodic axis must hold that many cut-off radii: then no particle meets another twice, and all
particles of a cell have the same nearest image of a candidate (psph.particles.neighbours)."""

MOST_SITES = 10**11
"""Sites of a lattice that are visited one by one; a mistake in the units gives far more."""

MOST_IN_PLANE = 10**8
"""Sites of a plane, which are visited together: some gigabytes.  An axis that is not the longest
can have more."""

LARGEST_QUIET_JITTER = 0.5
"""In spacings; beyond it neighbours may change places."""


def check(scene: Scene) -> list[str]:
    """Warnings, one line each; raises CaseError with a line for every fault."""
    if found := list(faults(scene)):
        raise CaseError(found)
    return list(warnings(scene))


def faults(scene: Scene) -> Iterator[str]:
    """Every error for which the scene cannot be run."""
    for line in chain(meshes.size_faults(scene), _size_faults(scene)):
        yield f"{scene.case.file}: {line}"
        return  # the others would only follow from it
    empty = list(meshes.site_faults(scene)) or list(_spacing_faults(scene))
    places = empty or [
        *_domain_faults(scene),
        *_mirror_faults(scene),
        *_site_faults(scene),
        *outside_domain(scene),
        *off_parts(scene),
        *exact_faults(scene),
    ]
    places = places or [line for kind in kinds_in(scene) for line in kind.faults()]
    for line in places or _state_faults(scene):  # an empty shape has no pressure, and no motion
        yield f"{scene.case.file}: {line}"


def _size_faults(scene: Scene) -> Iterator[str]:
    """Checks before the sites are visited, which could take hours and too much memory."""
    dx, lattice = scene.spacing, scene.layout.lattice
    sites, in_plane = math.prod(lattice.counts), lattice.sites_in_plane
    in_mm = in_millimetres(scene, *range(len(scene.layout.parts)))
    if sites > MOST_SITES:
        yield (
            f"space.spacing: {dx:g} m makes a lattice of {sites:.2g} sites, more than "
            f"{MOST_SITES:.0e}; make it larger, or the shapes smaller{in_mm}"
        )
    elif in_plane > MOST_IN_PLANE:
        yield (
            f"parallel.axis: {in_plane:.2g} sites in a plane across {AXES[scene.layout.axis]}, more than "
            f"{MOST_IN_PLANE:.0e}; leave it out, or name a longer axis{in_mm}"
        )
    room = math.prod((up - low) / dx for low, up in zip(scene.layout.lower, scene.layout.upper))
    if max(room, 0.0) > max(MOST_SITES, sites):
        yield (
            f"space.upper: the domain has room for {room:.2g} particles, more than {MOST_SITES:.0e}; "
            "make it smaller, or space.spacing larger"
        )
    yield from _far_faults(scene)


def _far_faults(scene: Scene) -> Iterator[str]:
    case = scene.case
    lengths = {
        "space.origin": (*scene.layout.lattice.lower, *scene.layout.lattice.upper, *case.space.origin),
        "space.lower": scene.layout.lower,
        "space.upper": scene.layout.upper,
        **{f"{part.key}.jitter": (part.jitter * scene.spacing,) for part in _moving(scene)},
        **{f"perturbations[{k}].shift": p.shift for k, p in enumerate(case.perturbations)},
    }
    for key, numbers in lengths.items():
        far = max(map(abs, numbers))
        if far > FARTHEST * scene.spacing:
            yield (
                f"{key}: positions {far:.3g} m from 0, {far / scene.spacing:.2g} spacings, are too far for "
                "double precision; move them nearer to 0, or make space.spacing larger"
            )


def warnings(scene: Scene) -> Iterator[str]:
    """Everything that will run, but probably not as intended."""
    of_kinds = (kind.warnings() for kind in kinds_in(scene))
    for line in chain(*(one(scene) for one in OF_EVERY_SCENE), *of_kinds):
        yield f"{scene.case.file}: {line}"


def _reach(scene: Scene) -> float:
    """How far lists reach at the start, m."""
    h, skin = scene.smoothing_length, scene.case.neighbours.skin
    reaches = [kind.sizes.reach(h) for kind in kinds_in(scene) if kind.sizes]
    return max(reaches, default=scene.kernel.support * h * (1.0 + skin))


def _domain_faults(scene: Scene) -> Iterator[str]:
    least = SLABS_IN_A_PERIOD * _reach(scene)
    for name, low, period in zip(AXES, scene.layout.lower, scene.layout.periods):
        if period is None:
            continue
        spacings = period / scene.spacing
        if abs(spacings - round(spacings)) > TOLERANCE:
            fit = low + max(1, round(spacings)) * scene.spacing
            yield (
                f"space.upper: the domain is {period:.9g} m = {spacings:.6g} spacings long along "
                f"the periodic axis {name}; make it a whole number, for example up to {fit:.9g}"
            )
        if period < least:
            yield (
                f"space.upper: the domain is {period:.6g} m long along the periodic axis {name}, "
                f"the kernel needs {least:.6g}; make it longer or space.spacing smaller"
            )


def _mirror_faults(scene: Scene) -> Iterator[str]:
    """Two mirrors so near each other that an image of an image would be seen."""
    reach = _reach(scene)
    for axis, (low, high) in distances(scene.layout.mirror_planes).items():
        if high - low < reach:
            yield (
                f"space: the mirrors at {AXES[axis]} = {low:g} and {high:g} m are nearer to each "
                f"other than the kernel and the skin reach, {reach:.4g} m; make space.spacing smaller"
            )


def _spacing_faults(scene: Scene) -> Iterator[str]:
    """A spacing that leaves what moves without a particle, and that none of it is thick enough for."""
    thickness = {part.key: min(up - low for low, up in zip(*bounds(part.shape))) for part in _moving(scene)}
    thickest = max(thickness, key=thickness.get)
    table, _, _ = thickest.partition(".")
    if scene.spacing > thickness[thickest]:
        yield (
            f"space.spacing: {scene.spacing:g} m is larger than the {table}: {thickest} is "
            f"{thickness[thickest]:.3g} m thick; give at most a tenth of that, "
            f"{0.1 * thickness[thickest]:.2g}"
        )


def _site_faults(scene: Scene) -> Iterator[str]:
    census, parts = scene.census, scene.layout.parts
    for part, size in zip(parts, census.sizes):
        if not size and part.of_another:
            yield f"{part.key}: holds no particle of the solid; let the shapes meet"
        elif not size and any(census.sizes[n] for n in parts.of_whole(part.number)):
            yield f"{part.key}: its clamps hold all of it; leave a part of it free"
        elif not size and not part.may_be_empty:
            yield (
                f"{part.key}.shape: no lattice site lies in it; make it larger than space.spacing, or move it"
            )
    for (one, other), site in sorted(census.clashes.items()):
        if not parts[one].drawn or not parts[other].drawn:
            yield f"{parts[other].key}: overlaps {parts[one].key} at {shown(site)}; move one"
        elif (not parts[one].rigid or parts[other].moves_whole) and not parts[one].borne_by(parts[other]):
            move = "" if parts[one].flows else "move one, or "
            yield (
                f"{parts[other].key}.shape: overlaps {parts[one].key} at {shown(site)}; {move}subtract "
                "one from the other: shape = { difference = { from = ..., minus = [...] } }"
                f"{_or_displace(parts[one], parts[other])}{meshes.sizes_of(scene, one, other)}"
                f"{in_millimetres(scene, one, other)}"
            )
    yield from _particles_outside(scene)


def _or_displace(one: Part, other: Part) -> str:
    """The other cure for a wall in a fluid."""
    if not one.flows or not other.is_wall:
        return ""
    return f", or let the wall take its place: {other.key}.displaces = true"


def _particles_outside(scene: Scene) -> Iterator[str]:
    census, slack = scene.census, TOLERANCE * scene.spacing
    for material in set(np.flatnonzero(census.sizes)) - scene.layout.placed.keys():
        for d, name in enumerate(AXES[: scene.dimensions]):
            lowest, highest = census.lowest[material, d], census.highest[material, d]
            low, up = scene.layout.lower[d] - slack, scene.layout.upper[d] - slack
            if lowest < low or highest >= up:
                far = lowest if lowest < low else highest
                yield (
                    f"{scene.layout.parts[material].key}.shape: a particle at {name} = {far:.6g} m outside "
                    f"the domain from {scene.layout.lower[d]:.6g} to {scene.layout.upper[d]:.6g}; make the "
                    f"shape smaller, or change space.lower and space.upper{in_millimetres(scene, material)}"
                )


def _state_faults(scene: Scene) -> Iterator[str]:
    try:
        speed = scene.sound_speed
    except CaseError as error:
        for line in error.lines:
            yield line.removeprefix(f"{scene.case.file}: ")
        return
    time = scene.case.time
    longest = time.cfl * scene.smoothing_length / speed
    if time.step is None and time.end > MOST_STEPS * longest:
        yield (
            f"time.end: {time.end:g} s takes more than {MOST_STEPS:.1g} steps of at most {longest:.2g} s "
            "(by this spacing and speed of sound), lost in the rounding of the time; give "
            f"less than {0.9 * MOST_STEPS * longest:.2g}"
        )
    for part, start in zip(scene.layout.parts, scene.starts.states):
        if not part.flows:
            continue
        density = float(start.density(np.array([[0.0] * scene.dimensions]))[0])
        if not start.layer and not start.exact and not density > 0.0:
            yield (
                f"{part.key}.pressure: {start.pressure:g} Pa leaves no density at a speed of "
                f"sound of {speed:g} m/s; raise the pressure or physics.sound_speed"
            )


def _jitter(scene: Scene) -> Iterator[str]:
    for part in _moving(scene):
        if part.jitter > LARGEST_QUIET_JITTER:
            yield (
                f"{part.key}.jitter: {part.jitter:g} spacings let neighbours change places; "
                f"give at most {LARGEST_QUIET_JITTER:g}"
            )


def _moving(scene: Scene) -> list[Part]:
    """Each fluid and solid."""
    return [part for part in scene.layout.parts if part.moves_freely]


OF_EVERY_SCENE = (
    motion_warnings,
    overshoots,
    in_degrees,
    _jitter,
    meshes.remarks,
    misfits,
)
"""What warns of the parts of any scene."""
