"""Rules between the keys that say what a run measures and writes."""

from collections.abc import Iterator

from psph.acts import UPDATED, refusals
from psph.case.errors import advise
from psph.case.findings import Finding, keys_one_sided
from psph.case.keys import AXES
from psph.case.solids import anvils_of, clamps_of

MOST_MOMENTS = 1e9
"""Moments of one cadence: far below 1e12, where rounding would shift them."""


def probed(case) -> Iterator[Finding]:
    """Probes that say too much or too little."""
    for name, probe in case.probes.items():
        if (probe.position is None) == (probe.front is None):
            yield ("probes", name), ..., "give either position or front"
        elif probe.extent and (probe.front or min(probe.extent) < 0.0):
            yield ("probes", name, "extent"), probe.extent, "give lengths of 0 or more, beside a position"


def gauged(case) -> Iterator[Finding]:
    """Gauges of walls that are not there, or on which no force is known."""
    axes = AXES[: case.space.dimensions]
    for name, gauge in case.gauges.items():
        asked = getattr(gauge, gauge.kind)
        if getattr(asked, "axis", None) is not None and asked.axis not in axes:
            where = f"no axis in {case.space.dimensions}D; give one of {', '.join(axes)}"
            yield ("gauges", name, gauge.kind, "axis"), asked.axis, where
        if says := _cannot_carry(case, getattr(asked, "moves_with", None)):
            yield ("gauges", name, gauge.kind, "moves_with"), asked.moves_with, says
        counts = gauge.level or gauge.run_up or gauge.highest or gauge.flow
        if counts and counts.of is not None and counts.of not in case.flowing:
            says = f"no fluid or soil has this name; {advise(counts.of, case.flowing)}"
            yield ("gauges", name, gauge.kind, "of"), counts.of, says
        if gauge.motion and gauge.motion.of not in case.bodies:
            says = f"no body has this name; {advise(gauge.motion.of, case.bodies)}"
            yield ("gauges", name, "motion", "of"), gauge.motion.of, says
        if gauge.displacement and gauge.displacement.of not in case.solids:
            says = f"no solid has this name; {advise(gauge.displacement.of, case.solids)}"
            yield ("gauges", name, "displacement", "of"), gauge.displacement.of, says
        if gauge.stress and gauge.stress.of not in (known := case.soils | case.solids):
            says = f"no solid or soil has this name; {advise(gauge.stress.of, known)}"
            yield ("gauges", name, "stress", "of"), gauge.stress.of, says
        for place, support in enumerate(gauge.reaction.of if gauge.reaction else ()):
            if says := _bears_nothing(case, gauge.reaction, support):
                yield ("gauges", name, "reaction", "of", place), support, says
        for key in keys_one_sided(case) if gauge.force else ():
            says = f"{key} does not push back what pushes, so that no force on a wall is known; take another"
            yield ("gauges", name, "force"), ..., says
        for place, wall in enumerate(gauge.force.on if gauge.force else ()):
            loc = ("gauges", name, "force", "on", place)
            if wall in case.solids and case.fluids:
                continue
            if wall not in case.boundaries:
                known = {**case.boundaries, **(case.solids if case.fluids else {})}
                what = "no wall or body" if not case.solids else "no wall, body or solid in a fluid"
                yield loc, wall, f"{what} has this name; {advise(wall, known)}"
            elif says := refusals(gauge.force).get(case.boundaries[wall].condition):
                yield loc, wall, says


def _bears_nothing(case, asked, support: str) -> str | None:
    """Why no force on the ``support`` of a key is known, in words; None where it is."""
    if support in clamps_of(case.updated):
        return refusals(asked)[UPDATED]
    known = [*clamps_of(case.referred), *anvils_of(case)]
    return None if support in known else f"no clamp or anvil has this key; {advise(support, known)}"


def _cannot_carry(case, name: str | None) -> str | None:
    """Why what has a name cannot carry a gauge along, in words; None where it can, or there is no name."""
    if name is None:
        return None
    if name not in case.boundaries:
        return f"no wall or body has this name; {advise(name, case.boundaries)}"
    if name in case.walls and not case.walls[name].motion:
        return "this wall stands still; give it a motion, or remove moves_with"
    if not all(part.is_rigid for part in case.boundaries[name].motion or () if len(part.ways) == 1):
        return "this wall deforms and carries nothing along; remove moves_with"
    return None


def due(case) -> Iterator[Finding]:
    """Intervals so short that moments of output would be lost in rounding."""
    end = case.time.end
    cadences = [(("output", name), interval) for name, interval in case.output]
    cadences += [(("gauges", name, "every"), gauge.every) for name, gauge in case.gauges.items()]
    for loc, interval in cadences:
        if interval is not None and end > MOST_MOMENTS * interval:
            yield (
                loc,
                interval,
                (
                    f"gives more than {MOST_MOMENTS:.0e} outputs until {end:g} s; give at least "
                    f"{1.1 * end / MOST_MOMENTS:.2g} (an interval below the time step writes every step)"
                ),
            )
