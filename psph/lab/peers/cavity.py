"""The lid-driven cavity from rest, by finite differences: ``python -m psph.lab.peers.cavity FILE``.

At t = 10 the flow at Re 1000 is far from the steady one of Ghia and others (1982), so a run that begins
from rest is judged by this solution at the same time.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.fft import dstn, idstn

REYNOLDS = 1000.0
TIMES = (5.0, 10.0)
"""L/U."""

COARSE = 128
"""Intervals a side; the other grid of the extrapolation has twice as many."""

STEP = 0.25
"""The time step over h/U; it is 0.1 of h² over the viscosity at most too, for Adams–Bashforth."""


def solve(intervals: int, reynolds: float, times: Sequence[float]) -> list[tuple[np.ndarray, np.ndarray]]:
    """u(y) at x = ½ and v(x) at y = ½ at each of the ``times``, (intervals + 1,) each, over the lid's speed.

    ∂ω/∂t + u·∇ω = ∇²ω/Re and ∇²ψ = −ω in central differences, Adams–Bashforth in time, ψ by sine
    transforms, ω of the walls from ψ at two points (Jensen's formula, second order).
    """
    n, h = intervals, 1.0 / intervals
    eigen = (2.0 * np.cos(np.pi * np.arange(1, n) / n) - 2.0) / h**2
    laplace = eigen[:, None] + eigen[None, :]
    vorticity, stream = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    longest = min(0.1 * h * h * reynolds, STEP * h)
    before, now, found = None, 0.0, []
    walls(vorticity, stream, h)
    for until in times:
        steps = int(np.ceil((until - now) / longest))
        dt = (until - now) / steps
        for _ in range(steps):
            rate = rate_of(vorticity, stream, h, reynolds)
            vorticity[1:-1, 1:-1] += dt * (rate if before is None else 1.5 * rate - 0.5 * before)
            stream[1:-1, 1:-1] = idstn(dstn(-vorticity[1:-1, 1:-1], type=1) / laplace, type=1)
            walls(vorticity, stream, h)
            before = rate
        now = until
        u, v = np.zeros(n + 1), np.zeros(n + 1)
        u[1:-1] = (stream[n // 2, 2:] - stream[n // 2, :-2]) / (2.0 * h)
        v[1:-1] = -(stream[2:, n // 2] - stream[:-2, n // 2]) / (2.0 * h)
        u[-1] = 1.0
        found.append((u, v))
    return found


def walls(vorticity: np.ndarray, stream: np.ndarray, h: float) -> None:
    """The vorticity at the walls, from no slip; the lid at y = 1 moves with u = 1."""
    for along, value, lid in ((stream, vorticity, True), (stream.T, vorticity.T, False)):
        value[:, 0] = (along[:, 2] - 8.0 * along[:, 1]) / (2.0 * h * h)
        value[:, -1] = (along[:, -3] - 8.0 * along[:, -2]) / (2.0 * h * h) - 3.0 * lid / h


def rate_of(vorticity: np.ndarray, stream: np.ndarray, h: float, reynolds: float) -> np.ndarray:
    """∂ω/∂t at the inner points."""
    inner, low, high = slice(1, -1), slice(None, -2), slice(2, None)
    u = (stream[inner, high] - stream[inner, low]) / (2.0 * h)
    v = -(stream[high, inner] - stream[low, inner]) / (2.0 * h)
    along_x = (vorticity[high, inner] - vorticity[low, inner]) / (2.0 * h)
    along_y = (vorticity[inner, high] - vorticity[inner, low]) / (2.0 * h)
    around = vorticity[high, inner] + vorticity[low, inner] + vorticity[inner, high] + vorticity[inner, low]
    return (around - 4.0 * vorticity[inner, inner]) / (h * h * reynolds) - u * along_x - v * along_y


def extrapolated(intervals: int = COARSE) -> np.ndarray:
    """s, and u(y = s), v(x = s) at each of TIMES, (intervals + 1, 1 + 2 times): (4 f(h/2) − f(h))/3."""
    coarse, fine = (solve(n, REYNOLDS, TIMES) for n in (intervals, 2 * intervals))
    columns = [
        (4.0 * b[::2] - a) / 3.0
        for at, of in zip(coarse, fine, strict=True)
        for a, b in zip(at, of, strict=True)
    ]
    return np.column_stack([np.linspace(0.0, 1.0, intervals + 1), *columns])


def main(arguments: list[str]) -> int:
    """Write the table; the exit code."""
    if len(arguments) != 1:
        print("python -m psph.lab.peers.cavity FILE", file=sys.stderr)
        return 2
    names = ",".join(f"{of}{time:g}" for time in TIMES for of in "uv")
    head = (
        "# Lid-driven cavity at Re 1000 from rest: u(y = s) on the vertical and v(x = s) on the horizontal\n"
        "# centre line at t = 5 and 10, over the lid's speed. Finite differences, extrapolated from\n"
        "# 128 and 256 intervals a side:\n"
        "# python -m psph.lab.peers.cavity FILE\n"
    )
    rows = (",".join(f"{value:.6g}" for value in row) for row in extrapolated())
    Path(arguments[0]).write_text(f"{head}s,{names}\n" + "\n".join(rows) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
