"""What a kind of matter does on a rank within a step: its stages, and its work at each moment."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np


class Stage(NamedTuple):
    """Declared work of a step: both take the simulation, and are collective.

    ``run`` takes it from one state within a step to the next.  ``begin`` is the same before the first step,
    of a step without length: the start goes through the stages as every step does.
    """

    run: Callable[..., None]
    begin: Callable[..., None]


class Rank(NamedTuple):
    """What the work of a kind may use on a rank: the ``store`` has particles, the ``ledger`` seconds."""

    scene: Any
    plan: Any
    store: Any
    domain: Any
    ledger: Any


class Work:
    """What a kind of matter does on a rank within a step: it does what it overrides, and nothing else.

    The engine (psph.simulation.cpu) calls each method of all kinds at its moment, in the order of the
    catalogue; all are collective.  ``name`` is that by which others ask the engine for it.
    """

    name: ClassVar[str] = ""
    encloses: ClassVar[bool] = True
    """Whether what it moves is a wall, which holds what is before it."""
    rows: Sequence[int] = ()
    """The places, among the rigid motions of the plan, of those that it moves itself."""
    own_steps: Any = None
    """Steps of their own that groups take (psph.simulation.own_steps)."""

    def meet(self, maps: np.ndarray) -> None:
        """Get the ``maps`` (rows, 3, dim, 1 + dim) of all rigid motions: an array that stays the same."""

    def maps(self, time: float) -> np.ndarray:
        """The maps of its own ``rows`` at ``time``, s (psph.physics.rigid.pose.maps)."""
        raise NotImplementedError

    def drift(self, time: float, dt: float) -> None:
        """Move what it has in ``rows`` to ``time`` in a step of ``dt`` s, before particles follow."""

    def listed(self) -> None:
        """Neighbours are listed anew, of walls that are dry too: take out what is not to be met."""

    def settle(self) -> None:
        """Particles have found new columns or ranks, and have new lists."""

    def begin(self) -> None:
        """What is kept of the start, from where particles stand then; lists are there."""

    def parts(self, whole: float) -> Iterator[tuple[float, bool]] | None:
        """Steps, s, of which one of ``whole`` s is made, and whether others follow; None: of equal ones."""
        return None

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """Go with the drift from ``time`` − ``dt`` to ``time``, s; ``largest_speed`` is of fluids, m/s."""

    def before_sums(self, dt: float) -> None:
        """Ready what the passes over pairs read, ``dt`` s after the last ones."""

    def is_due(self, one: Any) -> bool | None:
        """Whether the pass ``one`` runs in this step, where this kind says so; None: as it is for all."""
        return None

    def loops(self, one: Any, loop: Any, seen: tuple, sums: Any) -> Iterable[tuple[Any, tuple]] | None:
        """Loops in the place of the compiled ``loop`` of the pass ``one`` over all particles, each with what
        it takes beside columns, by what is ``seen`` and where its ``sums`` go; None: that one."""
        return None

    def uneven(self) -> float:
        """Half of how far velocities of fluids differ, m/s; infinity where that bounds no shifts."""
        return math.inf

    def sums_again(self) -> None:
        """What sums rest on, once more: at the start they may be done twice (psph.simulation.stages)."""

    def after_sums(self, time: float, dt: float) -> None:
        """Forces at ``time``, s, by what the passes have summed."""

    def kick(self, dt: float) -> tuple[float, ...] | None:
        """The second kick of a step of ``dt`` s; returns what psph.simulation.integrator.kick does."""

    def measure(self) -> None:
        """Bring up to date what is written of it at the end of the step."""

    def weigh(self, store: Any, mass: np.ndarray) -> None:
        """Put the true ``mass`` (owned,), kg, of its own in the ``store`` where that carries another."""

    def with_pressure(self, pressure: np.ndarray) -> np.ndarray:
        """The ``pressure`` (owned,) of a rank's particles, Pa, with that of this kind."""
        return pressure

    def energy(self) -> float:
        """Energy that it stores, J; the same bits on any number of ranks."""
        return 0.0

    def given(self) -> tuple[float, float]:
        """Energy that it has brought in since the start, J, and how far off that may be."""
        return 0.0, 0.0

    def overlapping(self, store: Any, depth: float) -> np.ndarray | None:
        """Above 0 for each of the ``store`` (owned,) over ``depth`` spacings inside others; None: nowhere."""
        return None

    def overlap_words(self, number: int, key: str) -> str:
        """Who is inside what by :meth:`overlapping`, worst the particle ``number``, of the case's ``key``."""
        raise NotImplementedError

    def summary(self, poses: Any, lower: np.ndarray, upper: np.ndarray) -> Iterator[str]:
        """Lines at the end of a run, by ``poses``: what has left the walls from ``lower`` to ``upper``, m."""
        yield from ()

    def passed(self) -> Iterator[str]:
        """Lines at the end of a run: what has come into the domain and gone out of it, or has broken."""
        yield from ()

    def news(self, time: float) -> Iterator[str]:
        """Lines on what has happened in the step that ended at ``time``, s."""
        yield from ()

    def strung(self, time: float) -> Iterator[Any]:
        """What frames at ``time``, s, also hold: curves of ``name``, ``points`` (n, 3), m, ``tension``."""
        yield from ()

    def booked(self) -> Sequence[float]:
        """The values of the columns that its kind adds to log.csv; the same bits on any number of ranks."""
        return ()

    def pushing(self, groups: Sequence[int], about: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Force, N, and moment about ``about`` (dim,) m, N m, of own contacts on ``groups``; or None."""
        return None

    def pairs(self) -> int:
        """Pairs of particles in passes of its own, on this rank."""
        return 0

    def bytes_held(self) -> int:
        """Bytes of its lists and tables on this rank."""
        return 0

    def state(self) -> dict:
        """What its next step rests on beside particles, as JSON holds it; the same on every rank."""
        return {}

    def restore(self, state: dict) -> None:
        """Go on from there; ``state`` has that of all kinds."""
