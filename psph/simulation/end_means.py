"""Means over the faces of open ends as whole numbers, and the state that is put behind them."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.physics.open_ends import column_pressure, column_weight
from psph.simulation.end_fit import DEPTH, FITTED, NEAR, SEEN, depth
from psph.simulation.rules import density

BY_SPEED, BY_PRESSURE, BY_LEVEL = 0, 1, 2
"""What an end gives."""

TERMS = 16
"""Numbers that are summed for an end: over its buffer, a row counting once, 1, p, u, the pressure given, ρ₀c,
and of what comes in 1 and u; over the fluid in front 1, ξ, p − p_t, ξ², ξ (p − p_t); particles that have come
too far; those behind that see the fluid in front of the plane itself; rows of fluid in front, each counting
once; over its buffer pu."""

ONE = 2.0**40
"""The whole number of a term as large as its unit."""

FALLS = 4.0
"""Spacings of the column behind a plane that its pressure pushes where nothing is in front."""

MOST = 4.0
"""In units, the largest term: beyond it a run has blown up."""


class Units(NamedTuple):
    """Of terms: ``pressure`` ρ₀c² in Pa, ``impedance`` ρ₀c in kg/(m² s), ``speed`` c in m/s, ``length`` dx in
    m, the largest of a scene."""

    pressure: float
    impedance: float
    speed: float
    length: float


class Standing(NamedTuple):
    """Particles behind the planes or before them as lists were made: their ``columns`` (n,), the ``end``
    (n,), the ``shape`` (n,) of what comes in there."""

    columns: np.ndarray
    end: np.ndarray
    shape: np.ndarray


class Told(NamedTuple):
    """What ends give now, (ends,): ``what`` it is; its ``value``, of a velocity end the mean speed; 1 where
    that goes ``out``, so that the fluid gives its shape, else 0; the ``inflow``, mean speed in m/s of what
    comes in through a pressure end, the ``slope`` of its pressure in Pa/m."""

    what: np.ndarray
    value: np.ndarray
    out: np.ndarray
    inflow: np.ndarray
    slope: np.ndarray


@helper
def _given_at(told, end, planes, k, flowing):
    """The pressure that an end gives column ``k``, Pa: p_t in the middle of its height, or that of a still
    column under a surface; below that of the fluids that stood behind it."""
    edges, rest, pull = planes.edges[end], planes.rest[end], planes.pull
    height = middle = 0.0
    for d in range(len(flowing.position)):
        x, by_level = flowing.position[d][k], told.what[end] == BY_LEVEL
        height += planes.up[d] * (x if by_level or d != planes.axis[end] else planes.place[end])
        middle += planes.up[d] * (planes.middle[end, d] if d != planes.axis[end] else planes.place[end])
    if by_level:
        return column_pressure(told.value[end], height, pull, edges, rest, planes.sound[end])
    return told.value[end] + column_weight(middle, height, pull, edges, rest)


@helper
def _whole(share):
    """A term in its unit as a whole number, exact to 2^-40; 0 for what is no number."""
    return np.int64(np.rint(max(-MOST, min(MOST, share)) * ONE)) if share == share else np.int64(0)


@elementwise
def sum_behind(behind, planes, told, flowing, units, far, seen, sums):
    """Add to ``sums`` (ends, TERMS) what those ``behind`` the planes have, as they have ``seen`` the fluid;
    particles that are ``far`` m before a plane have come too far."""
    for n in range(len(behind.columns)):
        k, end = behind.columns[n], behind.end[n]
        xi = depth(planes, end, flowing, k)
        into = seen[n, FITTED + 1 + planes.axis[end]] * planes.sign[end]
        hat = max(1.0 - abs(xi / units.length - 1.0), 0.0) * seen[n, SEEN]
        enters = hat if into > planes.pace[end] else 0.0
        given, pressure = 0.0, seen[n, FITTED]
        if told.what[end] != BY_SPEED:
            given = _given_at(told, end, planes, k, flowing)
            fall = planes.up[planes.axis[end]] * planes.sign[end] * planes.pull * flowing.rest[k]
            pressure -= fall * (xi - seen[n, DEPTH]) + told.slope[end] * seen[n, DEPTH]
        row = sums[end]
        row[0] += _whole(hat)
        row[1] += _whole(hat * pressure / units.pressure)
        row[2] += _whole(hat * into / units.speed)
        row[3] += _whole(hat * given / units.pressure)
        row[4] += _whole(hat * flowing.rest[k] * flowing.sound[k] / units.impedance)
        row[5] += _whole(enters)
        row[6] += _whole(enters * into / units.speed)
        row[12] += 1 if xi < -far else 0
        row[13] += _whole(seen[n, NEAR])
        row[15] += _whole(hat * pressure * into / (units.pressure * units.speed))


@elementwise
def sum_before(front, planes, told, flowing, units, far, reach, sums):
    """Add to ``sums`` (ends, TERMS) what the fluid in ``front`` of the planes has within ``reach`` m;
    particles that are ``far`` m behind one have come too far."""
    for n in range(len(front.columns)):
        k, end = front.columns[n], front.end[n]
        xi, row = depth(planes, end, flowing, k), sums[end]
        row[12] += 1 if xi > far else 0
        tent = max(0.5 - abs(0.25 * xi / units.length + 0.5), 0.0)
        row[14] += _whole(tent * flowing.rest[k] * flowing.volume[k])
        if told.what[end] != BY_SPEED and -reach < xi <= 0.0:
            over = flowing.pressure[k] - _given_at(told, end, planes, k, flowing)
            x, p = xi / units.length, over / units.pressure
            row[7] += _whole(1.0)
            row[8] += _whole(x)
            row[9] += _whole(p)
            row[10] += _whole(x * x / MOST)
            row[11] += _whole(x * p)


@helper
def _let_go(into, push, length, dt):
    """The inward speed, m/s, of what has nothing before it, after dt: p/ρ, the ``push`` in m²/s², pushes a
    column of this ``length``, m, up to √(2p/ρ)."""
    return max(into, min(into + dt * push / length, np.sqrt(2.0 * max(push, 0.0))))


@elementwise
def fill_behind(behind, planes, told, flowing, laws, law_of, units, dt, seen, fastest):
    """Give those ``behind`` the planes their velocity, pressure and density after a step of ``dt`` s.

    ``fastest`` (2,) gets the largest square of a change of the velocity and of the velocity, m²/s².
    """
    dim = len(flowing.velocity)
    for n in range(len(behind.columns)):
        k, end = np.uint64(behind.columns[n]), behind.end[n]
        axis, sign, sees = planes.axis[end], planes.sign[end], seen[n, SEEN] > 0.0
        into = seen[n, FITTED + 1 + axis] * sign if sees else flowing.velocity[axis][k] * sign
        pressure, pace = seen[n, FITTED], planes.pace[end]
        if told.what[end] == BY_SPEED:
            along = into if told.out[end] > 0.0 else pace + behind.shape[n] * told.value[end]
        else:
            xi = depth(planes, end, flowing, k)
            pressure = _given_at(told, end, planes, k, flowing)
            pressure += told.slope[end] * xi
            if sees:
                along = pace + behind.shape[n] * (told.inflow[end] - pace) if into > pace else into
            else:
                along = _let_go(into, pressure / flowing.rest[k], FALLS * units.length, dt)
        along += planes.speed[end]
        pressure += planes.pressure[end]
        if planes.open[end]:
            pressure = max(pressure, 0.0)
        change2 = speed2 = 0.0
        for d in range(dim):
            v = seen[n, FITTED + 1 + d] if along < pace and sees and not planes.open[end] else 0.0
            x = flowing.position[d][k]
            if d == axis:
                v = along * sign
            elif (v < 0.0 and x < planes.low[end, d]) or (v > 0.0 and x > planes.high[end, d]):
                v = 0.0
            change2 += (v - flowing.velocity[d][k]) ** 2
            speed2 += v * v
            flowing.velocity[d][k] = v
            flowing.predicted[d][k] = v
        fastest[0], fastest[1] = max(fastest[0], change2), max(fastest[1], speed2)
        law = law_of[flowing.group[k]]
        rho = density(laws, law, pressure, flowing.rest[k], flowing.sound[k])
        flowing.density[k] = rho
        flowing.volume[k] = 1.0 / rho
        flowing.pressure[k] = pressure
