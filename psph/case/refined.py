"""Regions of a case where particles are finer, and the rules between their keys."""

from collections.abc import Iterator
from typing import Literal

from pydantic import PrivateAttr, field_validator
from pydantic_core import PydanticCustomError

from psph.acts import FLUIDS
from psph.case.findings import Finding, Location
from psph.case.keys import AXES, SIDES, Name, Table, key
from psph.case.measured import cannot_carry
from psph.case.placed import Answering, Named, Placed
from psph.case.shapes import Shape
from psph.physics.walls.conditions import BEARING, MIRROR


class Refined(Table):
    """A region whose fluid, walls and bodies have a finer spacing."""

    shape: Shape = key("the region")
    factor: Literal[1, 2, 4, 8] = key(
        "how many times finer particles are there; 1: they are not, as without this region", 2, unit="1"
    )
    moves_with: Name | None = key(
        "the moving wall or the body that carries the region along, as its middle goes; it does not turn",
        None,
        otherwise="the region stays where it is",
    )
    front: Literal[SIDES] | None = key(
        "the region goes along an axis as the fluid's farthest particle on this side does",
        None,
        otherwise="the region stays where it is",
    )

    _number: int = PrivateAttr(0)

    @field_validator("factor", mode="before")
    @classmethod
    def _a_number(cls, value):
        """Truth would pass for 1."""
        if isinstance(value, bool | str):
            raise PydanticCustomError("psph", "not a number; give 1, 2, 4 or 8, without quotes")
        return value

    @property
    def where(self) -> str:
        """Its key, as a person finds it in the case."""
        return f"space.refine[{self._number}]"

    @property
    def moves(self) -> bool:
        """Whether the region goes anywhere."""
        return bool(self.moves_with or self.front)

    @property
    def levels(self) -> int:
        """How many times the spacing is halved."""
        return self.factor.bit_length() - 1


def finer_of(every: tuple[Refined, ...]) -> tuple[Refined, ...]:
    """Those of a case's regions that have finer particles; each knows its number among all."""
    for n, one in enumerate(every):
        one._number = n
    return tuple(one for one in every if one.levels)


def refined(case) -> Iterator[Finding]:
    """Regions that cannot go where they are to go, and what finer particles do not work with yet."""
    for n, one in enumerate(case.space.refine):
        where = ("space", "refine", n)
        if one.moves_with and one.front:
            yield (*where, "front"), one.front, "the region goes with moves_with already; remove one of both"
        elif says := cannot_carry(case, one.moves_with):
            yield (*where, "moves_with"), one.moves_with, says
        elif one.front and one.front[0] not in AXES[: case.space.dimensions]:
            yield (*where, "front"), one.front, f"no such axis in {case.space.dimensions}D"
        elif one.front and one.front[0] in case.space.periodic:
            yield (*where, "front"), one.front, "nothing is farthest along an axis that repeats; take another"
    if any(one.levels for one in case.space.refine):
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
    if case.perturbations:
        yield ("perturbations",), "they name particles of one spacing"
    if case.frame.motion is not None:
        yield ("frame", "motion"), "frames with levels of sizes rest"
    if case.precision != "double":
        of_profile = f', which profile = "{case.profile}" brings' if case.profile else ""
        yield ("precision",), f'levels of sizes are in double precision, not "{case.precision}"{of_profile}'
    if case.physics.self_gravity is not None:
        yield ("physics", "self_gravity"), "it counts on one spacing"


def _unfit_flow(entry: Named) -> Iterator[tuple[Location, str]]:
    for told in ("surface_tension", "rheology"):
        if getattr(entry.of, told):
            yield (*entry.loc, told), "it has not been tried where sizes meet"
    for told in ("jitter", "start"):
        if getattr(entry.of, told) not in (0.0, "lattice"):
            yield (*entry.loc, told), "finer particles start on a lattice"
