"""Walls and bodies whose particles stand along their faces: what that contradicts."""

from collections.abc import Iterator

from psph.case.findings import Finding
from psph.case.keys import key
from psph.physics.walls.conditions import MIRROR

FITTED = key(
    "its particles stand in rows along its faces, not on the lattice: round and slanted faces are no stairs",
    False,
)
"""The key of what can be fitted."""


def fitted(case) -> Iterator[Finding]:
    """Fitted walls and bodies that have no faces to stand along, or beside what speaks of the lattice."""
    for entry in case.entries:
        if not (entry.of.rigid and entry.of.fitted):
            continue
        loc = (*entry.loc, "fitted")
        if case.space.dimensions == 1:
            yield loc, True, "a row of particles has no faces to stand along; remove this key"
        if entry.of.condition == MIRROR:
            yield loc, True, "a mirror is a plane without particles; remove this key"
        if case.space.refine:
            yield loc, True, "does not work with space.refine yet; take one of the two out"
