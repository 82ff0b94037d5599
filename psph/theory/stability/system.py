"""Small motions as a linear system, and how fast the fastest of them grows."""

from typing import NamedTuple

import numpy as np

SURE = 1e-5
"""A growth below this part of the fastest oscillation is a rounding error."""


class System(NamedTuple):
    """ξ̇ = u, u̇ = −stiffness ξ − damping u + push s, ṡ = pull u − diffusion s.

    q displacements, n densities; matrices (…, q, q), (…, q, q), (…, q, n), (…, n, q), (…, n, n);
    the points are as many systems side by side.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    push: np.ndarray
    pull: np.ndarray
    diffusion: np.ndarray

    @property
    def reversible(self) -> bool:
        """Whether nothing is lost: then s = pull ξ, and ξ̈ = −squares ξ."""
        return not (self.damping.any() or self.diffusion.any())

    @property
    def squares(self) -> np.ndarray:
        """(…, q, q), its eigenvalues are the ω² of the reversible system, 1/s²."""
        return self.stiffness - self.push @ self.pull

    @property
    def first_order(self) -> np.ndarray:
        """The matrix of (ξ, u, s), (…, 2q + n, 2q + n), 1/s."""
        q, n = self.push.shape[-2:]
        whole = np.zeros((*self.push.shape[:-2], 2 * q + n, 2 * q + n))
        whole[..., :q, q : 2 * q] = np.eye(q)
        whole[..., q : 2 * q, :q] = -self.stiffness
        whole[..., q : 2 * q, q : 2 * q] = -self.damping
        whole[..., q : 2 * q, 2 * q :] = self.push
        whole[..., 2 * q :, q : 2 * q] = self.pull
        whole[..., 2 * q :, 2 * q :] = -self.diffusion
        return whole

    @property
    def noise(self) -> float:
        """Growth that is no more than a rounding error, 1/s."""
        return SURE * float(np.sqrt(np.abs(self.squares).max(initial=0.0)))

    def urge(self) -> np.ndarray:
        """Largest growth rate (…), 1/s; of a reversible system without, −(slowest frequency)."""
        if not self.reversible:
            return np.linalg.eigvals(self.first_order).real.max(axis=-1)
        squares = self.squares
        if _symmetric(squares):
            lowest = np.linalg.eigvalsh(squares)[..., 0]
            return -np.sign(lowest) * np.sqrt(np.abs(lowest))
        found = np.linalg.eigvals(squares).astype(complex)
        growth = np.sqrt(-found).real
        return np.where(growth > 0.0, growth, -np.sqrt(np.abs(found))).max(axis=-1)

    def mode(self) -> np.ndarray:
        """Displacements (q,) of the motion that grows fastest, or is the slowest; of one system."""
        if not self.reversible:
            values, vectors = np.linalg.eig(self.first_order)
            return vectors[: len(self.stiffness), values.real.argmax()]
        squares = self.squares
        values, vectors = (np.linalg.eigh if _symmetric(squares) else np.linalg.eig)(squares)
        return vectors[:, values.real.argmin()]


def _symmetric(matrices: np.ndarray) -> bool:
    """Within rounding errors."""
    bound = 1e-10 * np.abs(matrices).max(initial=0.0)
    return bool((np.abs(matrices - np.swapaxes(matrices, -1, -2)) <= bound).all())
