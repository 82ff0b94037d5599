"""Elastic solids that cannot be, and numbers of solids that are likely a slip."""

from collections.abc import Iterator

import numpy as np

from psph.case.elastic import STRESS
from psph.case.keys import AXES
from psph.case.solids import FINEST
from psph.case.updated import referred_in
from psph.physics.solid.laws import SaintVenantKirchhoff
from psph.scene.calming import calming, impedance, solids_of
from psph.scene.faces import thinnest
from psph.scene.lattice import TOLERANCE
from psph.scene.parts.solid import ElasticPart, UpdatedPart
from psph.scene.scene import Scene
from psph.scene.shapes import inside
from psph.scene.solid_areas import faced

FEWEST = 4
"""Particles across a plate: fewer bend too softly (docs/solids.md)."""

LIGHTEST, HEAVIEST = 1.0, 25_000.0
"""kg/m³: an aerogel, and osmium's 22,600."""

HEAVY = 0.3
"""Part of its speed that a solid may lose to the fluid in a step: 0.06 with aluminium 4 particles thick, 0.16
with what is as light as water."""

LOCKING = 0.49
"""Poisson's ratio above which plates bend too stiffly (docs/solids.md)."""

ALIKE = 1.3
"""By how much the two speeds of sound in the bulk of a metal may differ: of copper by 1.04."""

STIFFEST = 1.3e12
"""Pa: diamond has 1.2e12."""

SLOWEST = 2.0
"""Wave speed over the expected speed below which a solid is hardly one."""


def solid_faults(scene: Scene) -> Iterator[str]:
    """A line for each solid that is too thin for any stress, for each load that pulls nothing, and for each
    two clamps of a solid that share particles."""
    yield from _shared(scene)
    for number, name in _elastic(scene):
        wide, axis = _across(scene, number)
        spacing = scene.spacing / scene.layout.parts[number].finer
        if wide == 1:
            yield (
                f"solids.{name}.shape: one particle thick along {AXES[axis]}, where no strain is known; make "
                f"it at least {FEWEST} spacings thick, {FEWEST * spacing:.6g} m"
            )
        for load, table in scene.case.solids[name].loads.items():
            if not _pulls(scene, scene.layout.parts.of_whole(number), table.shape):
                yield f"solids.{name}.loads.{load}.shape: no particle of the solid lies in it; move it there"
            elif table.pressure is not None and not _is_pressed(scene, number, table):
                yield (
                    f"solids.{name}.loads.{load}.pressure: no face of the solid in it looks that way; let "
                    "the shape hold the outermost particles there"
                )


def solid_warnings(scene: Scene) -> Iterator[str]:
    """A line for each number of a solid that is likely not meant."""
    case, referred = scene.case, referred_in(scene.case)
    if len(referred) > 1 and case.physics.contact is None and not case.flowing:
        yield (
            f"solids: {', '.join(referred)} do not feel each other, and run through each other where "
            "they meet; give physics.contact = {}"
        )
    if referred and not case.flowing:
        yield from fast_start(scene)
    for number, name in _elastic(scene):
        yield from _of_either_description(scene, number, name)
    for solid, (number, (name, table)) in enumerate(zip(scene.layout.parts.solids, referred.items())):
        if table.hourglass == 0:
            yield f"solids.{name}.hourglass: 0 leaves zigzags of particles without stiffness; remove it"
        yield from _numbers(f"solids.{name}", table)
        for load, pulling in table.loads.items():
            if not _pulls(scene, [number], pulling.shape):
                yield (
                    f"solids.{name}.loads.{load}: all particles that it pulls are clamped, and do not move; "
                    "let its shape reach beyond the clamp"
                )
        yield from _behind_anvils(scene, number, f"solids.{name}")
        if scene.case.fluids:
            yield from _answers(scene, solid, f"solids.{name}", table)


def fast_start(scene: Scene) -> Iterator[str]:
    """A line where solids start at a speed that guards.speed takes for trouble, as in an impact of shocks."""
    most, speed = scene.case.guards.speed, scene.starting_speed / scene.sound_speed
    if speed > most:
        yield (
            f"guards.speed: {most:g}, and the solids start at {speed:.3g} speeds of sound: the run would "
            f"stop at once; give guards.speed = {2.0 * speed:.2g} if this is intended"
        )


