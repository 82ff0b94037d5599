"""What holds rigid bodies, how their particles share their mass, and what they ask of the time step."""

import math

import numpy as np

from psph.case.parameters import as_numbers
from psph.physics.fluid.friction import friction_step
from psph.physics.fluid.rheology import thickest
from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.lines import longest_step
from psph.physics.solid.contact import SolidContact
from psph.scene.body_parts import bodies_of
from psph.scene.joints import joint_step
from psph.scene.levels import Levels
from psph.scene.lines import lines_of
from psph.scene.scene import Scene
from psph.scene.volumes import Volume, volume_of


def shares_of(scene: Scene) -> np.ndarray:
    """How the mass of each body is shared among its particles, kg: (bodies, 1 + dim).

    A particle that was at x₀ at the start has w_0 + Σ_d w_(1 + d) x₀_d: the same for each of N where the
    case leaves the centre of mass c to them, else M/N (1 + b·(x₀ − x̄)) with S b = c − x̄ and the spread S of
    the particles about their mean x̄, so that Σ w x₀ = M c.
    """
    found, d = [], scene.dimensions
    for number, one in zip(scene.layout.parts.bodies, bodies_of(scene.census)):
        filled, each = volume_of(scene.layout, number), one.mass / float(scene.census.sizes[number])
        spread = filled.spread[:d, :d] - scene.spacing**2 / 12.0 * np.eye(d)
        slope = np.linalg.pinv(spread, rcond=1e-9) @ (np.array(one.centre) - filled.centre)[:d]
        found.append([each * (1.0 - slope @ filled.centre[:d]), *(each * slope)])
    return np.array(found)


def contact_of(scene: Scene) -> SolidContact:
    """How the bodies of a scene rub and bounce: as its case says, or by default."""
    table = scene.case.physics.contact
    return SolidContact() if table is None else SolidContact(**as_numbers(table))


def density_ratio(scene: Scene, body: RigidBody) -> float:
    """The density of a body over that of its fluid."""
    number = [one.name for one in scene.species].index(body.name)
    volume = float(scene.census.sizes[number]) * scene.spacing**scene.dimensions
    return body.mass / volume / scene.species[number].density


def in_words(scene: Scene, body: RigidBody) -> str:
    """Mass, density over that of its fluid, centre and freedom of a body."""
    ratio = density_ratio(scene, body)
    freed = ", ".join(scene.case.bodies[body.name].freed(scene.dimensions)) or "nothing"
    where = ", ".join(f"{x:.4g}" for x in body.centre[: scene.dimensions])
    until = f"; held until {body.held:g} s" if body.held else ""
    matter = "fluid" if scene.case.fluids else "soil"
    beside = f"{ratio:.3g} of the {matter}'s density, " if scene.case.flowing else ""
    return f"{body.mass:.4g} kg, {beside}centre ({where}) m; free: {freed}{until}"


def body_step(scene: Scene, passes: int = 1) -> float:
    """The longest step of so many rate ``passes`` that the bodies of a scene stand, s.

    That of their lines and of what is in their joints; and in a fluid Δt ≤ 0.5 √(M/ρAh) h/c where a body
    weighs less than the fluid within h of its surface A, whose push in a step would move it too far, or turn
    it.  A viscous fluid brakes such a body within M/ρAh of the time in which it comes to rest itself: Δt ≤
    2M/ρAh of the limit of its viscosity.  Contact is hard, and asks for no step of its own; that with elastic
    solids has one (psph.physics.solid.contact).
    """
    own = bodies_of(scene.census)
    bodies = Bodies(own, scene.gravity)
    shortest = longest_step(lines_of(scene, [one.name for one in own]), bodies)
    shortest = min(shortest, joint_step(scene, bodies))
    share = lightest_share(scene)
    if share < 1.0:
        shortest = min(shortest, 0.5 * passes * share**0.5 * scene.smoothing_length / scene.sound_speed)
    if share < BRAKED and (viscosity := thickest(scene)):
        shortest = min(shortest, braked(share, friction_step(scene, viscosity)))
    return shortest


BRAKED = 0.5
"""Part of the fluid within h of its surface below which friction brakes a body faster than the fluid."""


def braked(share: float, step: float) -> float:
    """The longest step, s, of a body with such a ``share`` where fluid alone stands ``step``."""
    return min(share / BRAKED, 1.0) * step


def lightest_share(scene: Scene) -> float:
    """The least mass of a body that may move over that of the fluid within h of its surface, M/ρAh; of those
    that stay in finer fluid on another level."""
    bodies, found = Bodies(bodies_of(scene.census), scene.gravity), [math.inf]
    for row, number in enumerate(scene.layout.parts.bodies):
        own = bodies.bodies[row]
        stays = Levels(scene.layout).carried_by(own.name) > getattr(scene, "level", 0)
        if scene.case.flowing and (any(own.slides) or any(own.turns)) and not stays:
            filled = volume_of(scene.layout, number)
            surface = filled.surface(scene.dimensions)
            layer = scene.species[number].density * surface * scene.smoothing_length
            found.append(_lightest(bodies, row, filled) / layer)
    return min(found)


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
