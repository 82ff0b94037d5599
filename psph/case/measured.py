"""Rules between the keys that say what a run measures and writes."""

from collections.abc import Iterator

from psph.acts import acts_on
from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import AXES
from psph.case.placed import names_of

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
    """Gauges of what is not there, or of which nothing is known."""
    axes = AXES[: case.space.dimensions]
    for name, gauge in case.gauges.items():
        asked = getattr(gauge, gauge.kind)
        if getattr(asked, "axis", None) is not None and asked.axis not in axes:
            where = f"no axis in {case.space.dimensions}D; give one of {', '.join(axes)}"
            yield ("gauges", name, gauge.kind, "axis"), asked.axis, where
        if says := cannot_carry(case, getattr(asked, "moves_with", None)):
            yield ("gauges", name, gauge.kind, "moves_with"), asked.moves_with, says
        of, known = getattr(asked, "of", None), names_of(case.entries, *acts_on(asked))
        if isinstance(of, str) and of not in known and hasattr(asked, "measures"):
            says = f"no {asked.measures} has this name; {advise(of, known)}"
            yield ("gauges", name, gauge.kind, "of"), of, says
        if hasattr(asked, "contradictions"):
            yield from (
                (("gauges", name, gauge.kind, *loc), value, says)
                for loc, value, says in asked.contradictions(case)
            )


def cannot_carry(case, name: str | None) -> str | None:
    """Why what has a name cannot carry a gauge or a region along, in words; None where it can, or without a
    name."""
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
    cadences = [(("output", name), every) for name, every in case.output if name != "fields"]
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
