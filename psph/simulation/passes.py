"""Passes over the neighbours: which sums are taken in which order, and what travels between them."""

from typing import Any, NamedTuple

from psph.fields import (
    ACCELERATION,
    DENSITY_RATE,
    HELD_ACCELERATION,
    HELD_DENSITY_RATE,
    POSITION,
    PREDICTED_VELOCITY,
    PRESSURE,
    SPECIFIC_VOLUME,
    filled,
)
from psph.simulation.paces import is_held


class SumsInACircle(TypeError):
    """Effects that need each other's sums of the same step."""


class Pass(NamedTuple):
    """One pass of the pair loop over all particles of a rank.

    ``place`` is its place among the passes of a plan.  ``effects`` give rates and are empty in a pass
    that gathers sums alone; ``reductions`` have sums of their own; ``stores`` names the field, or the
    several fields, that each of these fills, or None.  ``neighbour_fields`` are what it reads of a
    neighbour, ``brought`` those among them that an earlier pass writes: ghosts need them again whenever that
    one has run.  It runs in every ``every``-th step, and more often after an impact
    (psph.simulation.impacts) where its sums are ``slow``.  The rates of one that ``holds`` serve until it
    runs again.  One is ``across`` that sums over pairs with particles that are apart
    (psph.particles.apart), and no other does.  A pass that fills the pressure of
    some particles ``settles`` their density too.  One that gives rates ``gives`` them to these two arrays, of
    the acceleration and of the rate of density, or None in the place of one.  One that is ``midway`` sums the
    rate of density alone, at half of the step and before all others (psph.simulation.midway).  One is
    ``free_only`` whose sums serve what moves freely alone: walls have none.
    """

    place: int
    effects: tuple[Any, ...]
    reductions: tuple[Any, ...]
    stores: tuple[str | tuple[str, ...] | None, ...]
    neighbour_fields: tuple[str, ...]
    brought: tuple[str, ...]
    every: int
    slow: bool = False
    across: bool = False
    holds: bool = False
    gives: tuple[str | None, ...] = ()
    midway: bool = False
    free_only: bool = False

    @property
    def settles(self) -> bool:
        """Whether it gives particles a pressure, and so a density."""
        return PRESSURE.name in self.stores

    @property
    def moved(self) -> tuple[str, ...]:
        """What it reads of a neighbour that has changed by the middle of a step."""
        return tuple(name for name in self.neighbour_fields if name in MOVED)

    @property
    def written(self) -> set[str]:
        """The fields that it fills."""
        return {all_of for name in self.filled for all_of in _with_it(name)}

    @property
    def filled(self) -> tuple[str, ...]:
        """The same by their own names alone."""
        return tuple(name for stored in self.stores for name in _each(stored))

    @property
    def gives_rates(self) -> bool:
        """Whether it sums acceleration and rate of density, or what of them serves for several steps."""
        return bool(self.effects)

    @property
    def on_free(self) -> tuple[Any, ...]:
        """Its effects on what moves freely: all but those of which walls alone feel something."""
        return tuple(effect for effect in self.effects if not getattr(effect, "on_walls", False))

    @property
    def differs_on_driven(self) -> bool:
        """Whether it has other effects on what is driven than on what moves freely, in loops of their own."""
        return self.midway and len(self.on_free) < len(self.effects)

    def due(self, steps: int) -> bool:
        """Whether it runs in the step after so many."""
        return steps % self.every == 0


MOVED = (POSITION.name, PREDICTED_VELOCITY.name)
"""What changes from the end of a step to the middle of the next."""

RATES = (ACCELERATION.name, DENSITY_RATE.name)
HELD = (HELD_ACCELERATION.name, HELD_DENSITY_RATE.name)
"""What passes sum that give rates, and those whose rates serve for several steps."""


def make_passes(
    called,
    stored: tuple[str, ...],
    seen_as,
    gather_every: int = 1,
    also: tuple[str, ...] = (),
    hold_for: int = 1,
    midway: bool = False,
) -> tuple[Pass, ...]:
    """The passes of the effects that were called for, in order; the last gives the rates.

    An effect whose sum others read in the same step comes in a pass before theirs; one that is
    ``lagged`` is content with the sum of the step before, and needs none of its own.  What is ``slow``
    also serves for some steps more: if ``gather_every`` is above 1, it comes in a pass that runs as
    seldom.  The rates of effects that are ``held`` serve for ``hold_for`` steps: if that is above 1, they
    come in a pass of their own before the last.  ``midway``: the rate of density has a pass of its own, the
    first.  ``stored`` are the names of all arrays, ``seen_as`` tells the array that formulas see under a
    name; ``also`` is what passes that give rates are to have of a neighbour whatever the effects.  Without
    effects there are no passes.
    """
    if not called:
        return ()
    between = [call for call in called if getattr(call.effect, "across", False)]
    called = [call for call in called if not getattr(call.effect, "across", False)]
    early = [(call, level, _every(call)) for call, level in _levels(called)]
    if gather_every > 1:
        early += [(call, 0, gather_every) for call in called if getattr(call.effect, "slow", False)]
    order = sorted({(level, every) for _, level, every in early})
    passes: list[Pass] = []
    before: set[str] = set()
    first = int(midway)
    if between:
        sums = [call.effect for call in between]
        made = _pass(first, (), sums, _gathered(between), before, stored, seen_as, 1)
        passes, before = [made._replace(across=True)], set(made.written)
    for level, every in order:
        own = [call for call, *at in early if at == [level, every]]
        sums = [call.effect for call in own]
        made = _pass(first + len(passes), (), sums, _gathered(own), before, stored, seen_as, every)
        passes.append(made._replace(slow=any(getattr(effect, "slow", False) for effect in sums)))
        before |= passes[-1].written
    done = {id(call) for call, *_ in early}
    reductions = [
        call.effect
        for call in called
        if hasattr(call.effect, "start")
        and (id(call) not in done or hasattr(call.effect, "finish_acceleration"))
    ]
    held = [call for call in called if hold_for > 1 and is_held(call.effect)]
    if held:
        own = tuple(call.effect for call in held)
        read = _all_of(held).union(also)
        made = _pass(first + len(passes), own, (), read, before, stored, seen_as, hold_for)
        passes.append(made._replace(slow=True, holds=True, gives=HELD))
    free = [call for call in called if not any(call is one for one in held)]
    summed = [call for call in held if any(call.effect is one for one in reductions)]
    effects = tuple(call.effect for call in free)
    if not midway:
        read = _all_of(free + summed).union(also)
        last = _pass(len(passes), effects, reductions, read, before, stored, seen_as, 1)
        return (*passes, last._replace(gives=RATES))
    read = frozenset(also).union(*(call.reads.beside for call in free + summed))
    last = _pass(first + len(passes), effects, reductions, read, before, stored, seen_as, 1)
    written = before | last.written
    dense = tuple(effect for effect in effects if hasattr(effect, "density_rate"))
    read = frozenset(also).union(*(call.reads.in_density_rate for call in free))
    rate = _pass(0, dense, (), read, written, stored, seen_as, 1)
    whole = (rate._replace(gives=(None, DENSITY_RATE.name), midway=True), *passes)
    forces = last._replace(gives=(ACCELERATION.name, None), free_only=_serves_free(last, (*whole, last)))
    return (*whole, forces)


