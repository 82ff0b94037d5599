"""Lines of the rigid bodies of a case: springs, and chains with weight; and the rules between their keys."""

from collections.abc import Iterator

from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import Name, Place, Table, Vector, key


class Bed(Table):
    """The plane that a chain may lie on."""

    at: Vector = key("a point of it", unit="m")
    normal: Vector | None = key("direction out of it, of any length", None, unit="1", otherwise="upwards")
    friction: float = key("force that resists sliding over the weight that lies", 0.0, ge=0)


class ChainTable(Table):
    """What gives a line weight; it hangs in the heaviest fluid, at rest. In 2D one in each metre of depth."""

    mass: float = key("mass by length, in air", unit="kg/m", gt=0)
    diameter: float = key("that of a rod that displaces as much", unit="m", gt=0)
    axial_stiffness: float = key("force over strain", unit="N", gt=0)
    pieces: int = key("equal straight pieces that it is made of", 20, ge=2, le=200)
    damping_ratio: float = key("damping of its pieces, as part of critical", 0.1, ge=0, le=10)
    drag: float = key("coefficient of drag across it, by its diameter", 1.2, ge=0)
    skin_drag: float = key("that along it, by its circumference", 0.05, ge=0)
    added_mass: float = key("coefficient of the mass of water that goes along with it across", 1.0, ge=0)
    water_level: float | None = key(
        "height against gravity above which it is dry", None, unit="m", otherwise="it is in water everywhere"
    )
    bed: Bed | None = key("what it may lie on", None, otherwise="nothing")


class Line(Table):
    """A spring with a damper, or a mooring line, between a point of the body and another point."""

    at: Vector = key("the point of the body, where it is at the start", unit="m")
    anchor: Vector = key("the other point, where it is at the start", unit="m")
    to: Name | None = key(
        "the body or the wall that the other point belongs to", None, otherwise="none: it stays"
    )
    stiffness: float | None = key("force per length", None, unit="N/m", otherwise="give a chain", ge=0)
    length: float | None = key(
        "length without tension",
        None,
        unit="m",
        otherwise="the distance of the points at the start; with a pretension what makes that",
        ge=0,
    )
    pretension: float | None = key(
        "tension at the body at the start, in place of a length", None, unit="N", otherwise="none", gt=0
    )
    damping: float = key("force over the rate at which it lengthens", 0.0, unit="N s/m", ge=0)
    pulls_only: bool = key("it is slack when shorter than its length: a mooring line without weight", False)
    break_load: float | None = key("tension at which it parts", None, unit="N", otherwise="it holds", gt=0)
    chain: ChainTable | None = key("it has weight", None, otherwise="it is a spring without weight")

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """From end to end."""
        yield self.at, self.anchor


def tied(case, here, line: Line) -> Iterator[Finding]:
    """A line of the body at ``here`` that cannot be, in a case with space.dimensions."""
    name, known = here[1], {**case.bodies, **case.walls}
    if line.to is not None and (line.to not in known or line.to == name):
        says = "no other body or wall has this name; leave out to for a point in space"
        others = [other for other in known if other != name]
        yield (*here, "to"), line.to, says + (f"; {advise(line.to, others)}" if others else "")
    elif says := cannot_hold(case, line.to):
        yield (*here, "to"), line.to, says
    if line.length is not None and line.pretension is not None:
        yield (*here, "pretension"), line.pretension, "a length is given too; remove one of the two"
    if (line.stiffness is None) == (line.chain is None):
        yield here, ..., "give either stiffness, of a spring, or chain, with its axial_stiffness"
    elif line.chain is not None:
        yield from _as_a_chain(here, line)
    elif line.pretension is not None and not line.stiffness:
        yield (*here, "pretension"), line.pretension, "a spring without stiffness has none; give stiffness"


def cannot_hold(case, name: str | None) -> str | None:
    """Why a wall of this name can hold no line and no joint; None where it can, or there is none."""
    parts = [part for part in getattr(case.walls.get(name), "motion", None) or () if len(part.ways) == 1]
    if not all(part.is_rigid for part in parts):
        return "this wall deforms and holds no line and no joint; name another"
    if any(part.absorbs for part in parts):
        return "this wall absorbs waves and holds no line and no joint; remove absorb, or name another"
    return None


def _as_a_chain(here, line: Line) -> Iterator[Finding]:
    """Keys that a chain does not have, or that need others."""
    for given, value, says in (
        ("damping", line.damping, "a chain has chain.damping_ratio; remove damping"),
        ("pulls_only", line.pulls_only, "a chain never pushes; remove pulls_only"),
    ):
        if value:
            yield (*here, given), value, says
    if line.length == 0.0:
        yield (*here, "length"), 0.0, "a chain has some; give more"
    if line.length is None and line.pretension is None and line.at == line.anchor:
        yield (*here, "anchor"), line.anchor, "is where the line begins; give length, or move one end"
    bed = line.chain.bed
    if bed is not None and bed.normal is not None and not any(bed.normal):
        yield (*here, "chain", "bed", "normal"), bed.normal, "has no direction; give one"
