"""Mud and grains against what theory says of them, at two spacings, and the controls."""

import math

import numpy as np
import pytest
from cases.measures import by_id, finished
from long import LONG
from scipy.integrate import solve_ivp

pytestmark = pytest.mark.timeout(900)

HALF, PULL = 0.1, 1000.0
"""Half the distance of the plates, m, and the force between them, Pa/m."""

COARSE_CHANNEL = (
    "space.spacing=0.01",
    "space.lower=[0.0,-0.14]",
    "space.upper=[0.1,0.14]",
    "fluids.mud.shape.box.upper=[0.1,0.1]",
    "walls.plates.shape.difference.from.box={lower=[0.0,-0.14],upper=[0.1,0.14]}",
    "walls.plates.shape.difference.minus=[{box={lower=[0.0,-0.1],upper=[0.1,0.1]}}]",
)
"""Ten particles to half the gap, and a period that is wide enough for them."""


def fluid(run, frame=-1):
    """The fluid of a frame: its arrays by name."""
    found = run.frame(frame)
    return {name: values[found["kind"] == 0] for name, values in found.items()}


def between_plates(y, consistency, exponent=1.0, tau=0.0):
    """u of a paste at y from the middle, m/s: the rate ((ρf|y| − τ_y)/K)^(1/n) above the yield, integrated."""
    power = 1.0 + 1.0 / exponent
    plug = min(tau / PULL, HALF)
    beside = np.maximum(np.abs(y) - plug, 0.0)
    return (PULL / consistency) ** (1.0 / exponent) / power * ((HALF - plug) ** power - beside**power)


def channel_errors(run, *law):
    """Largest error of the profile over the largest speed, and error of the speed in the middle."""
    mud = fluid(run)
    y, u = mud["position"][:, 1], mud["velocity"][:, 0]
    exact = between_plates(y, *law)
    top = between_plates(0.0, *law)
    return np.abs(u - exact).max() / top, u[np.abs(y) < 0.02].mean() / between_plates(
        y[np.abs(y) < 0.02], *law
    ).mean() - 1


BINGHAM = (20.0, 1.0, 50.0)
POWER = (50.0, 0.5)


@pytest.mark.long
@pytest.mark.parametrize(("spacing", "profile", "middle"), [(COARSE_CHANNEL, 0.06, 0.05), ((), 0.03, 0.03)])
def test_a_bingham_channel_has_its_plug(spacing, profile, middle, tmp_path):
    run = finished("mud/bingham_channel", tmp_path, *spacing)
    assert run.unit("apparent_viscosity") == "Pa s" and run.unit("strain_rate") == "1/s"
    errors = channel_errors(run, *BINGHAM)
    assert errors[0] < profile and abs(errors[1]) < middle
    mud = fluid(run)
    y, rate, eta = mud["position"][:, 1], mud["strain_rate"], mud["apparent_viscosity"]
    assert rate[np.abs(y) < 0.02].max() < 0.01 * rate[np.abs(y) > 0.08].min()  # it moves as one
    stress = (rate * eta)[np.abs(y) > 0.06] / (PULL * np.abs(y)[np.abs(y) > 0.06])
    assert stress == pytest.approx(1.0, abs=0.1)


@pytest.mark.long
@pytest.mark.parametrize(("spacing", "most"), [(COARSE_CHANNEL, 0.03), ((), 0.03)])
def test_a_channel_of_a_fluid_that_thins_in_shear(spacing, most, tmp_path):
    run = finished("mud/power_law_channel", tmp_path, *spacing)
    profile, middle = channel_errors(run, *POWER)
    assert profile < most and abs(middle) < most
    newton = between_plates(0.0, *POWER) * (1.0 - (fluid(run)["position"][:, 1] / HALF) ** 2)
    assert np.abs(fluid(run)["velocity"][:, 0] - newton).max() > 3 * most * between_plates(0.0, *POWER)


