"""From the runs of a ladder to those that were not made: error and seconds at any spacing.

Errors follow C dx^p between two runs, and E₀ + C dx^p beyond the finest: at a given h/dx a floor E₀
is left, by disorder and by sums that stand for integrals (Quinlan, Basa & Lastiwka 2006, Int. J.
Numer. Methods Eng. 66, 2064).  Seconds are those of a particle-step and those of a step, the same
for all runs of a ladder; particles go with dx^-d, and steps as they do along the ladder: with dx^-1
where sound limits them, with dx^-2 where friction does.
"""

import math
import warnings
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import optimize, stats

CONFIDENCE = 0.9
"""Of the intervals."""

LAST = 3
"""Runs from which the error beyond the finest is predicted."""

UNSEEN = 0.01
"""A floor below this part of the finest run's error is none."""


class RunPoint(NamedTuple):
    """What a fit takes of a run: spacing in m, relative error, seconds, particles and steps."""

    spacing: float
    error: float
    seconds: float
    particles: int
    steps: int


class Estimate(NamedTuple):
    """A number and the interval that holds it with 90 %; NaN where too few runs tell."""

    value: float
    low: float
    high: float


class Prediction(NamedTuple):
    """A run, and what was to be expected of it by runs that are not it: error and seconds."""

    run: RunPoint
    error: Estimate
    seconds: Estimate


