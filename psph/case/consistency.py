"""Rules between the keys of a case."""

from collections.abc import Iterator
from typing import Any

from pydantic_core import InitErrorDetails, PydanticCustomError

from psph.acts import refusals
from psph.case.corners import cornered, of_kinds, of_tables
from psph.case.errors import advise, with_points
from psph.case.findings import Finding, Location, asked_of, frictions_of, not_of
from psph.case.fitted import fitted
from psph.case.keys import AXES, Table
from psph.case.measured import due, gauged, probed
from psph.case.moved import moved
from psph.case.numbers import numbered
from psph.case.placed import Placed
from psph.case.placing import Placing, Turn
from psph.case.refined import refined
from psph.case.schemes import STABLE
from psph.physics.roles import ROLES
from psph.physics.walls.slip import NoSlip


def contradictions(case) -> list[InitErrorDetails]:
    """All contradictions between the keys of a case."""
    rules = (
        _named,
        _shapes,
        _square,
        _axes,
        _domain,
        _mirrored,
        _exact,
        _effects,
        cornered,
        _continued,
        moved,
        _friction,
        probed,
        gauged,
        numbered,
        of_tables,
        of_kinds,
        _single,
        refined,
        fitted,
        _stepped,
        due,
    )
    if not case.movers:
        return [_without_matter(case)]
    wrong = list(_dimensions(case))
    more = (finding for rule in rules for finding in rule(case))
    findings = list(_sizes(case)) or [*wrong, *not_of(wrong, more)]
    told = {(loc, says): value for loc, value, says in findings}  # several effects of one key say the same
    return [
        # The message goes in as a value: braces in it are not placeholders.
        {"type": PydanticCustomError("psph", "{says}", {"says": says}), "loc": loc, "input": value}
        for (loc, says), value in told.items()
    ]


def _without_matter(case) -> InitErrorDetails:
    """A case must have something that moves freely; what cannot be alone says so."""
    for table, _, of in case.entries:
        if of.alone:
            says = PydanticCustomError("psph", "{says}", {"says": of.alone})
            return {"type": says, "loc": (table,), "input": {}}
    first = next(iter(case.tables_of(Placed)))
    if first not in case.model_fields_set:
        return {"type": "missing", "loc": (first,), "input": {}}
    lengths = {"field_type": "Dictionary", "min_length": 1, "actual_length": 0}
    return {"type": "too_short", "loc": (first,), "input": {}, "ctx": lengths}


def _named(case) -> Iterator[Finding]:
    if case.profile and case.scheme != STABLE:
        yield (
            ("profile",),
            case.profile,
            f'it changes the default scheme, and scheme = "{case.scheme}" is another; remove one of the two',
        )


def walk(value: Any, loc: Location = ()) -> Iterator[tuple[Location, Any]]:
    """Every table and list in a case, with its location."""
    yield loc, value
    if isinstance(value, Table):
        for name, field in type(value).model_fields.items():
            yield from walk(getattr(value, name), (*loc, field.alias or name))
    elif isinstance(value, dict):
        for name, inner in value.items():
            yield from walk(inner, (*loc, name))
    elif isinstance(value, tuple):
        for place, inner in enumerate(value):
            yield from walk(inner, (*loc, place))


SMALLEST, LARGEST = 1e-30, 1e30
"""Between these lie the sizes of all numbers of a case that are not 0: what is computed from them,
fifth powers of lengths among it, then stays a number."""

SHORTEST_OUTPUT = 1e-4 * SMALLEST
"""A thousandth of the shortest run, which is what a resolved case may hold, is taken too."""


def _sizes(case) -> Iterator[Finding]:
    for loc, value in walk(case):
        least = SHORTEST_OUTPUT if loc[:1] == ("output",) else SMALLEST
        if isinstance(value, float) and value and not least <= abs(value) <= LARGEST:
            yield (
                loc,
                value,
                (f"psph computes with 0 and sizes from {SMALLEST:g} to {LARGEST:g}; give such a number"),
            )


