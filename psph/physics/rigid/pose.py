"""The pose of a rigid thing at a moment, how poses add up, and the maps that place its particles.

Everything here is in 3D: a scene in 2D lies in the plane of x and y and turns about z, one in 1D lies on
the x axis.  Vectors are tuples of three numbers, matrices tuples of nine, by rows.  It is plain Python,
evaluated once a step on every rank.
"""

import math
from typing import NamedTuple

import numpy as np

from psph.vectors import Vector, add, dot, scale, subtract

ZERO = (0.0, 0.0, 0.0)
IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

PLACE, VELOCITY, ACCELERATION, PREDICTED = 0, 1, 2, 3
"""Numbers of the three maps of a pose, see :func:`maps`, and of the velocity that friction reads
(psph.simulation.poses)."""


class Pose(NamedTuple):
    """Where a rigid thing is, how it is turned, and how both change.

    A point of it that was at x₀ is at x = X + R (x₀ − c), where the reference point c has come to X:
    ``reference`` c and ``translation`` X in m, ``rotation`` R.  With r = R (x₀ − c) its velocity is
    V + ω × r, its acceleration A + α × r + ω × (ω × r): ``velocity`` V in m/s and ``acceleration`` A in
    m/s² of the reference point, ``angular_velocity`` ω in rad/s, ``angular_acceleration`` α in rad/s².
    """

    reference: Vector = ZERO
    translation: Vector = ZERO
    rotation: Vector = IDENTITY
    velocity: Vector = ZERO
    angular_velocity: Vector = ZERO
    acceleration: Vector = ZERO
    angular_acceleration: Vector = ZERO

    def place(self, point: Vector) -> Vector:
        """Where a point has come that was at ``point``, m."""
        return add(self.translation, turned(self.rotation, subtract(point, self.reference)))

    def velocity_of(self, point: Vector) -> Vector:
        """The velocity of that point, m/s."""
        arm = turned(self.rotation, subtract(point, self.reference))
        return add(self.velocity, cross(self.angular_velocity, arm))

    def acceleration_of(self, point: Vector) -> Vector:
        """The acceleration of that point, m/s²."""
        arm, w = turned(self.rotation, subtract(point, self.reference)), self.angular_velocity
        whirl = add(cross(self.angular_acceleration, arm), cross(w, cross(w, arm)))
        return add(self.acceleration, whirl)


def combined(first: Pose, second: Pose) -> Pose:
    """The pose of what moves by ``first`` on something that moves by ``second``.

    x = second(first(x₀)).  With r = R₂ (X₁ − c₂), u = R₂ V₁ and ω₂, α₂ of the second:
    A = A₂ + α₂ × r + ω₂ × (ω₂ × r) + 2 ω₂ × u + R₂ A₁, where 2 ω₂ × u is the acceleration of Coriolis,
    and ω = ω₂ + R₂ ω₁, α = α₂ + R₂ α₁ + ω₂ × R₂ ω₁.
    """
    w, turn = second.angular_velocity, second.rotation
    own, spin = turned(turn, first.velocity), turned(turn, first.angular_velocity)
    gained = add(turned(turn, first.acceleration), scale(cross(w, own), 2.0))
    spun = add(turned(turn, first.angular_acceleration), cross(w, spin))
    return Pose(
        first.reference,
        second.place(first.translation),
        product(turn, first.rotation),
        add(second.velocity_of(first.translation), own),
        add(w, spin),
        add(second.acceleration_of(first.translation), gained),
        add(second.angular_acceleration, spun),
    )


def maps(pose: Pose, dimensions: int) -> np.ndarray:
    """Place, velocity and acceleration of a point as affine maps of where it was: (3, dim, 1 + dim).

    Component d of each is m[d, 0] + Σ_e m[d, 1 + e] x₀_e, with the matrices R, [ω] R and
    ([α] + [ω]²) R of the pose, [ω] r = ω × r.
    """
    w, turn = pose.angular_velocity, pose.rotation
    columns = [turn[e::3] for e in range(3)]
    moving = [cross(w, column) for column in columns]
    bending = [
        add(cross(pose.angular_acceleration, column), cross(w, change))
        for column, change in zip(columns, moving)
    ]
    found = np.empty((3, dimensions, 1 + dimensions))
    starts = (pose.translation, pose.velocity, pose.acceleration)
    for which, (start, matrix) in enumerate(zip(starts, (columns, moving, bending))):
        for d in range(dimensions):
            row = tuple(column[d] for column in matrix)
            found[which, d, 0] = start[d] - dot(row, pose.reference)
            found[which, d, 1:] = row[:dimensions]
    return found


def inertia(pose: Pose, gravity: Vector, dimensions: int) -> np.ndarray:
    """What a frame with this ``pose`` adds to gravity (psph.physics.fluid.frame): (2, dim, 1 + dim).

    An affine map of the place and one of the velocity, as those of :func:`maps`; ``gravity`` in m/s².
    """
    back, (_, moving, bending) = transposed(pose.rotation), maps(pose, 3)
    found = np.zeros((2, dimensions, 1 + dimensions))
    pull = subtract(subtract(turned(back, gravity), gravity), turned(back, tuple(bending[:, 0].tolist())))
    for d in range(dimensions):
        found[0, d, 0] = pull[d]
        for e in range(dimensions):
            found[0, d, 1 + e] = -dot(back[3 * d : 3 * d + 3], tuple(bending[:, 1 + e].tolist()))
            found[1, d, 1 + e] = -2.0 * dot(back[3 * d : 3 * d + 3], tuple(moving[:, 1 + e].tolist()))
    return found


def rotation(axis: Vector, angle: float) -> Vector:
    """The matrix that turns by ``angle`` rad about the unit vector ``axis`` (Rodrigues)."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    t = 2.0 * math.sin(0.5 * angle) ** 2  # 1 − c without cancellation
    return (
        *(c + t * x * x, t * x * y - s * z, t * x * z + s * y),
        *(t * y * x + s * z, c + t * y * y, t * y * z - s * x),
        *(t * z * x - s * y, t * z * y + s * x, c + t * z * z),
    )


def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def turned(m: Vector, a: Vector) -> Vector:
    """The vector m a."""
    return dot(m[:3], a), dot(m[3:6], a), dot(m[6:], a)


def product(m: Vector, n: Vector) -> Vector:
    """The matrix m n."""
    return tuple(dot(m[3 * d : 3 * d + 3], n[e::3]) for d in range(3) for e in range(3))


def transposed(m: Vector) -> Vector:
    """The matrix mᵀ: of a rotation, the one back."""
    return (*m[0::3], *m[1::3], *m[2::3])


def in_space(a: Vector) -> Vector:
    """A vector of one, two or three numbers as one of three."""
    return (*a, *ZERO[len(a) :])
