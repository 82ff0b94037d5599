"""Which kinds of matter a case has, and what is asked to act on others."""

from collections.abc import Iterator, Sequence

from psph.acts import BODIES, FLUIDS, SOILS, SOLIDS, UPDATED, acts_on
from psph.case.findings import Finding, asked_of


def matter_in(case) -> frozenset[str]:
    """The kinds of matter in a case (psph.acts)."""
    held = {
        FLUIDS: case.fluids,
        SOILS: case.soils,
        UPDATED: case.updated,
        SOLIDS: case.referred,
        BODIES: case.bodies,
    }
    return frozenset(kind for kind, tables in held.items() if tables)


def listed(words: Sequence[str]) -> str:
    """``a, b and c``."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def idle(case) -> Iterator[Finding]:
    """Effects that a case asks for, and that act on nothing in it; what a scheme sets asks for nothing."""
    here = matter_in(case)
    for name, value, effect in asked_of(case):
        acts = acts_on(effect)
        if here.isdisjoint(acts) and not case.preset(f"physics.{name}"):
            says = f"acts on {listed(acts)} alone, and the case has none; remove this key"
            yield ("physics", name), value, says
