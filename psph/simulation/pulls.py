"""What the body forces of a scene pull, which of them have a potential, and whose work is booked."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from psph.acts import BONDED, FLOWING, SIZED, WHOLE
from psph.composition import terms
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.simulation.reading import Called
from psph.vectors import Vector, add


class Pulls(NamedTuple):
    """The effects of a scene that have a body force.

    ``uniform`` m/s² is the sum of those that are the same everywhere: what is rigid bears it at its centre of
    mass, and its potential is a height.  On what moves as a ``whole`` the others are summed over its
    particles; what is ``bonded`` to its neighbours of the start is pulled by all.  ``held`` have another
    potential, some as surfaces do and without a body force.  The work of what has none is booked, of
    ``booked`` on what moves in the passes over neighbours, of ``booked_in_bonds`` on what is bonded in a
    fluid; where it only takes energy, as an effect says with ``dissipates``, it need not be.
    """

    uniform: Vector
    whole: tuple[Any, ...]
    bonded: tuple[Any, ...]
    held: tuple[Any, ...]
    booked: tuple[Any, ...]
    booked_in_bonds: tuple[Any, ...]

    def ask(self, effect) -> bool:
        """Whether kick, or the push of what moves as a whole, asks an effect what it does to a particle."""
        return any(effect is one for one in (*self.whole, *self.booked))

    def heights(self, periods: Sequence[float | None]) -> Vector:
        """The uniform pull along axes that do not repeat, else zero, m/s²: across a period there is no
        height, so a potential would jump where a particle passes it."""
        return tuple(g if period is None else 0.0 for g, period in zip(self.uniform, periods))


def shares_loop(called: Iterable[Called], flows: bool) -> tuple[Called, ...]:
    """The effects that act in the passes over neighbours: on what flows, or where nothing does on what is
    bonded or has particles of many sizes."""
    matter = FLOWING if flows else (*BONDED, *SIZED)
    return tuple(call for call in called if not set(matter).isdisjoint(call.acts))


def pulls_of(called: Iterable[Called], dimensions: int, flows: bool) -> Pulls:
    """What pulls in a scene, where something may flow: ``flows``."""
    called = tuple(called)
    held = tuple(one.effect for one in called if hasattr(one.effect, "potential"))
    called = tuple(call for call in called if hasattr(call.effect, "body"))
    pulling, moving = [one.effect for one in called], [one.effect for one in shares_loop(called, flows)]
    on_whole = [one.effect for one in called if not set(WHOLE).isdisjoint(one.acts)]
    uniform = (0.0,) * dimensions
    for one in pulling:
        uniform = add(uniform, one.body(None)) if _is_uniform(one) else uniform
    bonded = [one.effect for one in called if not set(BONDED).isdisjoint(one.acts)]
    return Pulls(
        uniform,
        tuple(one for one in on_whole if not _is_uniform(one)),
        tuple(bonded),
        held,
        tuple(filter(_is_booked, moving)),
        tuple(filter(_is_booked, bonded)) if flows else (),
    )


def _is_uniform(effect) -> bool:
    return getattr(effect, "uniform", False)


def _is_booked(effect) -> bool:
    known = hasattr(effect, "potential") or _is_uniform(effect)
    return not known and not getattr(effect, "dissipates", False)


@elementwise
def potentials(first, last, effects, view, found):
    """The potential energy of the particles in columns ``first`` to ``last`` by their mass, J/kg."""
    for k in range(np.uint64(first), np.uint64(last)):
        found[k] = terms.potential(effects, take(view, k))
