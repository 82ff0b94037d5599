"""A square set off in a box by finite differences: incompressible, on a staggered grid that goes with the square.

The grid is even along the square's sides and grows towards the walls; between the square and the ends of the box it
is stretched as the square goes on, with the velocity of its columns taken off the one that carries.  Central
differences, Adams and Bashforth's second-order step, and a pressure that leaves no divergence.
"""

import math

import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq
from scipy.sparse.linalg import LinearOperator, cg, splu

NU = 0.01
PEAK, LATE, WIDE = 2.821, 0.5257, 0.1414
"""The square's acceleration is PEAK exp(−(t − LATE)²/(2 WIDE²))."""


def speed(t):
    """The square's, its final one 1."""
    rest = math.erf(LATE / (WIDE * math.sqrt(2.0)))
    return PEAK * WIDE * math.sqrt(0.5 * math.pi) * (math.erf((t - LATE) / (WIDE * math.sqrt(2.0))) + rest)


def drag(cells, end, courant=0.4):
    """Times and drag coefficients by pressure and friction (n, 3), ``cells`` along a side of the square."""
    flow = _Flow(cells)
    rows = []
    while flow.time < end:
        flow.step(min(courant * flow.d / (1.3 * max(abs(flow.u).max(), 1.0)), 0.2 * flow.d**2 / NU, 0.01))
        rows.append((flow.time, *flow.drag()))
    return np.array(rows)


def _grown(length, first, n):
    """Edges of ``n`` cells that begin with ``first`` and grow evenly."""
    if n * first >= length * (1.0 - 1e-4):
        return np.linspace(0.0, length, n + 1)
    ratio = brentq(lambda q: first * (q**n - 1.0) / (q - 1.0) - length, 1.0 + 1e-7, 2.0)
    return length * (ratio ** np.arange(n + 1) - 1.0) / (ratio**n - 1.0)


def _slopes(minus, here, plus, before, after):
    """First and second derivative from three values ``before`` and ``after`` apart."""
    left, right = (here - minus) / before, (plus - here) / after
    return (left * after + right * before) / (before + after), 2.0 * (right - left) / (before + after)


