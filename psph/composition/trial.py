"""A trial call of an effect in plain Python: which fields does its formula read?"""

from collections.abc import Mapping
from numbers import Real
from typing import NamedTuple

from psph.composition.pair import PAIR_VECTORS, Pair
from psph.composition.terms import OF_A_PARTICLE
from psph.errors import Refused
from psph.fields import Field


class Reads(NamedTuple):
    """Names that an effect reads of a particle itself, of its neighbour and of their pair."""

    own: frozenset[str]
    neighbour: frozenset[str]
    pair: frozenset[str]
    in_sum: frozenset[str] = frozenset()
    """Of either particle, in the effect's own sum."""
    of_pairs: frozenset[str] = frozenset()
    """Of either particle, in all that is summed over pairs."""
    gathered: frozenset[str] = frozenset()
    """Of a neighbour, in the effect's own sum."""
    in_density_rate: frozenset[str] = frozenset()
    """Of a neighbour, in its share of the rate of density."""
    beside: frozenset[str] = frozenset()
    """Of a neighbour, in all else that is summed over pairs."""


class UnknownField(Refused):
    """An effect reads something that no particle carries."""


class WrongShape(Refused):
    """A formula gives a vector for a number, or the other way round."""


VALUES = (1.0, 0.5)
"""What a trial answers: formulas compare with zero or a threshold, and each side is to be seen."""


SLOPES = ("dw_r", "m_dw_r")
"""Entries of a pair that are negative where its particles meet."""


class _Recorder:
    """Answers every known name with a harmless value and remembers that it was asked."""

    def __init__(self, owner: str, what: str, widths: dict[str, int | None]):
        self._owner, self._what, self._widths = owner, what, widths
        self.read: set[str] = set()
        self.value = VALUES[0]

    def __getattr__(self, name: str):
        if name not in self._widths:
            known = ", ".join(self._widths)
            raise UnknownField(f"{self._owner} reads '{name}' of a {self._what}; it may read {known}")
        self.read.add(name)
        if several := self._widths[name]:
            return (self.value,) * several
        return -self.value if name in SLOPES and self.value != VALUES[0] else self.value


def reads(effect, dimensions: int, kernel, fields: Mapping[str, Field]) -> Reads:
    """Call every formula of ``effect`` in plain Python; raises UnknownField in one plain line.

    ``fields`` are all that a particle can carry, by name.
    """
    owner = type(effect).__name__
    particle = {name: field.width(dimensions) if field.composed else None for name, field in fields.items()}
    geometry = {name: dimensions if name in PAIR_VECTORS else None for name in Pair._fields}
    i, j = (_Recorder(owner, "particle", particle) for _ in range(2))
    pair = _Recorder(owner, "pair", geometry)
    for value in VALUES:
        i.value = j.value = pair.value = value
        _sum(effect, i, j, pair, kernel)
    in_sum, gathered = frozenset(i.read | j.read), frozenset(j.read)
    rated = _Recorder(owner, "particle", particle)
    for value in VALUES:
        i.value = j.value = pair.value = rated.value = value
        if hasattr(effect, "density_rate"):
            _check(effect, "density_rate", effect.density_rate(i, rated, pair), None)
        _forces(effect, i, j, pair, dimensions)
    beside = frozenset(j.read)
    j.read |= rated.read
    of_pairs = frozenset(i.read | j.read)
    for value in VALUES:
        i.value = value
        for name in OF_A_PARTICLE:
            if hasattr(effect, name):
                getattr(effect, name)(i, 1.0)
        if hasattr(effect, "admit"):
            effect.admit(i, (value,) * effect.bounds.width(dimensions), 1.0)
    if "m_dw_r" in pair.read:
        j.read.add("mass")
    of_sums = (in_sum, of_pairs, gathered, frozenset(rated.read), beside)
    return Reads(frozenset(i.read), frozenset(j.read), frozenset(pair.read), *of_sums)


def _sum(effect, i, j, pair, kernel) -> None:
    if not hasattr(effect, "start"):
        return
    if hasattr(effect, "has_sum"):
        effect.has_sum(i)
    total = effect.gather(effect.start(i), i, j, pair)
    if hasattr(effect, "finish_value"):
        effect.finish_value(total, i, kernel)


def _forces(effect, i, j, pair, dimensions: int) -> None:
    for name in ("radial", "shear"):
        if hasattr(effect, name):
            _check(effect, name, getattr(effect, name)(i, j, pair), None)
    if hasattr(effect, "push"):
        _check(effect, "push", effect.push(i, j, pair), dimensions)
    if hasattr(effect, "finish_acceleration"):
        total = effect.gather(effect.start(i), i, j, pair)
        _check(effect, "finish_acceleration", effect.finish_acceleration(total, i), dimensions)
    if hasattr(effect, "body"):
        _check(effect, "body", effect.body(i), dimensions)
    if hasattr(effect, "potential"):
        _check(effect, "potential", effect.potential(i), None)


def _check(effect, name: str, value, width: int | None) -> None:
    """Raise WrongShape where a formula gives no number, a tuple for one, or none of so many numbers."""
    given = len(value) if isinstance(value, tuple) else None
    kinds = [f"a tuple of {one} numbers" if one else "a number" for one in (given, width)]
    if other := [one for one in (value if given else [value]) if not isinstance(one, Real)]:
        kinds[0] = "nothing" if other[0] is None else f"a {type(other[0]).__name__}"
    if other or given != width:
        raise WrongShape(f"{type(effect).__name__}.{name} gives {kinds[0]}; let it give {kinds[1]}")
