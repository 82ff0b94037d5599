"""Kinds of matter that do work of their own within a step: what they may do, and which ones a plan has."""

from collections.abc import Iterator

import numpy as np


class Kind:
    """A kind of matter among the particles of a rank: it does what it overrides, and nothing else.

    The engine (psph.simulation.cpu) calls each method of all kinds at its moment, in the order of
    :func:`kinds_of`; all are collective.
    """

    def listed(self) -> None:
        """Neighbours are listed anew, of walls that are dry too: their rows then rest."""

    def settle(self) -> None:
        """Particles have found new columns or ranks, and have new lists."""

    def begin(self) -> None:
        """What is kept of the start, from where particles stand then; lists are there."""

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """Go with the drift from ``time`` − ``dt`` to ``time``, s; ``largest_speed`` is of fluids, m/s."""

    def before_sums(self, dt: float) -> None:
        """Ready what the passes over pairs read, ``dt`` s after the last ones."""

    def after_sums(self, time: float, dt: float) -> None:
        """Forces at ``time``, s, by what the passes have summed."""

    def kick(self, dt: float) -> tuple[float, ...] | None:
        """The second kick of a step of ``dt`` s; returns what psph.simulation.integrator.kick does."""

    def measure(self) -> None:
        """Bring up to date what is written of it at the end of the step."""

    def with_pressure(self, pressure: np.ndarray) -> np.ndarray:
        """The ``pressure`` (owned,) of a rank's particles, Pa, with that of this kind."""
        return pressure

    def energy(self) -> float:
        """Energy that it stores, J; the same bits on any number of ranks."""
        return 0.0

    def bytes_held(self) -> int:
        """Bytes of its lists and tables on this rank."""
        return 0


def kinds_of(scene, plan, store, domain, ledger, maps) -> Iterator[Kind]:
    """Those of a plan, for a rank; ``maps`` are of all rigid motions.  Each is imported where it is there."""
    if plan.pressed:
        from psph.simulation.pressed import Pressed

        yield Pressed(scene, plan, store, maps)
    if plan.solids:
        from psph.simulation.solids import Solids

        solids = Solids(scene, plan, store, domain, ledger)
        yield solids
        if plan.immersed:
            from psph.simulation.immersion import Immersion

            yield Immersion(solids, scene, plan, store, domain, ledger)
