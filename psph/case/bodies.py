"""Rigid bodies of a case: what they are, what holds them, and the rules between their keys."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Strict

from psph.acts import BODIES, FRAME, ONE, speaks_for
from psph.case.angles import CONTACT_ANGLE, ContactAngle
from psph.case.findings import Finding
from psph.case.fitted import FITTED
from psph.case.keys import AXES, Name, Vector, key
from psph.case.lines import Line, tied
from psph.case.motion import Motions, way_and_turn
from psph.case.placed import Placed
from psph.case.shapes import Shape
from psph.physics.walls.conditions import BEARING, DYNAMIC

MOST_PARTS = 250
"""Fluids, walls and bodies together: particles know theirs by one byte."""

SLIDES = AXES
"""Names of the free directions."""

TURNS = tuple(f"turn_{axis}" for axis in AXES)
"""Names of the free turns, each about an axis."""


def freedoms(dimensions: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The directions and the turns that there are."""
    return SLIDES[:dimensions], (TURNS[2:] if dimensions == 2 else TURNS if dimensions == 3 else ())


@speaks_for(BODIES)
class Body(Placed):
    """A rigid body that the fluid, its weight and lines move."""

    shape: Shape = key("where the body is at the start; it takes the place of fluids there")
    density: float | None = key(
        "mass over the volume of its particles", None, unit="kg/m3", otherwise="give mass", gt=0
    )
    mass: float | None = key(
        "its mass; in 2D per metre of depth", None, unit="kg", otherwise="give density", gt=0
    )
    centre: Vector | None = key(
        "centre of mass at the start", None, unit="m", otherwise="that of its particles"
    )
    inertia: Annotated[tuple[Vector, ...], Strict(False)] | float | None = key(
        "moment of inertia about the centre of mass: a number in 2D, three rows in 3D",
        None,
        unit="kg m2",
        otherwise="that of its particles",
    )
    free: Annotated[tuple[Literal[SLIDES + TURNS], ...], Strict(False)] | None = key(
        "how it is free to move: along x, y, z, and by turns about them, turn_x, turn_y, turn_z; of "
        "the turns none, one or all",
        None,
        otherwise="everything; with a pivot all turns",
    )
    pivot: Vector | None = key(
        "a point of the body that stays where it is: a hinge or a ball joint",
        None,
        unit="m",
        otherwise="none",
    )
    velocity: Vector | None = key("velocity at the start", None, unit="m/s", otherwise="zeros")
    spin: Vector | float | None = key(
        "angular velocity at the start: a number in 2D, three in 3D", None, unit="rad/s", otherwise="zeros"
    )
    motion: Motions | None = key(
        "prescribed motion in the directions that are not free, as `walls.NAME.motion`",
        None,
        otherwise="not at all",
    )
    held: float = key("until this time it stays where it is", 0.0, unit="s", ge=0)
    lines: dict[Name, Line] = key("springs, dampers and mooring lines by name", {})
    no_slip: bool = key("the fluid has the body's velocity at its face; needs a viscosity", False)
    condition: Literal[BEARING] = key("how it acts on the fluid, as the condition of a wall", DYNAMIC)
    contact_angle: ContactAngle | None = CONTACT_ANGLE
    fitted: bool = FITTED
    continues: Name | None = key(
        "the fluid whose density and initial pressure its particles have",
        None,
        otherwise="the first fluid",
    )

    word: ClassVar = BODIES
    called: ClassVar = "body"
    rigid: ClassVar = True
    whole: ClassVar = True
    keeps_form: ClassVar = True
    always_loaded: ClassVar = True
    not_absorbing: ClassVar = "a body"
    alone: ClassVar = (
        "rigid bodies need a fluid or an elastic solid; add a table [fluids.NAME], small and out of their "
        "way if they are dry"
    )
    refuses: ClassVar = {
        ONE: "bodies need two or three dimensions",
        FRAME: "bodies know of no frame that moves; remove one of the two, or move the tank",
    }

    def motions(self) -> dict[tuple, Any]:
        """In what it is not free to do."""
        return {(): self.motion}

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Bodies that cannot be."""
        yield from held_together(case)

    def freed(self, dimensions: int) -> tuple[str, ...]:
        """What it is free to do."""
        slides, turns = freedoms(dimensions)
        if self.free is None:
            return turns if self.pivot else (*slides, *turns)
        return self.free

    def restrained(self, dimensions: int) -> bool:
        """Whether something holds it: at first, or in what it is not free to do."""
        slides, turns = freedoms(dimensions)
        return self.held > 0.0 or not set(self.freed(dimensions)) >= {*slides, *turns}


def held_together(case) -> Iterator[Finding]:
    """Bodies that cannot be, in a case with space.dimensions."""
    dimensions = case.space.dimensions
    slides, turns = freedoms(dimensions)
    for name, body in case.bodies.items():
        here = ("bodies", name)
        if dimensions == 1:
            continue
        if (body.mass is None) == (body.density is None):
            yield here, ..., "give either mass or density"
        for place, one in enumerate(body.free or ()):
            if one not in (*slides, *turns):
                known = ", ".join((*slides, *turns))
                yield (*here, "free", place), one, f"there is no such motion in {dimensions}D; give {known}"
            elif one in body.free[:place]:
                yield (*here, "free", place), one, "stands there twice; remove one"
        freed = body.freed(dimensions)
        if dimensions == 3 and sum(one in turns for one in freed) == 2:
            yield (
                (*here, "free"),
                ...,
                "two turns; a body turns about no axis, one, or all three",
            )
        if body.pivot and set(freed) & set(slides):
            yield (
                (*here, "pivot"),
                body.pivot,
                "what has a pivot moves along no axis; let free hold turns only",
            )
        yield from _sized(here, body, dimensions)
        yield from _without_effect(here, body, freed, dimensions)
        if body.motion and set(freed) >= {*slides, *turns}:
            yield (
                (*here, "motion"),
                ...,
                "the body is free to do everything; give free = [...] without what moves so",
            )
        elif body.motion:
            yield from _moved_and_free(here, body, freed)
        for line, table in body.lines.items():
            yield from tied(case, (*here, "lines", line), table)
    parts = len(case.fluids) + len(case.walls) + len(case.bodies)
    if parts > MOST_PARTS:
        says = f"{parts} fluids, walls and bodies; a case holds {MOST_PARTS} at most, so join some by union"
        yield ("bodies",), ..., says
    for name in case.bodies.keys() & (case.fluids.keys() | case.walls.keys()):
        yield ("bodies", name), ..., "a fluid or a wall has this name too; give the body another"


def _without_effect(here, body: Body, freed, dimensions: int) -> Iterator[Finding]:
    """A velocity or a spin of the start in what the body is not free to do, and one held that moves."""
    slides, turns = freedoms(dimensions)
    stuck = [axis for axis, v in zip(slides, body.velocity or ()) if v and axis not in freed]
    if stuck:
        remedy = "give spin instead" if body.pivot else f"give 0 there, or let free hold {', '.join(stuck)}"
        yield (*here, "velocity"), body.velocity, f"the body is not free to move along {stuck[0]}; {remedy}"
    spin = (body.spin,) if isinstance(body.spin, float) else body.spin or ()
    stiff = [turn for turn, w in zip(turns, spin) if w and turn not in freed]
    if stiff and len(spin) == len(turns):
        remedy = f"give 0 there, or let free hold {', '.join(stiff)}"
        yield (*here, "spin"), body.spin, f"the body is not free to do {stiff[0]}; {remedy}"
    if body.held and body.motion:
        says = "a body that moves as told is not held; remove held, and give the parts of motion a start"
        yield (*here, "held"), body.held, says


def _moved_and_free(here, body: Body, freed) -> Iterator[Finding]:
    """Parts of a motion in what the body is free to do, as far as their keys tell."""
    for part in body.motion or ():
        if len(part.ways) != 1:
            continue  # which is refused elsewhere
        way, turned = way_and_turn(part)
        free = [axis for axis, x in zip(SLIDES, way) if x and axis in freed]
        free += [turn for turn in TURNS if turned and turn in freed]
        if free:
            says = (
                f"{part.way}: the body is free to do {free[0]}, where forces move it; leave {free[0]} out of "
            )
            yield (*here, "motion"), ..., f"{says}free, or out of motion"


def _sized(here, body: Body, dimensions: int) -> Iterator[Finding]:
    """Numbers in 2D, vectors and matrices in 3D."""
    flat = dimensions == 2
    if body.spin is not None and isinstance(body.spin, float) != flat:
        yield (*here, "spin"), body.spin, "give one number in 2D, three in 3D"
    if body.inertia is None:
        return
    if isinstance(body.inertia, float) != flat:
        yield (*here, "inertia"), body.inertia, "give one number in 2D, three rows of three in 3D"
    elif flat and body.inertia <= 0.0:
        yield (*here, "inertia"), body.inertia, "is not above zero; a body has some"
    elif not flat:
        yield from _positive(here, body.inertia)


def _positive(here, rows) -> Iterator[Finding]:
    loc = (*here, "inertia")
    if len(rows) != 3 or any(len(row) != 3 for row in rows):
        yield loc, rows, "give three rows of three numbers"
        return
    matrix = np.array(rows)
    moments = np.linalg.eigvalsh(matrix)
    if not np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0):
        yield loc, rows, "is not symmetric; let row i have in place j what row j has in place i"
    elif moments[0] <= 0.0 or moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
        yield loc, rows, "no mass has such moments: each is above zero and none exceeds the sum of the others"