def _serves_free(forces: Pass, passes: tuple[Pass, ...]) -> bool:
    """Whether the sums of a pass beside its ``forces`` displace particles alone: what any of the ``passes``
    reads of a neighbour is not among them."""
    shifts = all(hasattr(effect, "displacement") for effect in forces.reductions)
    return shifts and not any(forces.written.intersection(one.neighbour_fields) for one in passes)


def written_seldom(passes: tuple[Pass, ...]) -> frozenset[str]:
    """The fields that nothing changes but ``passes`` that do not run in every step."""
    seldom = {name for one in passes if one.every > 1 and not one.settles for name in one.written}
    return frozenset(seldom).difference(*(one.written for one in passes if one.every == 1))


def _all_of(called) -> frozenset[str]:
    """What effects read of a neighbour in any of their formulas."""
    return frozenset().union(*(call.reads.neighbour for call in called))


def _gathered(called) -> frozenset[str]:
    """What effects read of a neighbour in their own sums."""
    return frozenset().union(*(call.reads.gathered for call in called))


def array_of(name: str, stored: tuple[str, ...]) -> str:
    """The array that formulas see under a name: the predicted one of what evolves."""
    return f"predicted_{name}" if f"predicted_{name}" in stored else name


def _pass(place, effects, reductions, read, before, stored, seen_as, every) -> Pass:
    # The geometry of a pair needs these, whatever the effects; the velocity also tells how far
    # neighbours drift apart.
    names = {seen_as(name) for name in {"position", "velocity", "mass", *read}}
    neighbour = tuple(name for name in stored if name in names)
    return Pass(
        place,
        effects,
        tuple(reductions),
        tuple(_filled(e, before, stored) for e in reductions),
        neighbour,
        tuple(name for name in neighbour if name in before),
        every,
    )


def _with_it(name: str) -> tuple[str, ...]:
    """What changes with a field: with the pressure the density, as the forces read it."""
    return (name, SPECIFIC_VOLUME.name) if name == PRESSURE.name else (name,)


def _each(stored: str | tuple[str, ...] | None) -> tuple[str, ...]:
    """The fields that a reduction fills, by name."""
    return (stored,) if isinstance(stored, str) else stored or ()


def _filled(effect, before, stored) -> str | tuple[str, ...] | None:
    """The array that takes the effect's sum, or the several, unless an earlier pass has filled them."""
    kept = (field for field in filled(effect) if not field.asked or field.name in stored)
    names = tuple(field.rate if field.evolves else field.name for field in kept)
    if before.issuperset(names):
        return None
    return names if len(names) > 1 else names[0]


def _levels(called) -> list[tuple[Any, int]]:
    """The effects that come in a pass of their own, each with how many passes come before it."""
    writers = {
        field.name: call
        for call in called
        for field in filled(call.effect)
        if hasattr(call.effect, "start") and not field.evolves and not getattr(call.effect, "lagged", False)
    }
    read = set().union(*(call.reads.of_pairs for call in called))
    early = {name: call for name, call in writers.items() if name in read}
    levels: dict[str, int] = {}
    while len(levels) < len(early):
        ready = {
            name: call
            for name, call in early.items()
            if name not in levels and not (call.reads.in_sum & early.keys()) - levels.keys() - {name}
        }
        if not ready:
            names = ", ".join(sorted(type(c.effect).__name__ for n, c in early.items() if n not in levels))
            raise SumsInACircle(
                f"{names} need each other's sums of the same step; let one of them say lagged = True"
            )
        for name, call in ready.items():
            below = [levels[other] for other in call.reads.in_sum & levels.keys()]
            levels[name] = 1 + max(below, default=-1)
    # One that fills several fields is met under each of their names.
    return list({id(call): (call, levels[name]) for name, call in early.items()}.values())


def _every(call) -> int:
    return getattr(call.effect, "every", 1)