def test_mud_below_its_yield_only_creeps_and_flows_with_a_lower_one(tmp_path):
    """y_p = 0.15 m is more than the half gap of 0.1: a creep −ln(1 − τ/τ_y)/m; the control flows."""
    short = (*COARSE_CHANNEL, "time.end=0.05", "output.frames=0.05")
    stands, flows = (
        fluid(
            finished(
                "mud/bingham_channel",
                tmp_path / str(tau),
                *short,
                f"fluids.mud.rheology.bingham.yield_stress={tau}",
                "fluids.mud.rheology.bingham.largest_viscosity=2000.0",
            )
        )["velocity"][:, 0].max()
        for tau in (150.0, 50.0)
    )
    part = PULL * HALF / 150.0
    creep = HALF * 150.0 / 2000.0 * (part + (1.0 - part) * math.log(1.0 - part)) / part
    assert stands == pytest.approx(creep, rel=0.1)
    assert flows > 5 * stands


COARSE_SLOPE = (
    "space.spacing=1.06e-3",
    "space.upper=[0.0106,0.02]",
    "space.lower=[0.0,-0.00318]",
    "fluids.grains.shape.box.upper=[0.0106,0.0106]",
    "walls.floor.shape.box={lower=[0.0,-0.00318],upper=[0.0106,0.0]}",
)


def bagnold(z, degrees, depth=0.0106, d=5.3e-4, packing=0.6):
    """u of grains at z over the floor of a slope, m/s."""
    slope, down = math.tan(math.radians(degrees)), 9.81 * math.cos(math.radians(degrees))
    inertial = 0.279 * (slope - 0.382) / (0.643 - slope)
    rise = depth**1.5 - np.maximum(depth - z, 0.0) ** 1.5
    return 2 * inertial / (3 * d) * math.sqrt(packing * down) * rise


@LONG
@pytest.mark.timeout(900)
@pytest.mark.parametrize(("degrees", "coarse", "fine"), [(24, 0.105, 0.045), (26, 0.08, 0.033)])
def test_grains_on_a_slope_have_the_profile_of_bagnold(degrees, coarse, fine, tmp_path):
    """With 10 layers and with 20, which halves the error at least; a start in disorder has the same.  On 24° 1 % of
    stress are 9 % of speed.  Where damping braked grains along the floor, until 28 November, that hid a fifth of it."""
    first, second = (
        off_bagnold(degrees, tmp_path / name, *sets) for name, sets in (("10", COARSE_SLOPE), ("20", ()))
    )
    assert first < coarse and second < fine and second < 0.5 * first


def off_bagnold(degrees, folder, *spacing):
    """The largest error of the speed over that on top; of means from 2.5 s on, since by sound that of a moment swings."""
    angle = math.radians(degrees)
    gravity = f"physics.gravity=[{9.81 * math.sin(angle)!r},{-9.81 * math.cos(angle)!r}]"
    top = float(bagnold(0.0106, degrees))
    begin = f"fluids.grains.velocity_gradient=[[0.0,{top / 0.0106!r}],[0.0,0.0]]"
    run = finished("mud/grains_on_slope", folder, gravity, begin, *spacing)
    off = []
    for frame in np.flatnonzero(np.array(run.times) > 2.5):
        grains = by_id(fluid(run, frame))
        off.append(grains["velocity"][:, 0] - bagnold(grains["position"][:, 1], degrees))
    assert len(off) > 5
    return np.abs(np.mean(off, axis=0)).max() / top


def test_grains_stand_on_a_slope_below_their_friction(tmp_path):
    """tan 18° = 0.325 < 0.382: they creep by the cap; at 30°, below the largest friction, they go."""
    stiff = "fluids.grains.rheology.granular.largest_viscosity=30.0"
    rest = "fluids.grains.velocity_gradient=[[0.0,0.0],[0.0,0.0]]"
    short = (*COARSE_SLOPE, stiff, rest, "time.end=0.1", "output.frames=0.1")
    speeds = []
    for degrees in (18.0, 30.0):
        angle = math.radians(degrees)
        gravity = f"physics.gravity=[{9.81 * math.sin(angle)!r},{-9.81 * math.cos(angle)!r}]"
        run = finished("mud/grains_on_slope", tmp_path / str(degrees), gravity, *short)
        speeds.append(fluid(run)["velocity"][:, 0].max())
    creep = 1500.0 * 9.81 * math.sin(math.radians(18.0)) * 0.0106**2 / (2 * 30.0)
    assert speeds[0] < 2 * creep
    assert speeds[1] > 6 * speeds[0]


