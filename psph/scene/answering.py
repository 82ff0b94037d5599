"""How much rigid bodies answer to contacts with elastic solids: what that asks of the time step."""

import math
from collections.abc import Iterator

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.physics.solid.contact import LAYER
from psph.scene.body_parts import bodies_of
from psph.scene.census import Census
from psph.scene.faces import drawn_faces


def answer(census: Census, friction: bool) -> float:
    """The largest eigenvalue λ of M⁻¹ Σ b GᵀG over all bodies, 1/kg.

    Where springs of the stiffness k press all particles of its faces at once, each with the part b that it
    has in a contact, a body swings at ω² = k λ, and slower where they press some.  G = (w, r × w) leads from
    its velocity and spin to the speed along w of the point of its face at r: along the normal, or with
    ``friction``, and at edges, along each axis.  M⁻¹ is 1/M and I⁻¹ in what the body is free to do.
    """
    if not (bodies := bodies_of(census)):
        return 0.0
    yielding = Bodies(bodies, census.layout.gravity).yielding(math.inf)
    found = []
    for row, sliding in enumerate(yielding.sliding):
        root = np.zeros((6, 6))
        values, axes = np.linalg.eigh(yielding.turning[row])
        root[:3, :3], root[3:, 3:] = np.diag(np.sqrt(sliding)), axes * np.sqrt(np.maximum(values, 0.0))
        pressed = sum((g.T @ g for g in _pressed(census, row, friction)), np.zeros((6, 6)))
        found.append(float(np.linalg.eigvalsh(root.T @ pressed @ root)[-1]))
    return max(found)


def _pressed(census: Census, row: int, friction: bool) -> Iterator[np.ndarray]:
    """√b G of the particles of the faces of a body, m in turns (n, 6), by chunks."""
    layout, point = census.layout, bodies_of(census)[row].reference
    number, d = layout.parts.bodies[row], layout.dimensions
    for begin, end in layout.lattice.chunks():
        held = layout.materials(begin, end) == number
        grid = layout.lattice.grid(begin, end)
        sites = np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1)
        normal, depth = drawn_faces(layout, np.full(len(sites), number), sites)
        share = np.clip(LAYER - depth, 0.0, 1.0)
        arms, ways = np.zeros((2, len(sites), 3))
        ways[:, :d] = normal
        arms[:, :d] = sites - point[:d] + depth[:, None] * layout.spacing * normal
        known = np.full(len(sites), not friction) & (normal != 0.0).any(axis=1)
        yield _led(arms[known], ways[known], share[known])
        for axis in np.eye(3)[:d]:
            yield _led(arms[~known], np.broadcast_to(axis, arms[~known].shape), share[~known])


def _led(arms: np.ndarray, ways: np.ndarray, share: np.ndarray) -> np.ndarray:
    """√b (w, r × w)."""
    return np.sqrt(share)[:, None] * np.hstack([ways, np.cross(arms, ways)])