class Ladder:
    """Runs of one case that differ in the spacing alone, at least two of them.

    ``estimated``: their errors hold that of the finest run, which :func:`own_error` estimated from
    the same runs.  They know one number less then: neither a floor nor a check of the prediction.
    """

    def __init__(self, runs: Sequence[RunPoint], dimensions: int, estimated: bool = False):
        self.runs = sorted((r for r in runs if r.error > 0.0), key=lambda r: -r.spacing)
        if len(self.runs) < 2:
            raise ValueError("a ladder needs two runs with an error")
        self.dimensions, self.estimated = dimensions, estimated
        self._fitted = LINE + estimated
        self._log_dx = np.log([r.spacing for r in self.runs])
        self._log_error = np.log([r.error for r in self.runs])
        self._costs = self._fit_costs()

    @property
    def order(self) -> Estimate:
        """The observed order p of the error C dx^p, over all runs, and its uncertainty."""
        return _slope(self._log_dx, self._log_error, self._fitted)

    @property
    def steady(self) -> bool:
        """Whether each finer run has the smaller error: only then there is a law to go by."""
        return bool(np.all(np.diff(self._log_error) < 0.0))

    @cached_property
    def floor(self) -> float | None:
        """The error that the last runs leave however fine the spacing; None where they show none."""
        found = self._towards_floor
        seen = found and found.value.value > UNSEEN * self.runs[-1].error
        return found.value.value if seen else None

    @cached_property
    def _towards_floor(self) -> "Extrapolated | None":
        """However steep: an error that came down at once and stays is its floor."""
        if self.estimated:
            return None
        last = self.runs[-LAST:]
        return richardson([r.spacing for r in last], [r.error for r in last], steepest=math.inf)

    @cached_property
    def prediction(self) -> "Prediction | None":
        """The prediction of the coarser runs for the finest; None if they are too few or unsteady."""
        *coarser, finest = self.runs
        if len(coarser) < LAST or self.estimated:
            return None
        before = Ladder(coarser, self.dimensions)
        if not before.steady:
            return None
        return Prediction(finest, before.error(finest.spacing), before.seconds(finest.spacing))

    def error(self, spacing: float) -> Estimate:
        """The error to expect at a spacing in m; with a floor, the interval holds the power law too."""
        x, where = math.log(spacing), self._log_dx[::-1]
        reach = _scatter(self._log_dx, self._log_error, x, self._fitted)
        if where[0] <= x <= where[-1]:
            return _around(float(np.interp(x, where, self._log_error[::-1])), reach)
        near = slice(None, LAST) if x > where[-1] else slice(-LAST, None)
        slope, level = np.polyfit(self._log_dx[near], self._log_error[near], 1)
        power = _around(level + slope * x, reach)
        if x > where[-1] or not self.floor:
            return power
        finest, floor = self.runs[-1], self.floor
        finer = (spacing / finest.spacing) ** self._towards_floor.order.value
        floored = _around(math.log(floor + (finest.error - floor) * finer), reach)
        return floored._replace(low=min(power.low, floored.low), high=max(power.high, floored.high))

    def seconds(self, spacing: float) -> Estimate:
        """The seconds to expect at a spacing in m."""
        middle = math.log(self._seconds(*self._size(spacing)))
        off = [math.log(r.seconds / self._seconds(r.particles, r.steps)) for r in self.runs]
        free = len(off) - 1
        spread = math.sqrt(sum(x * x for x in off) / free) if free > 1 else math.nan
        reach = stats.t.ppf(0.5 + CONFIDENCE / 2, max(free, 1)) * spread * math.sqrt(1 + 1 / len(off))
        return _around(middle, reach)

    def spacing_for_error(self, error: float) -> float:
        """The largest spacing in m at which the error is expected to be so small; NaN: none."""
        return self._solve(lambda x: self.error(math.exp(x)).value / error)

    def spacing_for_seconds(self, seconds: float) -> float:
        """The smallest spacing in m that takes so many seconds; NaN: none."""
        return self._solve(lambda x: self.seconds(math.exp(x)).value / seconds)

    def _solve(self, ratio) -> float:
        """e^x where ``ratio`` crosses one, within a factor of 30 around the ladder."""
        low, high = self._log_dx[-1] - math.log(30.0), self._log_dx[0] + math.log(30.0)
        at = np.linspace(low, high, 400)
        over = np.array([math.log(ratio(x)) for x in at])
        crossings = np.flatnonzero(np.diff(np.sign(over)))
        if not len(crossings):
            return math.nan
        k = crossings[-1]
        return math.exp(optimize.brentq(lambda x: math.log(ratio(x)), at[k], at[k + 1]))

    def _size(self, spacing: float) -> tuple[float, float]:
        """Particles, scaled from the nearest run, and steps, as they grow between the nearest two."""
        nearest, next_ = sorted(self.runs, key=lambda r: abs(math.log(r.spacing / spacing)))[:2]
        finer = math.log(nearest.spacing / spacing)
        growth = math.log(next_.steps / nearest.steps) / math.log(nearest.spacing / next_.spacing)
        particles = nearest.particles * math.exp(self.dimensions * finer)
        return particles, nearest.steps * math.exp(growth * finer)

    def _fit_costs(self) -> np.ndarray:
        """Seconds of a particle-step and of a step, none negative, relative errors least."""
        rows = np.array([[r.particles * r.steps, r.steps] for r in self.runs], float)
        rows /= np.array([r.seconds for r in self.runs])[:, None]
        scale = rows.max(axis=0)
        return optimize.nnls(rows / scale, np.ones(len(rows)))[0] / scale

    def _seconds(self, particles: float, steps: float) -> float:
        return float(self._costs @ (particles * steps, steps))


LINE = 2
"""Numbers that a straight line takes of the runs."""


def _slope(x: np.ndarray, y: np.ndarray, fitted: int) -> Estimate:
    fit = stats.linregress(x, y)
    free = len(x) - fitted
    # linregress divides by n - 2, whatever else was fitted.
    wide = math.sqrt((len(x) - LINE) / free) if free > 0 else math.nan
    reach = _quantile(free) * wide * fit.stderr
    return Estimate(fit.slope, fit.slope - reach, fit.slope + reach)


def _scatter(x: np.ndarray, y: np.ndarray, at: float, fitted: int) -> float:
    """Half the interval of a single new value at ``at`` around the line through all."""
    free = len(x) - fitted
    if free < 1:
        return math.nan
    slope, level = np.polyfit(x, y, 1)
    rest = y - level - slope * x
    spread = math.sqrt(rest @ rest / free)
    away = (at - x.mean()) ** 2 / ((x - x.mean()) ** 2).sum()
    return _quantile(free) * spread * math.sqrt(1.0 + 1.0 / len(x) + away)


def _quantile(free: int) -> float:
    """Student's t for so many degrees of freedom; NaN without any."""
    return float(stats.t.ppf(0.5 + CONFIDENCE / 2, free)) if free > 0 else math.nan


