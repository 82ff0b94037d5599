"""Regions of a case where particles are finer, and the rules between their keys."""

from collections.abc import Iterator
from typing import Literal

from psph.acts import FLUIDS
from psph.case.findings import Finding, Location
from psph.case.keys import Table, key
from psph.case.placed import Answering, Named, Placed
from psph.case.shapes import Shape
from psph.physics.walls.conditions import BEARING, MIRROR


class Refined(Table):
    """A region whose fluid, walls and bodies have a finer spacing."""

    shape: Shape = key("the region")
    factor: Literal[2, 4, 8] = key("how many times finer particles are there", 2, unit="1")

    @property
    def levels(self) -> int:
        """How many times the spacing is halved."""
        return self.factor.bit_length() - 1


def refined(case) -> Iterator[Finding]:
    """What finer particles do not work with yet."""
    if case.space.refine:
        for loc, what in _unfit(case):
            yield loc, ..., f"does not work with space.refine yet: {what}; take one of the two out"


def _unfit(case) -> Iterator[tuple[Location, str]]:
    """Keys, and what of them levels of sizes do not serve."""
    flowing = [entry for entry in case.entries if entry.of.word == FLUIDS]
    for entry in case.entries:
        if entry.of.word == FLUIDS:
            yield from _unfit_flow(entry)
        elif entry.of.rigid:
            if entry.of.condition not in (*BEARING, MIRROR):
                yield (*entry.loc, "condition"), "it counts on one spacing"
        else:
            yield entry.loc, "only fluids, walls and bodies have them"
    for table, of in case.tables_of(Answering).items():
        if not (issubclass(of, Placed) or of.beside_sizes) and getattr(case, table):
            yield (table,), "what comes, goes or stops has one spacing"
    if len(flowing) > 1:
        yield flowing[1].loc, "one fluid has them"
    if case.frame.motion is not None:
        yield ("frame", "motion"), "frames with levels of sizes rest"
    if case.precision != "double":
        yield ("precision",), "levels of sizes are in double precision"
    if case.physics.self_gravity is not None:
        yield ("physics", "self_gravity"), "it counts on one spacing"


def _unfit_flow(entry: Named) -> Iterator[tuple[Location, str]]:
    for told in ("surface_tension", "rheology"):
        if getattr(entry.of, told):
            yield (*entry.loc, told), "it has not been tried where sizes meet"
    for told in ("jitter", "start"):
        if getattr(entry.of, told) not in (0.0, "lattice"):
            yield (*entry.loc, told), "finer particles start on a lattice"
