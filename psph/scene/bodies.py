"""Mass and inertia of rigid bodies from the sites that they hold, and what holds them."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from psph.case.bodies import SLIDES, TURNS
from psph.case.motion import motion_of
from psph.case.parameters import as_numbers
from psph.physics.rigid.bodies import Bodies, Body
from psph.physics.rigid.lines import Line, longest_step
from psph.physics.rigid.pose import in_space
from psph.physics.solid.contact import SolidContact
from psph.scene.lattice import lattice_around
from psph.scene.mirrors import clipped
from psph.scene.shapes import bounds, inside

if TYPE_CHECKING:
    from psph.scene.scene import Scene


FINER = 7
"""By how much finer the lattice is that tells the volume of a shape."""


class Volume(NamedTuple):
    """``volume`` in m^d, ``centre`` (3,) m and ``spread`` (3, 3) m², the mean of (x − c)(x − c)ᵀ, of
    what is full."""

    volume: float
    centre: np.ndarray
    spread: np.ndarray

    def inertia(self, mass: float) -> np.ndarray:
        """Moments about the centre, kg m² (3, 3), of a ``mass`` in kg that fills it evenly."""
        return mass * (np.trace(self.spread) * np.eye(3) - self.spread)

    def surface(self, dimensions: int) -> float:
        """The surface, m^(d − 1), of a box of this spread, or of a cube of this volume if that has more."""
        d = dimensions
        sides = np.sqrt(12.0 * np.linalg.eigvalsh(self.spread[:d, :d]))
        box = 2.0 * sum(float(np.delete(sides, axis).prod()) for axis in range(d))
        return max(box, 2.0 * d * self.volume ** ((d - 1.0) / d))


def volume_of(scene: "Scene", material: int) -> Volume:
    """What the sites of a material fill, a cell of the lattice each."""
    d, dx, count = scene.dimensions, scene.spacing, 0
    middle = np.array(scene.lattice.lower)  # sums are taken about a point near by
    first, second = np.zeros(d), np.zeros((d, d))
    for begin, end in scene.lattice.chunks():
        held = scene.layout.materials(begin, end) == material
        grid = scene.lattice.grid(begin, end)
        x = np.stack([np.broadcast_to(a, held.shape)[held] for a in grid], axis=1) - middle
        count, first, second = count + len(x), first + x.sum(axis=0), second + x.T @ x
    if not count:
        return Volume(0.0, np.full(3, np.nan), np.full((3, 3), np.nan))
    mean = first / count
    spread = np.zeros((3, 3))
    spread[:d, :d] = second / count - np.outer(mean, mean) + dx * dx / 12.0 * np.eye(d)
    return Volume(count * dx**d, np.array(in_space(tuple(mean + middle))), spread)


def drawn_volume(scene: "Scene", shape) -> float:
    """The volume of a shape itself, m^d, this side of mirrors: that of the cells of a finer lattice in it."""
    fine = scene.spacing / FINER
    lattice = lattice_around([clipped(bounds(shape), scene.mirror_planes)], scene.lattice.lower, fine, None)
    count = sum(
        np.count_nonzero(np.broadcast_to(inside(shape, lattice.grid(*ends), 0.0), lattice.shape(*ends)))
        for ends in lattice.chunks()
    )
    return float(count) * fine**scene.dimensions


def rigid_bodies(scene: "Scene") -> tuple[Body, ...]:
    """The bodies of a scene."""
    return tuple(
        _body(scene, number, name, table)
        for number, (name, table) in enumerate(scene.case.bodies.items(), scene.layout.first_body)
    )


def _body(scene: "Scene", number: int, name: str, table) -> Body:
    filled, dimensions = volume_of(scene, number), scene.dimensions
    mass = table.mass or table.density * filled.volume
    inertia = filled.inertia(mass)
    if table.inertia is not None and dimensions == 2:
        inertia[2, 2] = table.inertia
    elif table.inertia is not None:
        inertia = np.array(table.inertia)
    spin = (0.0, 0.0, table.spin or 0.0) if dimensions == 2 else tuple(table.spin or (0.0,) * 3)
    freed = table.freed(dimensions)
    return Body(
        name,
        mass,
        in_space(table.centre) if table.centre else tuple(filled.centre.tolist()),
        tuple(inertia.ravel().tolist()),
        in_space(table.velocity),
        spin,
        tuple(one in freed for one in SLIDES),
        tuple(one in freed for one in TURNS),
        in_space(table.pivot) if table.pivot else None,
        table.held,
        motion_of(table.motion, scene.gravity),
    )


def shares_of(scene: "Scene") -> np.ndarray:
    """How the mass of each body is shared among its particles, kg: (bodies, 1 + dim).

    A particle that was at x₀ at the start has w_0 + Σ_d w_(1 + d) x₀_d: the same for each of N where the
    case leaves the centre of mass c to them, else M/N (1 + b·(x₀ − x̄)) with S b = c − x̄ and the spread S of
    the particles about their mean x̄, so that Σ w x₀ = M c.
    """
    found, d = [], scene.dimensions
    for number, one in enumerate(scene.rigid_bodies, scene.layout.first_body):
        filled, each = volume_of(scene, number), one.mass / float(scene.census.sizes[number])
        spread = filled.spread[:d, :d] - scene.spacing**2 / 12.0 * np.eye(d)
        slope = np.linalg.pinv(spread, rcond=1e-9) @ (np.array(one.centre) - filled.centre)[:d]
        found.append([each * (1.0 - slope @ filled.centre[:d]), *(each * slope)])
    return np.array(found)


def contact_of(scene: "Scene") -> SolidContact:
    """How the bodies of a scene rub and bounce: as its case says, or by default."""
    table = scene.case.physics.contact
    return SolidContact() if table is None else SolidContact(**as_numbers(table))


def density_ratio(scene: "Scene", body: Body) -> float:
    """The density of a body over that of its fluid."""
    number = [one.name for one in scene.species].index(body.name)
    volume = float(scene.census.sizes[number]) * scene.spacing**scene.dimensions
    return body.mass / volume / scene.species[number].density


def in_words(scene: "Scene", body: Body) -> str:
    """Mass, density over that of its fluid, centre and freedom of a body."""
    ratio = density_ratio(scene, body)
    freed = ", ".join(scene.case.bodies[body.name].freed(scene.dimensions)) or "nothing"
    where = ", ".join(f"{x:.4g}" for x in body.centre[: scene.dimensions])
    until = f"; held until {body.held:g} s" if body.held else ""
    beside = f"{ratio:.3g} of the fluid's density, " if scene.case.flowing else ""
    return f"{body.mass:.4g} kg, {beside}centre ({where}) m; free: {freed}{until}"


def lines_of(scene: "Scene", order: Sequence[str]) -> tuple[Line, ...]:
    """The lines of all bodies, whose rows have the names in ``order``."""
    rows = {name: row for row, name in enumerate(order)}
    return tuple(
        Line(
            f"{name}.{line}",
            rows[name],
            in_space(table.at),
            None if table.to is None else rows[table.to],
            in_space(table.anchor),
            table.stiffness,
            math.dist(table.at, table.anchor) if table.length is None else table.length,
            table.damping,
            table.pulls_only,
        )
        for name, body in scene.case.bodies.items()
        for line, table in body.lines.items()
    )


def body_step(scene: "Scene") -> float:
    """The longest step that the bodies of a scene stand, s.

    That of their lines; and in a fluid Δt ≤ 0.5 √(M/ρAh) h/c where a body weighs less than the fluid within
    h of its surface A, whose push in a step would move it too far, or turn it.  Contact is hard, and asks for
    no step of its own; that with elastic solids has one (psph.physics.solid.contact).
    """
    own = scene.rigid_bodies
    bodies = Bodies(own, scene.gravity)
    shortest = longest_step(lines_of(scene, [one.name for one in own]), bodies)
    h, c = scene.smoothing_length, scene.sound_speed
    for row, number in enumerate(range(scene.layout.first_body, scene.layout.first_body + len(own))):
        if scene.case.flowing and (any(own[row].slides) or any(own[row].turns)):
            filled = volume_of(scene, number)
            layer = scene.species[number].density * filled.surface(scene.dimensions) * h
            share = _lightest(bodies, row, filled) / layer
            shortest = min(shortest, 0.5 * share**0.5 * h / c) if share < 1.0 else shortest
    return shortest


def _lightest(bodies: Bodies, row: int, filled: Volume) -> float:
    """The mass of a body against a push, kg, or against one that turns it where it would be felt as less: the
    moment of inertia about the axis over the mean square of the distance to it."""
    masses = [bodies.bodies[row].mass] if any(bodies.bodies[row].slides) else []
    arm = filled.centre - bodies.reference[row]
    even = filled._replace(spread=filled.spread + np.outer(arm, arm)).inertia(1.0)
    if row in bodies.hinged:
        axis = bodies.axis[row]
        masses.append(float(bodies.about[bodies.hinged == row][0]) / float(axis @ even @ axis))
    elif row in bodies.tumbling:
        masses.append(float(np.linalg.eigvals(np.linalg.solve(even, bodies.inertia[row])).real.min()))
    return min(masses)
