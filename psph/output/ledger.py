"""The ledger of time: what each part of a step cost, on this rank."""

import time
from collections import defaultdict


class Ledger:
    """Seconds by name: ``with ledger("pairs"): ...``; about a microsecond an entry."""

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
        self.seconds[name] += time.perf_counter() - begun