VOLUME, WIDTH = 0.02, 0.02
"""Of the heap, m², and of the columns that its height is taken over, m."""


def heap(run, frame, spacing=0.005):
    """Middles of columns, m, the height of the mud in them, m, and where h² as a line in x comes to nothing."""
    x = fluid(run, frame)["position"][:, 0]
    edges = np.arange(0.0, 1.2 + WIDTH, WIDTH)
    height = np.histogram(x, edges)[0] * spacing**2 / WIDTH
    middle = 0.5 * (edges[1:] + edges[:-1])
    deep = height > 1.5 * spacing
    slope, square = np.polyfit(middle[deep], height[deep] ** 2, 1)
    return middle, height, -square / slope


def thin_layer(times, tau, n=120, length=1.2):
    """Middles of columns, m, and the height of the heap in them at ``times``, s, by the equation of a thin layer of
    a Bingham fluid that starts as the case does: ∂h/∂t = −∂q/∂x, q = ρg s y²(3h − y)/(6K) with the slope s = −∂h/∂x
    and the part y = h − τ_y/(ρg|s|) that shears (Matson & Hogg 2007).  It comes to rest as 1/t."""
    dx, weight = length / n, 1000.0 * 9.81
    x = (np.arange(n) + 0.5) * dx

    def rates(_, h):
        slope, between = -np.diff(h) / dx, 0.5 * (h[:-1] + h[1:])
        sheared = np.maximum(between - tau / (weight * np.maximum(np.abs(slope), 1e-12)), 0.0)
        flux = weight * slope * sheared**2 * (3.0 * between - sheared) / 6.0
        return -np.diff(np.r_[0.0, flux, 0.0]) / dx

    start = np.where(x < 0.4, 0.05, 0.0)
    found = solve_ivp(rates, (0.0, times[-1]), start, "LSODA", times, lband=1, uband=1, rtol=1e-6, atol=1e-8)
    return x, found.y.T


@pytest.mark.long
def test_a_heap_of_mud_stops_where_its_yield_stress_bears_it_and_a_newtonian_one_runs_on(tmp_path):
    """Measured, rms over the height in the middle: 5.3 and 5.2 % off the thin layer at 6 and 10 s, 10.4 and 8.6 % off
    the shape at rest, which the thin layer misses itself by 6.8 and 4.8 %."""
    run = finished("mud/bingham_slump", tmp_path / "mud", "output.frames=2.0")
    fall = 2 * 10.0 / (1000.0 * 9.81)
    reach = (1.5 * VOLUME / math.sqrt(fall)) ** (2 / 3)
    x, height, front = heap(run, -1)
    assert front == pytest.approx(reach, rel=0.1)
    exact = np.sqrt(fall * np.maximum(reach - x, 0.0))

    def apart(one, other):
        return np.sqrt(np.mean((one - other)[x < reach] ** 2)) / exact.max()

    assert apart(height, exact) < 0.1
    (thin, runny), times = (thin_layer((6.0, 10.0), tau)[1] for tau in (10.0, 0.0)), (3, 5)
    for frame, layer, oil in zip(times, thin, runny):
        found = heap(run, frame)[1]
        layer, oil = (h.reshape(len(x), -1).mean(axis=1) for h in (layer, oil))
        assert apart(found, layer) < 0.06 < 0.2 < apart(found, oil)
    before, after = (fluid(run, k)["position"][:, 0].max() for k in (-2, -1))
    assert 0.0 <= after - before < 0.03 * reach
    thin = (
        "fluids.mud.rheology.bingham.yield_stress=1e-6",
        "fluids.mud.rheology.bingham.largest_viscosity=1.01",
        "time.end=6.0",
    )
    newton = finished("mud/bingham_slump", tmp_path / "newton", *thin, "output.frames=2.0")
    assert fluid(newton)["position"][:, 0].max() > 1.15 * reach