def _dimensions(case) -> Iterator[Finding]:
    foreign: Location = ("no key",)  # the shape that does not belong here: one line is enough
    for loc, value, dimensions, here in _in_space(case):
        if loc[:2] == ("study", "vary"):  # ladders: no vectors
            continue
        only_in = getattr(value, "only_in", dimensions)
        if only_in != dimensions and loc[: len(foreign)] != foreign:
            foreign = loc
            yield (
                loc,
                value,
                (
                    f"a {loc[-1]} needs space.dimensions = {only_in}, here it is {dimensions}; "
                    f"use {getattr(value, 'instead', 'another shape')}"
                ),
            )
        elif isinstance(value, Turn) and (value.axis is None) != (dimensions < len(AXES)):
            foreign = loc
            says = "give axis, such as [0, 0, 1]" if value.axis is None else "remove axis"
            yield loc, ..., f"a turn in {here}: {says}"
        elif _is_vector(value) and len(value) != dimensions and loc[: len(foreign)] != foreign:
            yield (
                loc,
                value,
                (
                    f"{len(value)} number{'s' * (len(value) > 1)} in {here}; give {dimensions}"
                    f"{with_points(value, dimensions)}"
                ),
            )


def _in_space(case) -> Iterator[tuple[Location, Any, int, str]]:
    """Every table and list of a case but those that are no points, with its location, how many numbers a
    point has there, and where that is, in words: what is drawn out or turned is flat."""
    flat: list[Location] = []
    lists: set[Location] = set()
    whole = case.space.dimensions
    for loc, value in walk(case):
        if loc in lists:
            continue
        if isinstance(value, Table):
            lists |= {(*loc, name) for name in value.lists()}
        if name := getattr(value, "flat", ""):
            flat.append((*loc, name))
        if any(loc[: len(one)] == one for one in flat):
            yield loc, value, 2, "a profile, which is flat"
        else:
            yield loc, value, whole, f"a case with space.dimensions = {whole}"


def _shapes(case) -> Iterator[Finding]:
    """Shapes without an end."""
    outer: Location = ("no key",)
    for loc, value in walk(case):
        if isinstance(value, Placing) and loc[: len(outer)] != outer:
            outer = loc
            if value.is_endless:
                yield loc, ..., "goes on without an end; take its intersection with a box"


def _is_vector(value: Any) -> bool:
    return isinstance(value, tuple) and value != () and all(isinstance(x, float) for x in value)


def _square(case) -> Iterator[Finding]:
    dimensions = case.space.dimensions
    for entry in case.movers:
        rows = entry.of.velocity_gradient
        if rows and len(rows) != dimensions:
            yield (
                (*entry.loc, "velocity_gradient"),
                rows,
                (
                    f"{len(rows)} row{'s' * (len(rows) > 1)} in a case with space.dimensions = "
                    f"{dimensions}; give one for each component of the velocity"
                ),
            )


def _axes(case) -> Iterator[Finding]:
    axes = AXES[: case.space.dimensions]
    named = [(("space", "periodic", k), axis) for k, axis in enumerate(case.space.periodic)]
    named.append((("parallel", "axis"), case.parallel.axis))
    named += [(("probes", name, "front"), probe.front) for name, probe in case.probes.items()]
    for zone in ("damping_zone", "other_damping_zone"):
        if (asked := getattr(case.physics, zone)) is not None:
            named.append((("physics", zone, "axis"), asked.axis))
    for loc, axis in named:
        if axis is not None and axis not in axes:
            yield loc, axis, (f"no axis in {case.space.dimensions}D; give one of {', '.join(axes)}")


def _domain(case) -> Iterator[Finding]:
    space = case.space
    given = {"lower": space.lower, "upper": space.upper}
    missing = [name for name, corner in given.items() if corner is None]
    if space.periodic and missing:
        yield (
            ("space", "periodic"),
            space.periodic,
            (
                "a periodic axis needs the corners of the domain; give "
                + " and ".join(f"space.{name}" for name in missing)
            ),
        )
    if not missing and any(low >= up for low, up in zip(space.lower, space.upper)):
        yield (
            ("space", "upper"),
            space.upper,
            ("not above space.lower on every axis; let every number exceed that of space.lower"),
        )


def _mirrored(case) -> Iterator[Finding]:
    """Mirrors where none can be."""
    space, gravity, central = case.space, case.physics.gravity, case.physics.central_force
    for side in space.symmetry:
        axis, end = AXES.index(side[0]), side[2:]
        loc = ("space", "symmetry")
        if axis >= space.dimensions:
            yield loc, side, f"no axis in {space.dimensions}D; give another side"
        elif getattr(space, end) is None:
            yield loc, side, f"the plane stands at the end of the domain; give space.{end}"
        elif side[0] in space.periodic:
            yield loc, side, f"the axis {side[0]} is periodic; remove one of the two"
        elif (
            central is not None
            and abs(central.center[axis] - getattr(space, end)[axis]) > 1e-9 * space.spacing
        ):
            yield loc, side, "physics.central_force pulls through it; put its center on the plane"
        elif gravity is not None and gravity.acceleration[axis]:
            yield loc, side, 'gravity pulls through it; a wall with condition = "mirror" bears weight'


