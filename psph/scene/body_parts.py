"""The rigid bodies of a scene among its parts."""

from psph.physics.rigid.body import RigidBody
from psph.scene.census import Census


def bodies_of(census: Census) -> tuple[RigidBody, ...]:
    """What the bodies of a scene are: mass and inertia are those of their sites."""
    return tuple(census.motions[number] for number in census.layout.parts.bodies)
