"""One judge for all codes: errors of the particles that they leave, and of what gauges read."""

import math
from pathlib import Path

import numpy as np

from psph.lab.errors import PeersError
from psph.lab.peers.records import Outcome, State
from psph.theory.solutions.setting import Setting
from psph.theory.solutions.vortices import TaylorGreen

EXPERIMENTS = Path("run/cases/experiments")

REYNOLDS = 100.0
"""Of the Taylor–Green vortices: UL/ν, U and L are 1."""

REACH = 2.8
"""Radius of the least squares on a centre line, in spacings."""

ARRIVED = 500.0
"""Pressure at P1 in Pa above which the water has met the box."""

PEAK = 0.02
"""Seconds of the mean of which the largest is taken."""


def columns_of(name: str) -> dict[str, np.ndarray]:
    """A table of experiments by its columns.  PeersError: it is not there."""
    try:
        lines = (EXPERIMENTS / name).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise PeersError(f"{EXPERIMENTS / name}: {error.strerror}; start from the folder of psph") from None
    head, *rows = [line for line in lines if not line.startswith("#")]
    values = np.array([[float(value) for value in row.split(",")] for row in rows])
    return dict(zip(head.split(","), values.T))


def rms(values: np.ndarray) -> float:
    """√ of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def taylor_green(outcome: Outcome) -> tuple[str, ...]:
    """L2 and L∞ of the velocity's error over those of the exact velocity, at the state's own time, in %."""
    state = last(outcome)
    flow = TaylorGreen(1.0, 1.0)
    where = {"lower": (0.0, 0.0), "upper": (1.0, 1.0), "periods": (1.0, 1.0), "gravity": (0.0, 0.0)}
    setting = Setting(dimensions=2, density=1.0, viscosity=1.0 / REYNOLDS, sound_speed=10.0, **where)
    exact = flow.velocity(state.position, state.time, setting)
    off = state.velocity - exact
    speeds, errors = np.linalg.norm(exact, axis=1), np.linalg.norm(off, axis=1)
    return tuple(digits(100.0 * e) for e in (rms(errors) / rms(speeds), errors.max() / speeds.max()))


def cavity(outcome: Outcome) -> tuple[str, ...]:
    """rms error of u / v on the centre lines at t = 5 and 10; at 10 also against Ghia's steady flow."""
    right = columns_of("cavity_re1000_from_rest.csv")
    ghia = [columns_of(f"ghia_1982_{of}.csv") for of in "uv"]
    lines = [(of, table["yx"[k]][1:-1]) for k, (of, table) in enumerate(zip("uv", ghia))]
    found = {}
    for state in outcome.states:
        t = round(state.time)
        for k, (of, s) in enumerate(lines):
            points = np.column_stack([np.full_like(s, 0.5), s] if of == "u" else [s, np.full_like(s, 0.5)])
            value = at_points(state, points)[:, k]
            found[of, t] = rms(value - np.interp(s, right["s"], right[f"{of}{t}"]))
            found[of, "Ghia"] = rms(value - ghia[k][f"{of}_re1000"][1:-1])
    return tuple(f"{found['u', of]:.3f} / {found['v', of]:.3f}" for of in (5, 10, "Ghia"))


def at_points(state: State, points: np.ndarray) -> np.ndarray:
    """The velocity at ``points`` (m, 2), by least squares of first order over the particles around each."""
    spacing = math.sqrt(1.0 / len(state.position))
    found = []
    for point in points:
        away = state.position - point
        r = np.linalg.norm(away, axis=1) / (REACH * spacing)
        near = r < 1.0
        weight = (1.0 - r[near]) ** 4 * (1.0 + 4.0 * r[near])
        terms = np.column_stack([np.ones(near.sum()), away[near]])
        matrix = terms.T @ (terms * weight[:, None])
        found.append(np.linalg.solve(matrix, terms.T @ (state.velocity[near] * weight[:, None]))[0])
    return np.array(found)


def tank(outcome: Outcome) -> tuple[str, ...]:
    """Error of the pressure in % of ρgH, rms / largest; with the level fitted; the speed in mm/s."""
    state, (density, pull, depth) = last(outcome), (1000.0, 1.0, 0.9)
    off = (state.pressure / (density * pull) - (depth - state.position[:, 1])) / depth
    speed = 1e3 * np.linalg.norm(state.velocity, axis=1)
    pairs = [(rms(e), np.abs(e).max()) for e in (100.0 * off, 100.0 * (off - off.mean()))]
    return tuple(f"{digits(a)} / {digits(b)}" for a, b in [*pairs, (rms(speed), speed.max())])


def box(outcome: Outcome) -> tuple[str, ...]:
    """rms errors of H2 and H4 to 2 s over that of the record, %; arrival, s; P1 over 20 ms, kPa."""
    series, record = outcome.series, columns_of("kleefsman_2005_levels.csv")
    t = record["t"]
    told = (t <= series["t"][-1]) & (t <= 2.0)
    errors = [
        100.0 * rms(np.interp(t[told], series["t"], series[of]) - record[of][told]) / rms(record[of][told])
        for of in ("H2", "H4")
    ]
    met = series["t"][series["P1"] > ARRIVED]
    arrival = f"{met[0]:.3f}" if len(met) else "–"
    return (
        digits(errors[0]),
        digits(errors[1]),
        arrival,
        digits(largest_mean(series["t"], series["P1"]) / 1e3),
    )


def largest_mean(t: np.ndarray, values: np.ndarray, width: float = PEAK) -> float:
    """The largest mean over ``width`` s of values that are linear between the times ``t``."""
    whole = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))])
    ends = t[t >= t[0] + width]
    return float(((np.interp(ends, t, whole) - np.interp(ends - width, t, whole)) / width).max())


def last(outcome: Outcome) -> State:
    """The last state."""
    return outcome.states[-1]


def digits(value: float) -> str:
    """Two digits, or as many as it has before the point; what is below 0.001 is 0."""
    if value != value:
        return "–"
    if abs(value) < 1e-3:
        return "0"
    return f"{value:.0f}" if abs(value) >= 10.0 else f"{float(f'{value:.2g}'):g}"
