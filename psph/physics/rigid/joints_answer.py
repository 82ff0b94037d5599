"""What joints answer to impulses in contacts: so both are solved together."""

import numpy as np

from psph.physics.rigid.contact import Answers, BodyContacts
from psph.physics.rigid.linear import factored, solved


class Jointed:
    """Joints that hold their r rows G shut whatever pushes the bodies.

    ``which`` (r,) of all m rows they are, and ``given`` (m,) what these bore before.  ``acts`` (r, n, 6) are
    impulses and moments on the bodies of unit impulses of the rows, Gᵀ, and ``moves`` what these change of
    velocities and spins, M⁻¹Gᵀ.  An impulse P in contacts, Cᵀ P on the bodies, moves them by
    M⁻¹ (Cᵀ P − Gᵀ z) with z = A⁻¹ G M⁻¹ Cᵀ P and A = G M⁻¹ Gᵀ.  ``borne`` (r,) N s or N m s is the sum of all
    z so far.
    """

    def __init__(self, which: np.ndarray, given: np.ndarray, acts: np.ndarray, moves: np.ndarray):
        self.which, self.given, self._acts, self._moves = which, given, acts, moves
        self._factors = factored(answering(acts, moves))
        self.borne = np.zeros(len(which))

    def at(self, touching: BodyContacts) -> Answers:
        """The answers at points of contact."""
        near = self._seen(touching.first, touching.arms) - self._seen(touching.second, touching.other_arms)
        back = [solved(self._factors, row) for row in near.reshape(-1, near.shape[2])]
        answer = np.reshape(back, near.shape).transpose(0, 2, 1)
        return Answers(near, np.ascontiguousarray(answer), np.zeros(near.shape[2]))

    def pushed(self, borne: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Impulses, N s, and moments about the reference points, N m s, (n, 3) on the bodies: −Gᵀ z."""
        return _halves(-np.einsum("r,rnd->nd", borne, self._acts))

    def moved(self, borne: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What these change of velocities, m/s, and spins, rad/s, (n, 3)."""
        return _halves(-np.einsum("r,rnd->nd", borne, self._moves))

    def bear(self, borne: np.ndarray) -> None:
        """Add to what they have borne."""
        self.borne = self.borne + borne

    def _seen(self, rows: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """Velocities (m, 3, r) at the ``arms`` of bodies by unit impulses of the joints; 0 of walls."""
        moves = np.where((rows >= 0)[:, None], self._moves[:, rows], 0.0)
        return np.ascontiguousarray((moves[..., :3] + np.cross(moves[..., 3:], arms)).transpose(1, 2, 0))


def answering(acts: np.ndarray, moves: np.ndarray) -> np.ndarray:
    """How fast the gap of a row opens after a unit impulse of another (m, m): G M⁻¹ Gᵀ, of ``acts`` Gᵀ and
    ``moves`` M⁻¹Gᵀ (m, n, 6) on n bodies."""
    return moves.reshape(len(acts), -1) @ acts.reshape(len(acts), -1).T


def _halves(whole: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return whole[:, :3], whole[:, 3:]


def loose(touching: BodyContacts) -> Answers:
    """The answers without joints."""
    count = len(touching.first)
    return Answers(np.zeros((count, 3, 0)), np.zeros((count, 0, 3)), np.zeros(0))
