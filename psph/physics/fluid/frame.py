"""Forces of inertia in a frame of reference that moves."""

from typing import NamedTuple

from psph.acts import FLUIDS, FRAME, speaks_for


@speaks_for(FRAME)
class MovingFrame(NamedTuple):
    """The frame of reference moves: the fluid feels the forces of inertia, and gravity turns.

    a_i = Rᵀg − g − Rᵀ[A + α × r + ω × (ω × r) + 2 ω × R v_i], r = R (x_i − c), beside gravity itself: the
    pose of the frame has the reference point c, its acceleration A, the rotation R, ω and α
    (psph.physics.rigid.pose); x_i and v_i are told in the frame.  Batchelor (1967), An Introduction to Fluid
    Dynamics, sec. 3.2.  The step fills it in where particles drift
    (psph.simulation.carried.store_apparent_force).
    """

    acts = (FLUIDS,)

    def body(self, i):
        """It, m/s²."""
        return i.apparent
