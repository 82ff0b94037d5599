"""How much of its own volume counts where the stress of a particle is summed to an energy: its share.

F_i of a particle at a face is that of a place a third of a spacing deeper, since its neighbours are on one
side only; so what bends or twists is too soft.  The shares make that up, in bars:

    E = Σ_i w_i V_i ψ(F_i) + …,   w_i = q_i Σ_j V_j W_ij/Q_j,   Q_j = Σ_k V_k q_k W_jk,
    q_k = (Σ_l V_l W_kl)^−n,

where i is among the j, and so on.  Each particle j hands its volume out, to those near it by W_ij q_i, and q
is large at faces, larger along edges.  So Σ w_i V_i = Σ V_i, with w_i > 0: an even strain has its energy,
less what ``MOST`` takes, 0.8 % in a bar and 7.6 % in a cube 4 across; and w_i = 1 where the neighbours of i
have all of theirs.

What a clamp holds has a larger share yet, ``HELD`` w_i: a strain that ends at the clamp is smoothed over a
kernel, half of which is inside, and the squares of the halves are less than that of the whole.

n, ``HELD`` and the default α of the hourglass control are chosen together, for square bars clamped at one
end, by linear theory (docs/solids.md, "Why 1.5 and 0.75").  There is no source.
"""

import numpy as np

from psph.fields import Field

SHARE = Field("share", "1", "w_i, the part of its volume that counts for the energy of a stress")

MOST = 2.0
"""No share is larger but those in clamps: at the corners of a cube it would be 2.7, and steps shorter."""

HELD = 3.0
"""How much more what clamps hold counts."""


def wish(covered: np.ndarray) -> np.ndarray:
    """q of particles whose kernels hold the part ``covered`` Σ_l V_l W_kl: n = 4.5, by operations that round
    alike everywhere."""
    square = covered * covered
    return 1.0 / (square * square * np.sqrt(covered))


def bounded(received: np.ndarray, held: np.ndarray) -> np.ndarray:
    """w of particles that ``received`` so much, of which some are ``held`` by clamps."""
    return np.minimum(received, MOST) * np.where(held, HELD, 1.0)