class _Flow:
    """Velocities on faces, ``u`` (nx + 1, ny) and ``v`` (nx, ny + 1), the box 10 x 5, the square's corner at (1, 2)."""

    def __init__(self, cells):
        self.cells, self.d, self.time, self.way = cells, 1.0 / cells, 0.0, 0.0
        aside = _grown(2.0, self.d, cells)
        side = np.linspace(0.0, 1.0, cells + 1)[1:]
        self.y = np.concatenate([2.0 - aside[::-1], 2.0 + side, 3.0 + aside[1:]])
        self.behind, self.low = round(1.2 * cells), cells  # first column and row of the square
        self.x = self._columns()
        nx, ny = len(self.x) - 1, len(self.y) - 1
        self.i, self.j = slice(self.behind, self.behind + cells), slice(self.low, self.low + cells)
        wet = np.ones((nx, ny), bool)
        wet[self.i, self.j] = False
        self.wet, self.open_u, self.open_v = wet, wet[1:] & wet[:-1], wet[:, 1:] & wet[:, :-1]
        self.number = np.where(wet, np.cumsum(wet).reshape(wet.shape) - 1, -1)
        self.u, self.v = np.zeros((nx + 1, ny)), np.zeros((nx, ny + 1))
        self.pressure, self.before, self.steps = np.zeros(np.count_nonzero(wet)), None, 0

    def _columns(self):
        tail = 1.0 + self.way
        behind = _grown(tail, min(self.d, tail / self.behind), self.behind)
        ahead = _grown(8.0 - self.way, self.d, round(2.5 * self.cells))
        side = np.linspace(0.0, 1.0, self.cells + 1)[1:]
        return np.concatenate([tail - behind[::-1], tail + side, tail + 1.0 + ahead[1:]])

    def step(self, dt):
        """One step, by the velocities' rates now and before."""
        then = self.time + dt
        now, soon = self.x, speed(then)
        self.way += dt / 6.0 * (speed(self.time) + 4.0 * speed(self.time + 0.5 * dt) + soon)
        self.x = self._columns()
        rates = self._rates(now, (self.x - now) / dt, speed(self.time))
        old, share = self.before or (rates, dt)
        share = 0.5 * dt / share
        self.before = rates, dt
        u, v = (
            one + dt * ((1.0 + share) * new - share * was)
            for one, new, was in zip((self.u, self.v), rates, old)
        )
        u[1:-1][~self.open_u], v[:, 1:-1][~self.open_v] = 0.0, 0.0
        u[self.behind : self.behind + self.cells + 1, self.j] = soon
        self._project(u, v, dt)
        self.u, self.v, self.time, self.steps = u, v, then, self.steps + 1

    def _project(self, u, v, dt):
        """Take the gradient of the pressure off, so that no cell gains water."""
        dx, dy = np.diff(self.x), np.diff(self.y)
        xs, ys = 0.5 * (dx[1:] + dx[:-1])[:, None], 0.5 * (dy[1:] + dy[:-1])[None]
        along, across = (dy[None] / xs)[self.open_u], (dx[:, None] / ys)[self.open_v]
        first = np.concatenate([self.number[:-1][self.open_u], self.number[:, :-1][self.open_v]])
        second = np.concatenate([self.number[1:][self.open_u], self.number[:, 1:][self.open_v]])
        n = len(self.pressure)
        links = sp.coo_matrix((np.concatenate([along, across]), (first, second)), (n, n))
        links = (links + links.T).tocsc()
        poisson = (sp.diags(np.asarray(links.sum(axis=1)).ravel()) - links).tocsc()
        if self.steps % 60 == 0:  # the columns move slowly: an older factor is a good preconditioner
            held = np.zeros(n)
            held[0] = poisson[0, 0]
            self.factor = splu((poisson + sp.diags(held)).tocsc())
        gained = ((u[1:] - u[:-1]) * dy[None] + (v[:, 1:] - v[:, :-1]) * dx[:, None])[self.wet] / -dt
        near = LinearOperator((n, n), self.factor.solve)
        self.pressure, failed = cg(
            poisson, gained - gained.mean(), x0=self.pressure, rtol=1e-7, M=near, maxiter=60
        )
        assert not failed
        p = self._pressures()
        u[1:-1] -= dt * np.where(self.open_u, np.diff(p, axis=0) / xs, 0.0)
        v[:, 1:-1] -= dt * np.where(self.open_v, np.diff(p, axis=1) / ys, 0.0)

    def _pressures(self):
        p = np.zeros(self.wet.shape)
        p[self.wet] = self.pressure
        return p

    def _rates(self, x, going, square):
        """−(u − w)·∇u + ν∇²u for both, w the velocity of the columns (``going``)."""
        u, v, y = self.u, self.v, self.y
        dx, dy = np.diff(x)[:, None], np.diff(y)[None]
        x_mid, y_mid = 0.5 * (x[1:] + x[:-1])[:, None], 0.5 * (y[1:] + y[:-1])[None]
        by_u, by_v = np.zeros_like(u), np.zeros_like(v)
        # Along x: values on walls and on the square's sides stand where these are.
        here = u[1:-1]
        shape = np.ones_like(here)
        below, above = np.pad(here[:, :-1], ((0, 0), (1, 0))), np.pad(here[:, 1:], ((0, 0), (0, 1)))
        gap = np.diff(y_mid)[0]
        under = np.concatenate([[y_mid[0, 0] - y[0]], gap]) * shape
        over = np.concatenate([gap, [y[-1] - y_mid[0, -1]]]) * shape
        beside, low, high = (
            slice(self.behind - 1, self.behind + self.cells),
            self.low - 1,
            self.low + self.cells,
        )
        above[beside, low], over[beside, low] = square, y[self.low] - y_mid[0, low]
        below[beside, high], under[beside, high] = square, y_mid[0, high] - y[high]
        in_x, in_xx = _slopes(u[:-2], here, u[2:], dx[:-1], dx[1:])
        in_y, in_yy = _slopes(below, here, above, under, over)
        across = 0.25 * (v[1:, 1:] + v[1:, :-1] + v[:-1, 1:] + v[:-1, :-1])
        by_u[1:-1] = -(here - going[1:-1, None]) * in_x - across * in_y + NU * (in_xx + in_yy)
        # Along y.
        here = v[:, 1:-1]
        shape = np.ones_like(here)
        left, right = np.pad(here[:-1], ((1, 0), (0, 0))), np.pad(here[1:], ((0, 1), (0, 0)))
        gap = np.diff(x_mid[:, 0])[:, None]
        back = np.concatenate([x_mid[:1] - x[0], gap]) * shape
        front = np.concatenate([gap, x[-1] - x_mid[-1:]]) * shape
        beside, last = slice(self.low - 1, self.low + self.cells), self.behind + self.cells
        right[self.behind - 1, beside] = left[last, beside] = 0.0
        front[self.behind - 1, beside] = x[self.behind] - x_mid[self.behind - 1, 0]
        back[last, beside] = x_mid[last, 0] - x[last]
        in_x, in_xx = _slopes(left, here, right, back, front)
        in_y, in_yy = _slopes(v[:, :-2], here, v[:, 2:], dy[:, :-1], dy[:, 1:])
        along = 0.25 * (u[1:, 1:] + u[1:, :-1] + u[:-1, 1:] + u[:-1, :-1])
        columns = 0.5 * (going[1:] + going[:-1])[:, None]
        by_v[:, 1:-1] = -(along - columns) * in_x - here * in_y + NU * (in_xx + in_yy)
        return by_u, by_v

    def drag(self):
        """Coefficients by pressure, carried on to the face from two cells, and by friction on both sides."""
        p, x, y = self._pressures(), 0.5 * (self.x[1:] + self.x[:-1]), 0.5 * (self.y[1:] + self.y[:-1])
        first, last = self.behind, self.behind + self.cells

        def on_face(near, far, place):
            return p[near, self.j] + (p[near, self.j] - p[far, self.j]) * (place - x[near]) / (
                x[near] - x[far]
            )

        push = on_face(last, last + 1, self.x[last]) - on_face(first - 1, first - 2, self.x[first])
        edge = np.full(self.cells + 1, self.d)
        edge[[0, -1]] *= 0.5
        square, sides, rubbed = speed(self.time), slice(first, last + 1), 0.0
        for near, far, face in (
            (self.low - 1, self.low - 2, self.y[self.low]),
            (self.low + self.cells, self.low + self.cells + 1, self.y[self.low + self.cells]),
        ):
            h, k = abs(y[near] - face), abs(y[far] - face)
            slope = ((square - self.u[sides, near]) * k / h - (square - self.u[sides, far]) * h / k) / (k - h)
            rubbed += NU * (slope * edge).sum()
        return 2.0 * push.sum() * self.d, 2.0 * rubbed