def solid_advice(scene: Scene) -> Iterator[str]:
    """What to try after a guard stopped a run of solids."""
    if scene.case.time.step is not None:
        yield "remove time.step: the waves in the solids set the step then"
    softens = any(isinstance(one.law, SaintVenantKirchhoff) for one in solids_of(scene.starts))
    law = 'law = "neo-hookean", which stands more compression, ' if softens else ""
    yield f"give {law}a larger hourglass, or some damping; look at the units of young, density and loads"


def _across(scene: Scene, number: int) -> tuple[int, int]:
    """The fewest particles of a solid along an axis, and that axis."""
    cells, axis = thinnest(scene.census, number)
    return cells * scene.layout.parts[number].finer, axis


def _elastic(scene: Scene) -> Iterator[tuple[int, str]]:
    """The part and the name of each elastic solid, total or updated Lagrangian."""
    for part in scene.layout.parts:
        if isinstance(part, (UpdatedPart, ElasticPart)):
            yield part.number, part.name


def _of_either_description(scene: Scene, number: int, name: str) -> Iterator[str]:
    """A line for a solid that is thin, and for each number of it that is likely in another unit."""
    table, (wide, axis) = scene.case.solids[name], _across(scene, number)
    if 1 < wide < FEWEST:
        part = scene.layout.parts[number]
        fits, own = wide * scene.spacing / part.finer / FEWEST, ""
        if scene.case.fluids and FINEST * fits >= scene.spacing * (1.0 - TOLERANCE):
            parts = np.ceil(scene.spacing / fits - TOLERANCE)
            own = f", or solids.{name}.spacing = {scene.spacing / parts:.6g}"
        yield (
            f"solids.{name}.shape: {wide} particles thick along {AXES[axis]}: it will bend too softly; "
            f"give space.spacing = {fits:.3g} or less{own}"
        )
    if not LIGHTEST <= table.density <= HEAVIEST:
        yield f"solids.{name}.density: {table.density:g} kg/m3; steel has 7850, rubber 1100"
    own = scene.layout.parts[number].bonded
    wave = table.wave_speed if own is None else solids_of(scene.starts)[own].wave_speed
    if wave < SLOWEST * scene.expected_speed and not table.mie_gruneisen:
        yield (
            f"solids.{name}.young: waves of {wave:.3g} m/s, where {scene.expected_speed:.3g} m/s are "
            "expected: it will collapse; Young's modulus is in Pa: rubber has 1e6 to 1e8, steel 2e11"
        )
    if table.young > STIFFEST:
        yield (
            f"solids.{name}.young: {table.young:g} Pa, and diamond has 1.2e12; it is in Pa: rubber has 1e6 "
            "to 1e8, steel 2e11"
        )


def _numbers(key: str, table) -> Iterator[str]:
    """A line for each number of a solid's material that hides what it is like."""
    if table.poisson > LOCKING:
        yield (
            f"{key}.poisson: {table.poisson:g}: above {LOCKING:g} a solid hardly bends, since each particle "
            f"keeps its volume; give {LOCKING:g} or less"
        )
    asked = table.mie_gruneisen and table.mie_gruneisen.sound_speed
    own = (table.young / (3.0 * (1.0 - 2.0 * table.poisson) * table.density)) ** 0.5
    if asked and not own / ALIKE <= asked <= own * ALIKE:
        yield (
            f"{key}.mie_gruneisen.sound_speed: {asked:g} m/s, where young and poisson give {own:.4g} m/s to "
            "the bulk; let the two fit"
        )


def _behind_anvils(scene: Scene, number: int, key: str) -> Iterator[str]:
    """A line for each anvil that pushes a solid from the start."""
    parts = scene.layout.parts.of_whole(number)
    for name, (place, normal) in zip(scene.case.anvils, scene.layout.hard_planes):
        nearest = np.inf
        for first, last in scene.layout.lattice.chunks():
            own = np.isin(scene.layout.materials(first, last), parts)
            grid = scene.layout.lattice.grid(first, last)
            above = sum(n * (x - x_0) for n, x, x_0 in zip(normal, grid, place))
            nearest = min(nearest, np.broadcast_to(above, own.shape)[own].min(initial=np.inf))
        if nearest < (0.5 - TOLERANCE) * scene.spacing:
            yield (
                f"anvils.{name}: {key} reaches {0.5 * scene.spacing - nearest:.3g} m behind it at the start, "
                "and will fly off; move one of the two"
            )


