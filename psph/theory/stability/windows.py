"""The smoothing lengths at which a lattice is stable."""

from collections.abc import Iterable, Sequence

STEP = 0.05
SMOOTHINGS = tuple(round(1.0 + STEP * k, 2) for k in range(21))
"""h/dx that are tried: 1 to 2."""


def windows(stable: Iterable[float], tried: Sequence[float] = SMOOTHINGS) -> str:
    """Some of those that were ``tried`` in words, runs of them joined: '1.25–1.35, 1.5'."""
    runs: list[list[int]] = []
    for place in map(tried.index, stable):
        if runs and place == runs[-1][-1] + 1:
            runs[-1].append(place)
        else:
            runs.append([place])
    ends = [(f"{tried[run[0]]:g}", f"{tried[run[-1]]:g}") for run in runs]
    return ", ".join(first if first == last else f"{first}–{last}" for first, last in ends)
