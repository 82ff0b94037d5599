"""What a case places: tables whose entries have particles, and what each of them answers."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, NamedTuple

from psph.acts import BONDED, FLOWING, SIZED
from psph.case.findings import Finding, Location
from psph.case.keys import Place, Table, Vector, key
from psph.physics.catalogue import Catalogue


class Answering(Table):
    """An entry of a table of a case with rules of its own."""

    beside_sizes: ClassVar[bool] = False
    """Whether it works where particles are of several levels of sizes (space.refine)."""

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """What contradicts itself in such tables of a case, whether it has entries or not."""
        yield from ()

    @classmethod
    def with_more(cls, catalogue: Catalogue) -> "type[Answering]":
        """Such an entry with all that a ``catalogue`` offers for it; itself where that is what psph has."""
        return cls


class Placed(Answering):
    """An entry of a table of a case that holds particles; rules between keys ask these of it, and know no
    table by its name."""

    called: ClassVar[str] = ""
    """What a person calls it where it is pushed."""
    rigid: ClassVar[bool] = False
    """Whether it moves as a whole, as it is told, or not at all: what moves freely runs into it."""
    keeps_form: ClassVar[bool] = False
    """Whether it keeps its form, so that it may hang, stand or fly by itself."""
    whole: ClassVar[bool] = False
    """Whether forces move it as a whole."""
    poured: ClassVar[bool] = False
    """Whether a region may let more of it in."""
    takes_pistons: ClassVar[bool] = False
    """Whether a plane mirror that moves may press it."""
    takes_own_steps: ClassVar[bool] = False
    """Whether each of its particles can take a step of its own (psph.simulation.each_step)."""
    always_loaded: ClassVar[bool] = False
    """Whether the push of what flows is summed on it in any case."""
    not_absorbing: ClassVar[str] = ""
    """What of it moves as it is told and cannot answer to waves; empty where that can."""
    alone: ClassVar[str] = ""
    """What is said where nothing in the case moves freely; empty where it would."""

    @property
    def word(self) -> str:
        """What it is among the words of psph.acts; of a wall its condition."""
        return ""

    @property
    def rubs(self) -> bool:
        """Whether it flows with a friction of its own."""
        return False

    @property
    def flows(self) -> bool:
        """Whether it moves freely and finds its neighbours in space."""
        return self.word in FLOWING

    @property
    def finds(self) -> bool:
        """Whether its particles find their neighbours in space, of one size or of many."""
        return self.flows or self.word in SIZED

    @property
    def moves_freely(self) -> bool:
        """Whether forces move its particles one by one."""
        return self.finds or self.word in BONDED

    def pushed(self, case) -> bool:
        """Whether what flows pushes it, so that a force on it is known."""
        return self.rigid

    @classmethod
    def held_parts(cls, entry: Mapping[str, Any]) -> int:
        """How many parts of an entry are groups of particles of their own, as a file has it."""
        return 0

    def motions(self) -> dict[Location, Any]:
        """The parts of each motion of it that is told, by the location of its key in the entry."""
        return {}

    def said(self, table: str, name: str) -> tuple[Location, Any]:
        """The key that says so, and its value."""
        return (table,), ...


class HardPlane(Answering):
    """A rigid plane without an end, that holds no particles: matter with forces of its own may hit it."""

    at: Vector = key("a point of the plane", unit="m")
    normal: Vector = key("direction out of it, of any length", unit="1")

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its point and, in the direction out of it, a line of 1 m."""
        yield self.at, tuple(x + n for x, n in zip(self.at, self.outward))

    @property
    def outward(self) -> tuple[float, ...]:
        """The unit vector out of it."""
        size = math.hypot(*self.normal)
        return tuple(n / size for n in self.normal)


class Named(NamedTuple):
    """An entry ``of`` a ``table`` of the case, by its ``name``."""

    table: str
    name: str
    of: Any

    @property
    def loc(self) -> Location:
        """Where it stands."""
        return self.table, self.name


def names_of(entries, *words: str) -> list[str]:
    """The names of those ``entries`` that are what one of some ``words`` of psph.acts says."""
    return [entry.name for entry in entries if entry.of.word in words]
