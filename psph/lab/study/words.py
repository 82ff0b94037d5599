"""The conclusions of a study, in sentences.  Each follows from its table."""

import math
from collections.abc import Iterator, Sequence

from psph.case.loader import parts_of
from psph.case.physics import PREFIX
from psph.case.profiles import OFF
from psph.lab.study.fit import LAST, Estimate, Extrapolated, Ladder, OwnError
from psph.lab.study.ladder import SPACING, toml
from psph.lab.study.report import joined, percent, seconds

SAME = 0.005
"""Relative changes below are called none."""

HALF = 0.5

FARTHEST = 2.0
"""How far beyond the spacings of a ladder times are compared, over the first and the last of them."""

ALL_WRONG = 1.0
"""Relative error from which on a spacing for half of it is no advice."""


def ladder_words(ladder: Ladder, name: str) -> Iterator[str]:
    """What a given error costs in a series of spacings."""
    finest = ladder.runs[-1]
    beginning = f"{name}: " if name else ""
    yield (
        f"{beginning}{percent(finest.error)} costs {seconds(finest.seconds)} (spacing {finest.spacing:g} m)."
    )
    if not ladder.steady:
        best = min(ladder.runs, key=lambda run: run.error)
        yield (
            f"{beginning}the error does not fall steadily: it is smallest at {best.spacing:g} m, "
            f"{percent(best.error)}. It depends on more than the spacing, so nothing is predicted."
        )
        return
    order = ladder.order
    yield (
        f"{beginning}the error falls with order {order.value:.2f}{within(order, '.2f')}"
        f"{unknown(order, len(ladder.runs))}."
    )
    if ladder.floor:
        yield (
            f"{beginning}extrapolated from the last {LAST} runs, {percent(ladder.floor)} remains at zero "
            "spacing."
        )
    if ladder.prediction:
        _, error, took = ladder.prediction
        yield (
            f"{beginning}the other runs predict {percent(error.value)} in {seconds(took.value)} for the "
            "finest one."
        )
    if finest.error >= ALL_WRONG:
        yield f"{beginning}nothing is resolved yet: try a finer spacing."
        return
    spacing = ladder.spacing_for_error(HALF * finest.error)
    if not math.isnan(spacing):
        longer = ladder.seconds(spacing).value / ladder.seconds(finest.spacing).value
        yield (
            f"{beginning}half that error is expected at a spacing of {spacing:.3g} m, in {longer:.1f} times "
            "the time."
        )


def own_error_words(own: OwnError) -> str:
    """What was added to the differences from the finest run, and how it is known."""
    how = (
        f"by the order {own.order:.2f} at which differences from it fall"
        if own.measured
        else f"for an order of {own.order:.1f}, assumed since these runs do not tell it"
    )
    return (
        f"The errors include that of the finest run itself, estimated as {percent(own.error)} {how}. "
        "An error that all spacings share is not seen: give an exact solution or an experiment where there "
        "is one."
    )


def against_base(row: dict, base: dict, what: str, ladder: Ladder | None) -> str:
    """``what`` one choice changes at the same spacing; with a ladder, what it saves at equal error."""
    if row["status"] != "done":
        return f"{what}: {row['status']}."
    time, error = row["seconds"] / base["seconds"], row["error_l2"]
    if math.isnan(error):
        return f"{what} takes {time:.2f} times as long; its own error is not known."
    if not base["error_l2"] > 0.0:
        return f"{what} takes {time:.2f} times as long and has an error of {percent(error)}."
    error /= base["error_l2"]
    same = f"{what} takes {time:.2f} times as long and has {error:.2f} times the error"
    if abs(error - 1.0) < SAME:
        same = f"{what} takes {time:.2f} times as long and has the same error"
    if ladder is None or not ladder.steady or not error > 0.0:
        return f"{same}."
    spacing = base[SPACING] * (1.0 / error) ** (1.0 / ladder.order.value)
    if not ladder.runs[-1].spacing / FARTHEST <= spacing <= ladder.runs[0].spacing * FARTHEST:
        return f"{same}."
    scaled = time * ladder.seconds(spacing).value / ladder.seconds(base[SPACING]).value
    return f"{same}: about {scaled:.2f} of the time for the same error."


def limit_words(what: str, found: Extrapolated, finest: float, runs: int, unit: str = "") -> str:
    """A quantity at zero spacing, from so many runs."""
    value = found.value
    how = " (by the grid convergence index)" if runs == LAST and not math.isnan(value.low) else ""
    of = f" {unit}" if unit else ""
    text = (
        f"{what} goes to {value.value:.6g}{within(value, '.3g')}{of}{how} at zero spacing, with order "
        f"{found.order.value:.2f}{within(found.order, '.2f')}"
    )
    if value.value and not found.order.low <= 0.0:
        text += f"; the finest run is {percent(abs(finest / value.value - 1.0))} off"
    return f"{text}{unknown(value, runs)}."


def failed_words(rows: Sequence[dict]) -> Iterator[str]:
    """The runs that did not finish."""
    failed = [row for row in rows if row["status"] != "done"]
    if failed:
        yield f"{len(failed)} of {len(rows)} runs did not finish: see their status."


def advice(settings: dict, error: Estimate, time: Estimate) -> Iterator[str]:
    """Which settings to use, with their error and time; the last lines can be put into the case."""
    yield (
        f"expect an error of {percent(error.value)}{interval(error, percent)} in "
        f"{seconds(time.value)}{interval(time, seconds)}, without compiling, with:"
    )
    tables: dict[str, list[str]] = {}
    for key, value in settings.items():
        table, _, name = key.rpartition(".")
        unsaid = value == OFF and not key.startswith(PREFIX)
        if unsaid or any(part.isdigit() for part in parts_of(key)):  # no line of a case says so
            tables.setdefault("", []).append(f"# and by the option --set {key}={toml(value)}")
        else:
            tables.setdefault(table, []).append(f"{name} = {_written(value)}")
    yield from tables.pop("", ())  # TOML wants them before any table
    for table, lines in tables.items():
        yield f"[{table}]"
        yield from lines


def _written(value) -> str:
    return f'"{value}"' if isinstance(value, str) else toml(value)


def within(estimate: Estimate, form: str) -> str:
    reach = estimate.high - estimate.value
    return "" if math.isnan(reach) else f" ± {reach:{form}}"


def unknown(estimate: Estimate, runs: int) -> str:
    """A remark on a value from too few runs to estimate its uncertainty."""
    return f"; its uncertainty is unknown with {runs} runs" if math.isnan(estimate.low) else ""


def interval(estimate: Estimate, write) -> str:
    if math.isnan(estimate.low):
        return " (too few runs for an uncertainty)"
    return f" ({write(estimate.low)} to {write(estimate.high)})"


def front_words(names: Sequence[str]) -> str:
    """The settings that no other beats in both error and time."""
    return f"No other run is both faster and more accurate than {joined(names)}."
