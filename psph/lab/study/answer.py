"""The answer to ``study --error`` and ``--seconds``: settings that can be pasted into the case."""

import math
from collections.abc import Iterator

from psph.lab.study import report, words
from psph.lab.study.ladder import SPACING
from psph.scene import Scene
from psph.scene.lattice_fit import FARTHEST, misfits, nearest_fit, widths


def answers(ladders, scene: Scene, error: float | None, seconds: float | None) -> Iterator[str]:
    """The settings that reach an error, or the error that so many seconds reach, in lines.

    ``ladders`` as of Study.ladders; the spacing keeps within what was asked for, and divides the
    widths of the ``scene`` where such a spacing is near.
    """
    steady = [(shared, ladder) for shared, _, ladder in ladders if ladder and ladder.steady]
    if not steady:
        several = any(ladder and len(ladder.runs) > 1 for _, _, ladder in ladders)
        yield (
            "no answer: the errors of these runs do not fall steadily with the spacing."
            if several
            else "no answer: this needs two runs that differ in the spacing alone."
        )
        return
    found = []
    for shared, ladder in steady:
        dx = ladder.spacing_for_error(error) if error else ladder.spacing_for_seconds(seconds)
        if not math.isnan(dx):
            dx = fitting(dx, *_lengths(scene), coarser=not error)
            found.append(({SPACING: dx, **shared}, ladder.error(dx), ladder.seconds(dx)))
    if not found:
        asked = report.percent(error) if error else report.seconds(seconds)
        yield f"no answer: {asked} cannot be extrapolated from these runs."
        return
    best = min(found, key=lambda f: (f[2] if error else f[1]).value)
    asked = f"an error of {report.percent(error)}" if error else f"{report.seconds(seconds)}"
    yield f"For {asked}, " + next(lines := words.advice(*best))
    yield from lines
    for line in misfits(scene, best[0][SPACING]):
        yield f"warning: {line}"


def _lengths(scene: Scene) -> tuple[list[float], ...]:
    """What a spacing should divide: all widths, those of what flows and periods, the periods alone."""
    every = widths(scene)
    periods = [period for period in scene.layout.periods if period is not None]
    flowing = tuple(f"{part.key}." for part in scene.layout.parts if part.flows)
    flows = [width.length for width in every if width.key.startswith(flowing)]
    return [width.length for width in every], [*flows, *periods], periods


def fitting(spacing: float, *wanted: list[float], coarser: bool = False) -> float:
    """A spacing in m near ``spacing`` that divides all lengths of the first of ``wanted`` that it can.

    At most so large, or with ``coarser`` at least; where none divides them, rounded to that side.
    """
    least, most = (1.0, FARTHEST) if coarser else (1.0 / FARTHEST, 1.0)
    for lengths in filter(None, wanted):
        if found := nearest_fit(spacing, lengths, least, most):
            return found
    return _rounded(spacing, math.ceil if coarser else math.floor)


DIGITS = 3
"""For a spacing that has no widths to divide."""


def _rounded(x: float, to) -> float:
    unit = 10.0 ** (math.floor(math.log10(x)) - DIGITS + 1)
    return float(f"{to(x / unit * (1.0 + (1e-9 if to is math.floor else -1e-9))) * unit:.{DIGITS}g}")
