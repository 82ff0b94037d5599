"""When something strikes: what is gathered seldom is then gathered at once."""

import math

STRONG = 0.02
"""Acceleration h/c² of an impact at least: two pieces of fluid that meet at 0.2 c come to 0.1."""

SUDDEN = 3.0
"""By what factor it is larger than the usual one."""

MEMORY = 0.02
"""Part of a step in the usual acceleration: that of some fifty steps."""

LASTS = 8
"""Steps after it in which gradients are gathered."""


class Impacts:
    """Whether an impact goes on, from the largest acceleration of each step: the same on every rank.

    Gradients that serve for some steps are those of flows that change slowly.  Where two pieces of fluid
    meet, or fluid meets a wall, the surroundings of a particle change from step to step, and gradients from
    before take the energy of the impact.  A splash goes on for long, with accelerations that are always
    large: they are the usual ones there.  ``unit`` is c²/h, m/s².
    """

    def __init__(self, unit: float):
        self._strong = STRONG * unit
        self._usual, self._left = math.inf, 0

    @property
    def lasts(self) -> bool:
        """Whether gradients are to be gathered in the next step."""
        return self._left > 0

    def see(self, acceleration: float) -> None:
        """Take the largest acceleration of a step, m/s²; that of the start is the usual one."""
        self._left = max(self._left - 1, 0)
        self._usual = acceleration if math.isinf(self._usual) else self._usual
        if acceleration > max(self._strong, SUDDEN * self._usual):
            self._left = LASTS
        self._usual += MEMORY * (acceleration - self._usual)

    def state(self) -> dict:
        """What the next steps rest on."""
        return {"usual": self._usual, "left": self._left}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self._usual, self._left = state["usual"], state["left"]
