"""Machines for fluids, against exact solutions and boundary elements: rheometer, stirred vessel, gear pump."""

import math

import numpy as np
import pytest
from cases.gear_pump_by_boundaries import APART, SPEED, TIP, delivered
from cases.measures import finished, window
from cases.stokes_by_boundaries import circle, closed, moments
from scipy.optimize import brentq

INNER, OUTER = 0.012, 0.02
"""Radii of the rheometer, m."""


def newtonian(viscosity, speed):
    """Moment between two cylinders, N: 4πμΩ R₁²R₂²/(R₂² − R₁²)."""
    return 4.0 * math.pi * viscosity * speed / (INNER**-2 - OUTER**-2)


def power_law(consistency, exponent, speed):
    """The same where the stress is K γ̇ⁿ: 2πK (2Ω/(n (R₁^(−2/n) − R₂^(−2/n))))ⁿ."""
    power = -2.0 / exponent
    return 2.0 * math.pi * consistency * (-power * speed / (INNER**power - OUTER**power)) ** exponent


def bingham(plastic, tau, speed):
    """The same by Reiner's equation, of a fluid that yields within √(M/(2πτ))."""

    def lacks(moment):
        radius = min(OUTER, math.sqrt(moment / (2.0 * math.pi * tau)))
        sheared = moment / (4.0 * math.pi) * (INNER**-2 - radius**-2) - tau * math.log(radius / INNER)
        return sheared / plastic - speed

    return brentq(lacks, 2.0 * math.pi * tau * INNER**2 * 1.0001, 1.0)


def mean_moment(run, name, begin):
    """Of a gauge from a time on, N m/m."""
    table = run.gauges()[name]
    return float(np.mean(window(table, f"{name}.moment_z", begin, math.inf)))


def torques(folder, case, begin, *keys):
    """Of bob and cup."""
    early = (f"numbers.{name}.after={begin}" for name in ("bob", "cup"))
    run = finished(f"machines/{case}", folder, *keys, *early)
    return -mean_moment(run, "bob", begin), mean_moment(run, "cup", begin)


def test_a_rheometer_has_the_moment_of_couette(tmp_path):
    """Both within 2 %, and alike; the control slips along its cup."""
    exact = newtonian(1260.0 * 1.12e-3, 10.0)
    bob, cup = torques(tmp_path / "sticks", "rheometer", 0.04, "time.end=0.06")
    assert bob == pytest.approx(exact, rel=0.02) and cup == pytest.approx(bob, rel=0.01)
    slips = torques(tmp_path / "slips", "rheometer", 0.04, "time.end=0.06", "walls.cup.no_slip=false")
    assert slips[1] < 0.97 * exact


@pytest.mark.long
@pytest.mark.timeout(600)
def test_a_rheometer_tells_a_fluid_that_thins_in_shear(tmp_path):
    """Stress 5 γ̇^½: both within 3 %."""
    law = "fluids.glycerol.rheology.power_law={consistency=5.0,exponent=0.5,largest_viscosity=5.0}"
    found = torques(tmp_path, "rheometer", 0.06, law, "fluids.glycerol.viscosity=0.0")
    assert found == pytest.approx((power_law(5.0, 0.5, 10.0),) * 2, rel=0.03)


@pytest.mark.long
@pytest.mark.timeout(600)
def test_a_rheometer_tells_a_paste(tmp_path):
    """Bob and cup within 3 %; it yields to 18.4 mm, and stands before the cup."""
    exact = bingham(1.0, 20.0, 5.0)
    assert OUTER > math.sqrt(exact / (2.0 * math.pi * 20.0)) > 0.018
    found = torques(tmp_path, "rheometer_paste", 0.02, "time.end=0.03")
    assert found == pytest.approx((exact, exact), rel=0.03)


def power_number(moment):
    """Np Re of the stirred vessel: P/(μN²D²), with its moment in N."""
    return 2.0 * math.pi * moment / (1300.0 * 3.6e-3 * 0.06**2)


def by_boundaries(count):
    """Np Re in creeping flow, of so many elements around the vessel."""
    corners = [(-0.03, -0.005), (0.03, -0.005), (0.03, 0.005), (-0.03, 0.005)]
    vessel = closed(circle((0.0, 0.0), 0.05, count), 1.0)
    paddle = closed(corners, 0.09 / count, 2.0 * math.pi, inner=True)
    outer, inner = moments((vessel, paddle), 1300.0 * 3.6e-3, (0.0, 0.0))
    assert outer == pytest.approx(-inner, rel=1e-3)
    return power_number(outer)


def test_boundary_elements_have_the_moment_of_couette():
    """And converge: in second order to that, in first to that of a paddle with edges."""
    off = []
    for count in (100, 200):
        walls = (
            closed(circle((0.0, 0.0), OUTER, count), 1.0),
            closed(circle((0.0, 0.0), INNER, count), 1.0, 10.0, inner=True),
        )
        off.append(moments(walls, 1.4, (0.0, 0.0))[0] / newtonian(1.4, 10.0) - 1.0)
    assert abs(off[0]) < 5e-4 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)
    assert by_boundaries(100) == pytest.approx(by_boundaries(200), rel=4e-3)


def stirred(folder, *keys):
    """Np Re of the vessel, by the moments on the paddle and on the wall."""
    run = finished("machines/stirred_vessel", folder, *keys)
    return power_number(-mean_moment(run, "paddle", 0.1)), power_number(mean_moment(run, "vessel", 0.1))


@pytest.mark.timeout(300)
def test_a_coarse_stirred_vessel(tmp_path):
    """12 spacings to half the paddle: both moments alike, within 10 % of creeping flow."""
    paddle, vessel = stirred(tmp_path, "space.spacing=0.0025")
    assert vessel == pytest.approx(paddle, rel=0.01)
    assert paddle == pytest.approx(by_boundaries(200), rel=0.1)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_stirred_vessel_has_the_power_number_of_creeping_flow(tmp_path):
    """Within 5 %."""
    assert stirred(tmp_path) == pytest.approx((by_boundaries(200),) * 2, rel=0.05)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_gear_pump_delivers_what_creeping_flow_has_it_deliver(tmp_path):
    """Within 7 % by both mouths together, while its spaces still fill; less than without slip, 2π (R² − a²) a turn."""
    early = (f"numbers.{name}.after=0.02" for name in ("drawn", "delivered"))
    gauges = finished("machines/gear_pump", tmp_path, "time.end=0.13", *early).gauges()
    begin = 0.13 - 2.0 * math.pi / 6.0 / SPEED
    flows = [float(window(gauges[g], f"{g}.flow", begin, 0.13).mean()) for g in ("drawn", "delivered")]
    turn = np.array(flows) * 2.0 * math.pi / SPEED
    assert turn.mean() == pytest.approx(delivered(0.0015)[0], rel=0.07)
    assert turn.max() < 2.0 * math.pi * (TIP**2 - APART**2)
