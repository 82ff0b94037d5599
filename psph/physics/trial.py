"""A trial call of an effect in plain Python: which fields does its formula read?"""

from typing import NamedTuple

from psph.physics.compose import Pair, ParticleView


class Reads(NamedTuple):
    """Names that an effect reads of a particle itself, of its neighbour and of their pair."""

    own: frozenset[str]
    neighbour: frozenset[str]
    pair: frozenset[str]


class UnknownField(TypeError):
    """An effect reads something that no particle carries."""


class _Recorder:
    """Answers every known name with a harmless value and remembers that it was asked."""

    def __init__(self, owner: str, record: type, vectors: dict[str, tuple[float, ...]]):
        self._owner, self._names, self._vectors = owner, record._fields, vectors
        self.read: set[str] = set()

    def __getattr__(self, name: str):
        if name not in self._names:
            known = ", ".join(self._names)
            raise UnknownField(f"{self._owner} reads '{name}'; a particle or pair has {known}")
        self.read.add(name)
        return self._vectors.get(name, 1.0)


def reads(effect, dimensions: int, kernel) -> Reads:
    """Call every formula of ``effect`` once; raises UnknownField in one plain line.

    Formulas are free of branches, so that one call sees everything that they ever read.
    """
    owner = type(effect).__name__
    ones = (1.0,) * dimensions
    vectors = dict.fromkeys(("position", "velocity", "x_ij", "u_ij"), ones)
    i, j = (_Recorder(owner, ParticleView, vectors) for _ in range(2))
    pair = _Recorder(owner, Pair, vectors)
    for name in ("density_rate", "radial", "shear"):
        if hasattr(effect, name):
            getattr(effect, name)(i, j, pair)
    if hasattr(effect, "start"):
        total = effect.gather(effect.start(i, kernel), i, j, pair)
        for name in ("finish_acceleration", "finish_value"):
            if hasattr(effect, name):
                getattr(effect, name)(total, i)
    if hasattr(effect, "body"):
        effect.body(i)
    if hasattr(effect, "limit_density"):
        effect.limit_density(i, 1.0)
    return Reads(frozenset(i.read), frozenset(j.read), frozenset(pair.read))