def _around(log_middle: float, reach: float) -> Estimate:
    return Estimate(*(math.exp(log_middle + off) for off in (0.0, -reach, reach)))


class Extrapolated(NamedTuple):
    """A quantity at zero spacing, and the order at which it goes there."""

    value: Estimate
    order: Estimate


def richardson(
    spacings: Sequence[float], values: Sequence[float], steepest: float = 10.0
) -> Extrapolated | None:
    """q₀ and p of q = q₀ + C dx^p through three runs or more; None where they do not converge.

    Nor where p is above ``steepest``: no scheme has such an order.

    Richardson (1911), Philos. Trans. R. Soc. Lond. A 210, 307; the order from the runs as in
    Roache (1994), J. Fluids Eng. 116, 405.  With three runs that of q₀ is his grid convergence index, 1.25
    times what is between it and the finest run, and there is none of the order.
    """
    dx, q = (np.array(x, float) for x in (spacings, values))
    order = np.argsort(-dx)
    scale = np.abs(q).max() or 1.0
    dx, q = dx[order] / dx.min(), q[order] / scale
    steps = np.diff(q)
    if len(q) < 3 or not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        return None

    def curve(x, limit, height, p):
        return limit + height * x**p

    start = (q[-1] + steps[-1], -steps[-1], 1.5)
    try:
        with warnings.catch_warnings(action="ignore", category=optimize.OptimizeWarning):
            best, covariance = optimize.curve_fit(curve, dx, q, p0=start, maxfev=10_000)
    except RuntimeError:
        return None
    if not 0.1 < best[2] < steepest:
        return None
    free = len(q) - 3
    wide = stats.t.ppf(0.5 + CONFIDENCE / 2, free) if free else math.nan
    reach = wide * np.sqrt(np.diag(covariance)) if free else np.full(3, math.nan)
    if not free:
        reach[0] = SAFETY * abs(q[-1] - best[0])
    limit, p = (
        Estimate(unit * best[k], unit * (best[k] - reach[k]), unit * (best[k] + reach[k]))
        for k, unit in ((0, scale), (2, 1.0))
    )
    return Extrapolated(limit, p)


SAFETY = 1.25
"""Of the index of three runs."""

SLOWEST, STEEPEST = 0.5, 2.0
"""Orders between which that of a run's own error is looked for: sums over particles have no higher
one, and below the lower the runs do not yet tell where they go."""

ASSUMED = 1.0
"""The order where one difference alone is known."""


class OwnError(NamedTuple):
    """The finest run's own relative error, and the order at which errors fall by it.

    ``measured``: whether the runs determine the order; else it is assumed.
    """

    error: float
    order: float
    measured: bool


def own_error(spacings: Sequence[float], differences: Sequence[float]) -> OwnError | None:
    """The error of the finest run by how much the coarser differ from it; None: nothing to go by.

    With errors C dx^p a run at dx differs from that at dx₀ by C (dx^p − dx₀^p); C and p through the
    last three differences, p between SLOWEST and STEEPEST.  ``differences`` are relative; that of
    the finest run is not looked at.
    """
    finest = min(spacings, default=math.nan)
    known = sorted((dx, d) for dx, d in zip(spacings, differences) if dx > finest)[:LAST]
    known = [(dx, d) for dx, d in known if d >= 0.0]
    if not known:
        return None
    if any(d == 0.0 for _, d in known):
        return OwnError(0.0, ASSUMED, False)  # nothing changes with the spacing
    ratio = np.array([dx / finest for dx, _ in known])
    log_d = np.log([d for _, d in known])

    def heights(p: float) -> np.ndarray:
        """log C dx₀^p by each difference."""
        return log_d - np.log(ratio**p - 1.0)

    p, measured = ASSUMED, len(known) > 1
    if measured:
        p = optimize.minimize_scalar(
            lambda p: np.var(heights(p)), bounds=(SLOWEST, STEEPEST), method="bounded"
        ).x
        measured = SLOWEST + UNSEEN < p < STEEPEST - UNSEEN
    return OwnError(float(np.exp(heights(p).mean())), float(p), measured)
