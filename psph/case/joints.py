"""Joints of the rigid bodies of a case, and the rules between their keys."""

from collections.abc import Iterator
from typing import Annotated, ClassVar

from pydantic import Field, Strict

from psph.acts import BODIES
from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import Name, Place, Table, Vector, key
from psph.case.lines import cannot_hold
from psph.case.placed import Answering

Limits = Annotated[tuple[float, ...], Strict(False), Field(min_length=2, max_length=2)]


class Hinge(Table):
    """A joint about an axis."""

    at: Vector = key("a point of the axis, where it is at the start", unit="m")
    axis: Vector | None = key("its direction at the start; in 3D", None, unit="1", otherwise="z, in 2D")
    limits: Limits | None = key(
        "smallest and largest angle of the first body seen from the other, 0 at the start",
        None,
        unit="degrees",
        otherwise="none",
    )
    latch: bool = key("what has reached a limit stays there", False)
    restitution: float = key("speed after over that before at a limit", 0.0, unit="1", ge=0, le=1)
    stiffness: float = key("torque of a spring by its angle", 0.0, unit="N m", ge=0)
    rest: float = key("the angle without torque", 0.0, unit="degrees")
    damping: float = key("torque of a damper over the angular velocity", 0.0, unit="N m s", ge=0)

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """A point of its axis, in 3D with the direction."""
        yield (self.at,) if self.axis is None else (self.at, tuple(x + n for x, n in zip(self.at, self.axis)))


class Slider(Table):
    """A joint along a way, without a turn."""

    along: Vector = key("its direction at the start, fixed to the other", unit="1")
    limits: Limits | None = key(
        "smallest and largest way of the first body, 0 at the start", None, unit="m", otherwise="none"
    )
    latch: bool = key("what has reached a limit stays there", False)
    restitution: float = key("speed after over that before at a limit", 0.0, unit="1", ge=0, le=1)
    stiffness: float = key("force of a spring by its way", 0.0, unit="N/m", ge=0)
    rest: float = key("the way without force", 0.0, unit="m")
    damping: float = key("force of a damper over the speed", 0.0, unit="N s/m", ge=0)


class BallJoint(Table):
    """A point of both bodies, about which they turn."""

    at: Vector = key("the point, where it is at the start", unit="m")

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its point."""
        yield (self.at,)


class FixedJoint(Table):
    """Both move as one."""


class Rod(Table):
    """A rod without mass between two points."""

    at: Vector = key("the point of the first body, where it is at the start", unit="m")
    anchor: Vector = key("that of the other, where it is at the start", unit="m")

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """From point to point."""
        yield self.at, self.anchor


KINDS = ("hinge", "slider", "ball", "fixed", "rod")
ANOTHER = "one kind of joint is required"
"""The default of the kinds, of which one is given."""


class JointTable(Answering):
    """A joint of a body with another body, with a wall, or with what stands still."""

    of: Annotated[tuple[Name, ...], Strict(False), Field(min_length=1, max_length=2)] = key(
        "the body, and the body or the wall that it is joined to; one name: to a place that stays"
    )
    hinge: Hinge | None = key("they turn about an axis", None, otherwise=ANOTHER)
    slider: Slider | None = key("they slide along a way", None, otherwise=ANOTHER)
    ball: BallJoint | None = key("they turn about a point", None, otherwise=ANOTHER)
    fixed: FixedJoint | None = key("they move as one", None, otherwise=ANOTHER)
    rod: Rod | None = key("two points keep their distance", None, otherwise=ANOTHER)

    acts: ClassVar = (BODIES,)
    beside_sizes: ClassVar = True

    @property
    def kind(self) -> str:
        """The key that says what it is."""
        return next((name for name in KINDS if getattr(self, name) is not None), "")

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Joints that cannot be, in a case with space.dimensions."""
        for name, joint in case.joints.items():
            loc = ("joints", name)
            given = [one for one in KINDS if getattr(joint, one) is not None]
            if len(given) != 1:
                said = f"{' and '.join(given)} in one joint" if given else "does not say what it is"
                yield loc, ..., f"{said}; give one of {', '.join(KINDS)}"
                continue
            yield from _joined(case, loc, joint)
            yield from _drawn((*loc, joint.kind), getattr(joint, joint.kind), case.space.dimensions)


def _joined(case, loc, joint: JointTable) -> Iterator[Finding]:
    """Names that are none, or twice the same."""
    for place, (name, known) in enumerate(zip(joint.of, (case.bodies, {**case.bodies, **case.walls}))):
        if name not in known:
            says = "no body has this name" if place == 0 else "no body or wall has this name"
            yield (*loc, "of", place), name, f"{says}; {advise(name, known)}"
    if says := cannot_hold(case, joint.of[-1]):
        yield (*loc, "of", len(joint.of) - 1), joint.of[-1], says
    if len(set(joint.of)) < len(joint.of):
        yield (*loc, "of"), list(joint.of), "is one and the same; name two"


def _drawn(loc, told, dimensions: int) -> Iterator[Finding]:
    """Axes without a direction, rods without a length, limits in the wrong order, or not at 0, a latch
    without any, and a rest of no spring."""
    if getattr(told, "rest", 0.0) and not told.stiffness:
        yield (*loc, "rest"), told.rest, "there is no spring; give stiffness, or remove rest"
    if isinstance(told, Rod) and told.at == told.anchor:
        yield (*loc, "anchor"), list(told.anchor), "is where the rod begins; move it, or give ball"
    if isinstance(told, Hinge) and (told.axis is None) == (dimensions == 3):
        says = "in 3D a hinge has an axis; add axis = [...]"
        yield loc, ..., says if dimensions == 3 else "in 2D all turn about z; remove axis"
    for name in ("axis", "along"):
        if (way := getattr(told, name, None)) is not None and not any(way):
            yield (*loc, name), list(way), "has no direction; give one"
    if limits := getattr(told, "limits", None):
        if not limits[0] <= 0.0 <= limits[1] or limits[0] == limits[1]:
            says = "gives the smallest and the largest, and 0, where it starts, is not between; change them"
            yield (*loc, "limits"), list(limits), says
    for name in ("latch", "restitution"):
        if getattr(told, name, False) and not getattr(told, "limits", None):
            yield (*loc, name), getattr(told, name), f"needs limits; give them, or remove {name}"
    if getattr(told, "latch", False) and told.restitution:
        yield (*loc, "restitution"), told.restitution, "what latches does not bounce; remove one of the two"