def _answers(scene: Scene, number: int, key: str, table) -> Iterator[str]:
    """A line where a solid answers to the fluid faster than a step can tell."""
    share = impedance(scene.speeds, number, table)
    if share > HEAVY:
        yield (
            f"{key}: the fluid takes {100.0 * share:.0f} % of its speed in a step, so light it is, or thin: "
            "they will shake each other; give a smaller time.cfl, or make it heavier, or a thin one thicker"
        )
    needed = calming(scene.speeds, number, table)
    if table.damping is not None and table.damping < 0.5 * needed:
        yield (
            f"{key}.damping: {table.damping:g} Pa s lets waves grow that a step of the fluid does not "
            f"resolve; remove it, for {needed:.2g} Pa s"
        )


def _shared(scene: Scene) -> Iterator[str]:
    """A line for each clamp that shares particles with an earlier one of its solid."""
    parts = scene.layout.parts
    clamps = [parts[number] for number in parts.clamps]
    for n, clamp in enumerate(clamps):
        for other in (one for one in clamps[:n] if one.whole == clamp.whole):
            if (count := _sites_in(scene, parts[clamp.whole].shape, clamp.shape, other.shape)) > 0:
                yield f"{clamp.key}: shares {count:,} particles with {other.key}; let each be in one clamp"


def _sites_in(scene: Scene, *shapes) -> int:
    """How many sites lie in all of some shapes."""
    tolerance, count = TOLERANCE * scene.spacing, 0
    for first, last in scene.layout.lattice.chunks():
        grid, size = scene.layout.lattice.grid(first, last), scene.layout.lattice.shape(first, last)
        held = (np.broadcast_to(inside(shape, grid, tolerance), size) for shape in shapes)
        count += int(np.count_nonzero(np.logical_and.reduce([*held])))
    return count


def _is_pressed(scene: Scene, number: int, load) -> bool:
    """Whether a pressure finds any face of a solid."""
    layout = scene.layout
    for first, last in layout.lattice.chunks():
        own = np.isin(layout.materials(first, last), layout.parts.of_whole(number))
        sites = np.stack(
            [np.broadcast_to(x, own.shape)[own] for x in layout.lattice.grid(first, last)], axis=1
        )
        for off in layout.lattice.within_cell(layout.parts[number].finer):
            if faced(layout, number, load, sites + off).any():
                return True
    return False


def _pulls(scene: Scene, parts: list[int], shape) -> bool:
    """Whether any particle of these parts of one solid lies in a shape."""
    tolerance = TOLERANCE * scene.spacing
    for first, last in scene.layout.lattice.chunks():
        held = scene.layout.materials(first, last)
        own, grid = np.isin(held, parts), scene.layout.lattice.grid(first, last)
        for off in scene.layout.lattice.within_cell(scene.layout.parts[parts[0]].finer):
            if (inside(shape, [x + d for x, d in zip(grid, off)], tolerance) & own).any():
                return True
    return False


def solid_lines(scene: Scene) -> Iterator[str]:
    """What the solids are, in words, for `explain`."""
    parts = scene.layout.parts
    for solid, number in enumerate(parts.solids):
        one, name, table = solids_of(scene.starts)[solid], parts[number].name, parts[number].table
        wide, axis = _across(scene, number)
        each = int(scene.layout.cell_counts[number])
        clamped = each * sum(int(scene.census.sizes[n]) for n in parts.of_whole(number) if n != number)
        count = each * int(scene.census.sizes[number]) + clamped
        yield (
            f"  solid       {name}: {_law(table)}, E {table.young:g} Pa, ν {table.poisson:g}, waves of "
            f"{one.wave_speed:.4g} m/s; {count:,} particles, {clamped:,} of them clamped, "
            f"{wide} across {AXES[axis]}"
        )
        if one.finer > 1:
            own = scene.spacing / one.finer
            yield f"              its spacing is {own:g} m, 1/{one.finer} of space.spacing"
        if one.viscosity:
            given = (
                "" if table.damping is not None else ", which calms what a step of the fluid does not resolve"
            )
            yield f"              with a viscosity of {one.viscosity:.3g} Pa s{given}"


def _law(table) -> str:
    """The law of a solid, in words."""
    if table.johnson_cook:
        return f"Johnson and Cook, {table.johnson_cook.yield_stress:g} Pa at no strain"
    if table.yield_stress is None:
        law = table.law if table.hyperelastic is None else type(table.hyperelastic.law).__name__
        sheet = " in plane stress" if table.plane == STRESS else ""
        relaxes = "".join(f" + {one.shear:g} Pa for {one.time:g} s" for one in table.relaxation)
        return f"{law}{sheet}{relaxes}"
    return f"yields at {table.yield_stress:g} Pa, hardening {table.hardening:g} Pa"
