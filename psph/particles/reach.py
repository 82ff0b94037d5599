"""How far particles feel and see each other: the one place that is asked for the cutoff."""

from typing import NamedTuple


class Reach(NamedTuple):
    """``support`` is the radius of the kernel and ``skin`` what lists look beyond it, m."""

    support: float
    skin: float

    @classmethod
    def uniform(cls, kernel, smoothing_length: float, skin: float) -> "Reach":
        """One smoothing length (m) for all particles; ``skin`` a part of the support."""
        support = kernel.support * smoothing_length
        return cls(support, skin * support)

    @property
    def cutoff(self) -> float:
        """Distance up to which a list names neighbours, m."""
        return self.support + self.skin