def _exact(case) -> Iterator[Finding]:
    given = [name for name, value in case.exact if value is not None]
    for extra in given[1:]:
        yield (
            ("exact", extra),
            ...,
            f"a case has one exact solution at most, and also has {given[0]}; remove one",
        )


def _continued(case) -> Iterator[Finding]:
    known = [entry.name for entry in case.movers if entry.of.flows]
    for entry in (one for one in case.entries if one.of.rigid):
        if (continued := entry.of.continues) is not None and continued not in known:
            says = f"no fluid has this name; {advise(continued, known)}"
            yield (*entry.loc, "continues"), continued, says


def _friction(case) -> Iterator[Finding]:
    rubs = any(entry.of.rubs for entry in case.movers)
    named = frictions_of(case)
    for entry in (one for one in case.entries if getattr(one.of, "no_slip", False)):
        loc, condition = (*entry.loc, "no_slip"), getattr(entry.of, "condition", None)
        if not rubs:
            yield (
                loc,
                True,
                ("no fluid has a viscosity; set fluids.NAME.viscosity or .rheology, or remove no_slip"),
            )
        elif says := refusals(NoSlip).get(condition):
            yield loc, True, says
        elif named:
            yield loc, True, f"does not work with physics.{named[0]}; remove one of the two"


LARGEST_SINGLE = 1e36
"""Numbers of pairs in single precision stay below, with room for their sums."""


def _single(case) -> Iterator[Finding]:
    h = case.space.smoothing * case.space.spacing
    largest = h ** -(case.space.dimensions + 2.0)  # W'/r
    if case.precision == "mixed" and not 1.0 / LARGEST_SINGLE < largest < LARGEST_SINGLE:
        yield (
            ("precision",),
            case.precision,
            (f'single precision cannot hold the kernel\'s slope at h = {h:g} m; use "double"'),
        )


LARGEST_LOSS = 1e-6
"""Part of itself by which a time step may be rounded when it is added to the time."""

MOST_STEPS = LARGEST_LOSS * 2.0**53
"""Equal steps from zero on until they are: a time has 53 binary digits."""


def _stepped(case) -> Iterator[Finding]:
    end, step = case.time.end, case.time.step
    if step is not None and end > MOST_STEPS * step:
        yield (
            ("time", "step"),
            step,
            (
                f"too short for {end:g} s: more than {MOST_STEPS:.1g} steps, lost in the rounding of "
                f"the time; give at least {1.1 * end / MOST_STEPS:.2g}"
            ),
        )
    if case.time.halvings:
        yield from _halved(case)


def _halved(case) -> Iterator[Finding]:
    """What does not go with steps of their own of particles."""
    loc, halvings = ("time", "halvings"), case.time.halvings
    if not all(entry.of.takes_own_steps for entry in case.movers):
        yield loc, halvings, "particles of gases alone take steps of their own; remove this key"
        return
    if case.time.step is not None:
        yield loc, halvings, "a fixed step is the same for all; remove this key or time.step"
    if case.physics.self_gravity is not None:
        yield loc, halvings, "self-gravity is summed for all at once; remove this key or physics.self_gravity"
    if case.physics.shock_viscosity is None:
        yield loc, halvings, "without physics.shock_viscosity sound would grow; remove this key, or give that"


def _effects(case) -> Iterator[Finding]:
    """What the effects of a case say of it, and of each other."""
    asked = list(asked_of(case))
    for name, value, effect in asked:
        if hasattr(effect, "conflicts"):
            for says in effect.conflicts(case.physics, case.space.kernel):
                yield ("physics", name), value, says
    for role in ROLES:
        present = [name for name, _, effect in asked if role in getattr(effect, "roles", ())]
        for extra in present[:-1]:
            yield (
                ("physics", extra),
                ...,
                (f'physics.{present[-1]} {role.does}; set it to "off", or remove this key'),
            )
