"""Timers: the seconds of each part of a step, on this rank."""

import time
from collections import defaultdict


class Ledger:
    """Seconds by name: ``with ledger("pairs"): ...``; about a microsecond an entry.

    A part inside of another counts for itself alone, so that all of them add up.
    """

    def __init__(self):
        self.seconds: dict[str, float] = defaultdict(float)
        self._open: list[tuple[str, float]] = []

    def __call__(self, name: str) -> "Ledger":
        self._open.append((name, time.perf_counter()))
        return self

    def __enter__(self) -> "Ledger":
        return self

    def __exit__(self, *exception) -> None:
        name, begun = self._open.pop()
        elapsed = time.perf_counter() - begun
        self.seconds[name] += elapsed
        if self._open:
            self.seconds[self._open[-1][0]] -= elapsed
