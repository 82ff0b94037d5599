"""The growth of every kernel over h/dx, under compression and under tension."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from psph.smoothing import KERNELS
from psph.theory.stability import STATES
from psph.theory.stability.growth import Growth, growth
from psph.theory.stability.uniform import Settings
from psph.theory.stability.windows import SMOOTHINGS, windows


class SurveyRow(NamedTuple):
    """A kernel under compression or tension: a growth for each of ``SMOOTHINGS``."""

    kernel: str
    state: str
    found: tuple[Growth, ...]


def survey(settings: Settings) -> Iterator[SurveyRow]:
    """Every kernel, under compression and tension; the rest as in ``settings``.  Takes a while."""
    for state, sign in STATES.items():
        for kernel in KERNELS:
            asked = settings._replace(kernel=kernel, pressure=sign * abs(settings.pressure))
            yield SurveyRow(kernel, state, tuple(growth(asked._replace(smoothing=h)) for h in SMOOTHINGS))


def sentences(rows: Sequence[SurveyRow]) -> Iterator[str]:
    """Which h/dx are stable, one line a kernel."""
    for state in STATES:
        mine = [row for row in rows if row.state == state]
        held = {row.kernel: windows(h for h, one in zip(SMOOTHINGS, row.found) if one.stable) for row in mine}
        if not any(held.values()):
            tried = f"{SMOOTHINGS[0]:g} to {SMOOTHINGS[-1]:g}"
            yield f"Under {state} nothing is stable at any h/dx from {tried}."
            continue
        stable = "; ".join(f"`{kernel}` {where or 'nowhere'}" for kernel, where in held.items())
        yield f"Under {state} stable at h/dx: {stable}."
