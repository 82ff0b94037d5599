"""A trial call of an effect in plain Python: which fields does its formula read?"""

from typing import NamedTuple

from psph.physics.compose import OF_A_PARTICLE, Pair, ParticleView, components


class Reads(NamedTuple):
    """Names that an effect reads of a particle itself, of its neighbour and of their pair."""

    own: frozenset[str]
    neighbour: frozenset[str]
    pair: frozenset[str]


class UnknownField(TypeError):
    """An effect reads something that no particle carries."""


VALUES = (1.0, 0.5)
"""What a trial answers: formulas compare with zero or a threshold, and each side is to be seen."""


SLOPES = ("dw_r", "m_dw_r")
"""Entries of a pair that are negative where its particles meet."""


class _Recorder:
    """Answers every known name with a harmless value and remembers that it was asked."""

    def __init__(self, owner: str, record: type, dimensions: int):
        self._owner, self._names, self._dimensions = owner, record._fields, dimensions
        self.read: set[str] = set()
        self.value = VALUES[0]

    def __getattr__(self, name: str):
        if name not in self._names:
            known = ", ".join(self._names)
            raise UnknownField(f"{self._owner} reads '{name}'; a particle or pair has {known}")
        self.read.add(name)
        if several := components(name, self._dimensions):
            return (self.value,) * several
        return -self.value if name in SLOPES and self.value != VALUES[0] else self.value


def reads(effect, dimensions: int, kernel) -> Reads:
    """Call every formula of ``effect`` in plain Python; raises UnknownField in one plain line."""
    owner = type(effect).__name__
    i, j, pair = (_Recorder(owner, r, dimensions) for r in (ParticleView, ParticleView, Pair))
    for value in VALUES:
        i.value = j.value = pair.value = value
        _call_all(effect, i, j, pair, kernel)
    if "m_dw_r" in pair.read:
        j.read.add("mass")
    return Reads(frozenset(i.read), frozenset(j.read), frozenset(pair.read))


def _call_all(effect, i, j, pair, kernel) -> None:
    for name in ("density_rate", "radial", "shear", "push"):
        if hasattr(effect, name):
            getattr(effect, name)(i, j, pair)
    if hasattr(effect, "start"):
        total = effect.gather(effect.start(i), i, j, pair)
        if hasattr(effect, "finish_acceleration"):
            effect.finish_acceleration(total, i)
        if hasattr(effect, "finish_value"):
            effect.finish_value(total, i, kernel)
    if hasattr(effect, "body"):
        effect.body(i)
    for name in OF_A_PARTICLE:
        if hasattr(effect, name):
            getattr(effect, name)(i, 1.0)
