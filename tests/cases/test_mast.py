"""A mast on a pontoon: it bends as a beam does whose foot goes where the pontoon takes it."""

import numpy as np
import pytest
from cases.measures import finished
from scipy.interpolate import CubicSpline

DECK, GAUGE, LENGTH = 0.5, 0.49, 0.5
"""m: the height of the deck at the start, that of the gauge above it, and of the mast."""

BENDING, MASS, GRAVITY = 1.2e6 * 0.08**3 / 12.0, 600.0 * 0.08, 9.81
"""EI in N m² and mass by length in kg/m of a strip 1 m wide; m/s²."""

SOFT = 2.17
"""Hz: of this mast on a clamp at rest, 4 particles thick; a thin beam has 2.31."""


def bent(time, foot, height, turn, length):
    """How far, m, the top of a beam stands to +x of the line of its base (n,), at even times (n,), s.

    m (X'' − θ'' z + w'') + EI w'''' + m (g + Y'') [(L − z)(w' − θ)]' = 0 for a base that moves by ``foot`` X and
    ``height`` Y, m, and turns by ``turn`` θ, rad: Galerkin's method with z² … z⁵, the implicit midpoint rule.
    """
    powers = np.arange(2, 6)[:, None]
    z, share = np.polynomial.legendre.leggauss(12)
    z, share = 0.5 * length * (z + 1.0), 0.5 * length * MASS * share
    shape, slope = (z / length) ** powers, powers * (z / length) ** (powers - 1) / length
    curve = powers * (powers - 1) * (z / length) ** (powers - 2) / length**2
    mass, stiff = (shape * share) @ shape.T, BENDING / MASS * (curve * share) @ curve.T
    weight, leans = (slope * share * (length - z)) @ slope.T, (slope * share) @ (length - z)
    pushed, turned = (shape * share).sum(axis=1), (shape * share) @ z
    x, y, a = (CubicSpline(time, one) for one in (foot, height, turn))
    dt, q, v, tops = time[1] - time[0], np.zeros(4), np.zeros(4), [0.0]
    for t in time[:-1] + 0.5 * dt:
        pull = GRAVITY + y(t, 2)
        force = turned * a(t, 2) - pushed * x(t, 2) - pull * leans * a(t)
        own = stiff - pull * weight
        after = np.linalg.solve(mass + dt**2 / 4 * own, mass @ v + dt * (force - own @ (q + dt / 4 * v)))
        q, v = q + 0.5 * dt * (v + after), after
        tops.append(q @ (GAUGE / length) ** powers[:, 0])
    return np.array(tops)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_mast_bends_as_a_beam_on_the_path_of_its_pontoon(tmp_path):
    """That of its own frequency to 4 % rms.  Control: a thin beam bends less by a tenth."""
    gauges = finished("mast_on_pontoon", tmp_path).gauges()
    body, top = gauges["pontoon"], gauges["top"]
    turn, y = body["pontoon.turn_z"], body["pontoon.centre_y"]
    foot = body["pontoon.centre_x"] - turn * (DECK - y[0])
    foot -= foot[0]
    told = top["top.displacement_x"] - (foot - turn * GAUGE)
    time = np.linspace(0.0, body["time"][-1], len(turn))
    path = [np.interp(time, body["time"], one) for one in (foot, y, turn)]
    told = np.interp(time, top["time"], told)
    as_slow = np.sqrt(1.8751**2 / (2.0 * np.pi * SOFT) * np.sqrt(BENDING / MASS))
    late = time > 3.0
    by_own, by_thin = (bent(time, *path, length)[late] for length in (as_slow, LENGTH))
    size = np.sqrt(np.mean(told[late] ** 2))
    assert size > 0.01
    assert np.sqrt(np.mean((told[late] - by_own) ** 2)) < 0.04 * size
    assert np.sqrt(np.mean((told[late] - by_thin) ** 2)) > 0.08 * size
