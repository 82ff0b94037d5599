"""Tensions of a case: of each fluid at its free surface, and of each pair of fluids."""

from collections.abc import Iterator
from itertools import combinations

from psph.acts import ONE, refusals
from psph.case.angles import UPRIGHT, ContactAngles
from psph.case.corners import present
from psph.case.errors import advise
from psph.case.findings import Finding
from psph.physics.surface.tension import SurfaceTension
from psph.physics.walls.conditions import MIRROR

KEY = "interfacial_tension"


def tensions_in(case) -> dict[str, tuple[float, ...]]:
    """Of each fluid by its name its surface tension and those between it and each fluid, in their order, N/m;
    empty where none is told."""
    if not any(_asked(case)):
        return dict.fromkeys(case.fluids, ())
    told = dict(_told(case))
    return {
        name: (fluid.surface_tension or 0.0, *(told.get(_pair(name, other), 0.0) for other in case.fluids))
        for name, fluid in case.fluids.items()
    }


def tension_findings(case) -> Iterator[Finding]:
    """Tensions of fluids that are not there, that contradict each other, that are missing, or that do not
    go together with what else the case has."""
    names = list(case.fluids)
    for (name, other), value in _entries(case):
        loc = ("fluids", name, KEY, other)
        if other == name:
            yield loc, value, "the fluid itself; give its tension at a free surface as surface_tension"
        elif other not in case.fluids:
            yield loc, value, f"no fluid has this name; {advise(other, [n for n in names if n != name])}"
        elif names.index(name) < names.index(other):
            again = getattr(case.fluids[other], KEY).get(name, value)
            if again != value:
                yield loc, value, f"fluids.{other}.{KEY}.{name} is {again:g}; remove one of the two"
    yield from _angles(case)
    if not any(_asked(case)):
        return
    loc, told = next(_asked(case)), dict(_told(case))
    for one, other in combinations(names, 2):
        if _pair(one, other) not in told:
            says = f"no tension between {one} and {other}, while others are told"
            yield loc, ..., f"{says}; give fluids.{one}.{KEY}.{other} in N/m, 0 for none"
    if case.space.dimensions == 1:
        yield loc, ..., f"{ONE} has no curved surface; remove it"
    for corner, says in refusals(SurfaceTension).items():
        if corner in present(case):
            yield loc, ..., says


def _angles(case) -> Iterator[Finding]:
    """Contact angles where there is no tension, or nothing that could pull."""
    for entry in (one for one in case.entries if one.of.rigid and one.of.contact_angle is not None):
        loc, angle = (*entry.loc, "contact_angle"), entry.of.contact_angle
        if not any(_asked(case)):
            yield loc, angle, "no fluid has a tension; give fluids.NAME.surface_tension, or remove this key"
        elif entry.of.condition == MIRROR and angle != UPRIGHT:
            says = "surfaces meet a mirror at 90 degrees; take another condition, or remove this key"
            yield loc, angle, says
        elif isinstance(angle, ContactAngles) and _lines_of_the_lighter(case):
            says = "walls remember the lines of the heaviest fluid alone; give one angle, or remove the "
            yield loc, ..., f"{says}tensions of lighter ones at a free surface and between them"


def _lines_of_the_lighter(case) -> bool:
    """Whether fluids other than the heaviest have tensions of their own."""
    fluids = list(case.fluids.items())
    heaviest, _ = max(fluids, key=lambda one: one[1].density)
    told = dict(_told(case))
    lighter = [(name, fluid) for name, fluid in fluids if name != heaviest]
    between = (told.get(_pair(one, other)) for (one, _), (other, _) in combinations(lighter, 2))
    return any(fluid.surface_tension for _, fluid in lighter) or any(between)


def _asked(case) -> Iterator[tuple[str, ...]]:
    """The keys that tell a tension."""
    for name, fluid in case.fluids.items():
        if fluid.surface_tension:
            yield "fluids", name, "surface_tension"
        if fluid.interfacial_tension:
            yield "fluids", name, KEY


def _entries(case) -> Iterator[tuple[tuple[str, str], float]]:
    """Each tension between fluids as it is told: the two names, and its value in N/m."""
    for name, fluid in case.fluids.items():
        yield from (((name, other), value) for other, value in fluid.interfacial_tension.items())


def _told(case) -> Iterator[tuple[frozenset[str], float]]:
    """The same by pairs."""
    return ((_pair(*names), value) for names, value in _entries(case))


def _pair(one: str, other: str) -> frozenset[str]:
    return frozenset((one, other))
