"""How far particles feel and see each other: the one place that is asked for the cutoff."""

from typing import NamedTuple


class Reach(NamedTuple):
    """``support`` is the radius of the kernel and ``skin`` what lists look beyond it at the most, m; None or
    the ``least`` that they do, m, where it narrows and widens by how long they last."""

    support: float
    skin: float
    least: float | None = None

    @classmethod
    def uniform(cls, kernel, smoothing_length: float, skin: float, least: float | None = None) -> "Reach":
        """One smoothing length (m) for all particles; ``skin`` and ``least`` parts of the support."""
        support = kernel.support * smoothing_length
        return cls(support, skin * support, None if least is None else min(least, skin) * support)

    @property
    def cutoff(self) -> float:
        """Distance up to which a list names neighbours at the most, m."""
        return self.support + self.skin

    @property
    def first(self) -> float:
        """The skin of the first lists, m."""
        return self.skin if self.least is None else (self.least * self.skin) ** 0.5
