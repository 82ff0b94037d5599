"""Exact solutions obey their equations: divergence, momentum, boundaries, by differences."""

import math
from dataclasses import replace

import numpy as np
import pytest

from psph.theory.solutions.catalogue import SOLUTIONS, known
from psph.theory.solutions.channel import Couette, Poiseuille
from psph.theory.solutions.drop import EllipticDrop
from psph.theory.solutions.layers import InterfacialWave
from psph.theory.solutions.setting import Setting
from psph.theory.solutions.still import Hydrostatic
from psph.theory.solutions.thread import LiquidThread
from psph.theory.solutions.tube import ShockTube
from psph.theory.solutions.vortices import Beltrami, Gresho, TaylorGreen
from psph.theory.solutions.waves import SoundWave, StandingWave

FREE = Setting(
    dimensions=2,
    density=2.0,
    densities=(2.0,),
    viscosity=0.0,
    sound_speed=10.0,
    gravity=(0.0, 0.0),
    lower=(0.0, 0.0),
    upper=(1.0, 1.0),
    periods=(1.0, 1.0),
)
STICKY = replace(FREE, viscosity=0.03)
IN_3D = replace(
    STICKY, dimensions=3, gravity=(0.0,) * 3, lower=(0.0,) * 3, upper=(1.0,) * 3, periods=(1.0,) * 3
)
CHANNEL = replace(STICKY, periods=(1.0, None))
DRIVEN = replace(CHANNEL, gravity=(0.4, 0.0))
HEAVY = replace(FREE, gravity=(0.0, -9.81), periods=(None, None))
LAYERED = replace(HEAVY, densities=(2.0, 1.0))
SURFACED = replace(IN_3D, surface_tension=3.0)
STEP = 1e-4

FLOWS = {
    "taylor_green": (TaylorGreen(1.5, 0.5), STICKY),
    "beltrami": (Beltrami(1.5, 0.5), IN_3D),
    "gresho": (Gresho(1.5, 0.2, (0.5, 0.5)), FREE),
    "poiseuille": (Poiseuille(0.1, 0.9), DRIVEN),
    "couette": (Couette(0.1, 0.9, 0.7), CHANNEL),
    "sound_wave": (SoundWave(1e-4, 0.5), FREE),
    "standing_wave": (StandingWave(1e-5, 1.0, 0.5, 0.9), HEAVY),
    "interfacial_wave": (InterfacialWave(1e-3, 0.7, (0.9, 0.1), (0.2, -0.1), 0.9), LAYERED),
    "liquid_thread": (LiquidThread(0.1, 0.5, 0.9), SURFACED),
    "hydrostatic": (Hydrostatic(0.8), HEAVY),
    "elliptic_drop": (EllipticDrop(3.0, 0.4), replace(FREE, periods=(None, None))),
    "shock_tube": (ShockTube(1.0, 1.0, 0.125, 0.1, 0.2, 0.0, 0.5), FREE),
}
MOVING = [name for name, (flow, _) in FLOWS.items() if hasattr(flow, "velocity")]


def places(setting: Setting = FREE, n: int = 40) -> np.ndarray:
    """Points off every axis of symmetry, and inside all domains."""
    return np.random.default_rng(3).uniform(0.31, 0.69, (n, setting.dimensions))


def gradient(field, x):
    """∂f/∂x_d by central differences, (n, ..., dim)."""
    steps = STEP * np.eye(x.shape[1])
    return np.stack([(field(x + s) - field(x - s)) / (2 * STEP) for s in steps], axis=-1)


def laplacian(field, x):
    steps = STEP * np.eye(x.shape[1])
    return sum((field(x + s) - 2 * field(x) + field(x - s)) / STEP**2 for s in steps)


def test_the_catalogue_is_covered():
    assert FLOWS.keys() == SOLUTIONS.keys()
    for name, (flow, setting) in FLOWS.items():
        assert isinstance(flow, SOLUTIONS[name]) and known(flow)
        assert flow.unfit(setting) is None and set(flow.up_to_a_constant) <= set(known(flow))


@pytest.mark.parametrize("name", [n for n in MOVING if n not in ("sound_wave", "shock_tube")])
def test_no_volume_appears(name):
    flow, setting = FLOWS[name]
    slope = gradient(lambda x: flow.velocity(x, 0.02, setting), places(setting))
    size = np.abs(slope).max()
    assert np.abs(np.trace(slope, axis1=1, axis2=2)).max() < 1e-6 * size


@pytest.mark.parametrize(
    "name", ["taylor_green", "beltrami", "gresho", "poiseuille", "couette", "elliptic_drop"]
)
def test_momentum_balances(name):
    """Du/Dt = −∇p/ρ + ν∇²u + g."""
    flow, setting = FLOWS[name]
    x, t = places(setting), 0.3
    u = flow.velocity(x, t, setting)
    rate = (flow.velocity(x, t + STEP, setting) - flow.velocity(x, t - STEP, setting)) / (2 * STEP)
    rate += np.einsum("nd,nkd->nk", u, gradient(lambda y: flow.velocity(y, t, setting), x))
    push = np.zeros_like(u) + setting.gravity
    push += setting.viscosity * laplacian(lambda y: flow.velocity(y, t, setting), x)
    if hasattr(flow, "pressure"):
        push -= gradient(lambda y: flow.pressure(y, t, setting), x) / setting.density
    assert np.abs(rate - push).max() < 2e-5 * np.abs(push).max()


def test_a_tube_keeps_mass_and_momentum_where_it_is_smooth():
    """In the fan, and jumps carry what they must through the whole: ∫ρ dx and ∫ρu dx by the fluxes."""
    flow, setting = FLOWS["shock_tube"]
    x = np.column_stack([np.linspace(-1.0, 2.0, 300_001), np.zeros(300_001)])
    mass, momentum = [], []
    for t in (0.0, 0.2):
        rho, u = flow.density(x, t, setting), flow.velocity(x, t, setting)[:, 0]
        mass.append(np.trapezoid(rho, x[:, 0]))
        momentum.append(np.trapezoid(rho * u, x[:, 0]))
    assert mass[1] - mass[0] == pytest.approx(0.2 * 1.0 * 0.2, abs=1e-5)  # ρu enters at the left end
    assert momentum[1] - momentum[0] == pytest.approx(0.2 * (1.0 + 0.2**2 - 0.1), abs=1e-5)
    assert "vacuum" in flow._replace(left_velocity=-9.0, right_velocity=9.0).unfit(setting)
    assert "outside" in flow._replace(at=2.0).unfit(setting)


def test_small_waves_obey_linear_momentum():
    flow, setting = FLOWS["sound_wave"]
    x, t = places(), 0.013
    rate = (flow.velocity(x, t + 1e-6, setting) - flow.velocity(x, t - 1e-6, setting)) / 2e-6
    slope = gradient(lambda y: flow.pressure(y, t, setting), x)
    assert np.allclose(rate, -slope / setting.density, atol=1e-5 * np.abs(rate).max())


def test_plates_hold_the_fluid_at_their_own_speed():
    for name, top in (("poiseuille", 0.0), ("couette", 0.7)):
        flow, setting = FLOWS[name]
        walls = np.array([[0.3, 0.1], [0.3, 0.9]])
        assert flow.velocity(walls, 0.5, setting)[:, 0] == pytest.approx([0.0, top], abs=1e-12)
        inside = np.column_stack([np.zeros(9), np.linspace(0.15, 0.85, 9)])
        start = np.abs(flow.velocity(inside, 0.0, setting))
        assert start.max() < 0.02 * flow.top_speed(setting)  # the series at its slowest
        late = flow.velocity(inside, 1e3, setting)[:, 0]
        assert np.abs(late).max() <= flow.top_speed(setting) * (1 + 1e-12)
    assert DRIVEN.gravity[0] * 0.8**2 / (8 * 0.03) == pytest.approx(FLOWS["poiseuille"][0].top_speed(DRIVEN))


def test_a_drop_keeps_its_area_and_feels_no_pressure_outside():
    flow, setting = FLOWS["elliptic_drop"]
    a, rate = flow.shape(0.4)
    assert a < 0.7 and 0.0 < rate < 3.0
    angle = np.linspace(0.0, 6.0, 20)
    edge = 0.4 * np.column_stack([a * np.cos(angle), np.sin(angle) / a])
    peak = flow.pressure(np.zeros((1, 2)), 0.4, setting)[0]
    assert peak > 0.0 and np.abs(flow.pressure(edge, 0.4, setting)).max() < 1e-8 * peak
    energy = [r * r * (b * b + 1 / b**2) for b, r in (flow.shape(0.0), (a, rate))]
    assert energy[0] == pytest.approx(energy[1], rel=1e-8)  # ∫u²/2 over the ellipse


def test_still_water_and_a_wave_know_gravity():
    flow, setting = FLOWS["hydrostatic"]
    p = flow.pressure(np.array([[0.0, 0.3], [0.5, 0.8], [0.1, 0.95]]), 7.0, setting)
    assert p == pytest.approx([2.0 * 9.81 * 0.5, 0.0, 0.0], abs=1e-12)
    wave, setting = FLOWS["standing_wave"]
    deep = wave._replace(depth=50.0)
    assert deep.frequency(setting) == pytest.approx(math.sqrt(9.81 * 2 * math.pi))
    floor = np.array([[0.13, 0.4], [0.77, 0.4]])
    assert np.abs(wave.velocity(floor, 0.0, setting)[:, 1]).max() == 0.0


@pytest.mark.parametrize(
    ("flow", "setting", "says"),
    [
        (TaylorGreen(1.0, 0.5), replace(FREE, dimensions=3), "2D"),
        (Beltrami(1.0, 0.5), FREE, "3D"),
        (TaylorGreen(1.0, 0.5), replace(FREE, periods=(1.0, None)), "space.periodic"),
        (TaylorGreen(1.0, 0.3), FREE, "whole multiple"),
        (Gresho(1.0, 0.2), STICKY, "viscosity"),
        (Poiseuille(0.1, 0.9), CHANNEL, "gravity"),
        (Couette(0.1, 0.9, 1.0), DRIVEN, "gravity"),
        (Couette(0.9, 0.1, 1.0), CHANNEL, "below upper"),
        (Couette(0.1, 0.9, 1.0), replace(CHANNEL, viscosity=0.0), "friction"),
        (Couette(0.1, 0.9, 1.0), replace(CHANNEL, periods=(None, None)), "space.periodic"),
        (SoundWave(1.0, 0.7), FREE, "whole multiple"),
        (StandingWave(0.1, 1.0, 1.0), FREE, "gravity"),
        (Hydrostatic(0.0), FREE, "gravity"),
        (EllipticDrop(1.0, 0.1), STICKY, "friction"),
        (EllipticDrop(1.0, 0.1), replace(FREE, dimensions=3), "2D"),
    ],
)
def test_what_does_not_fit_is_said(flow, setting, says):
    assert says in flow.unfit(setting)


@pytest.mark.parametrize("gravity", (-9.81, 0.0, 2.0))
def test_a_wave_between_layers_obeys_what_holds_at_its_interface(gravity):
    """Both sides move with it, and bear one pressure: ∂p/∂x = −ρ (∂/∂t + U ∂/∂x) u − ρg ∂η/∂x there; lids hold."""
    wave, setting = (
        InterfacialWave(1e-6, 0.7, (0.3, 0.5), (0.2, -0.1)),
        replace(LAYERED, gravity=(0.0, gravity)),
    )
    k, x, t, near = 2.0 * math.pi / 0.7, np.linspace(0.0, 0.7, 9), 0.3, 1e-5

    def height(x, t):
        return (wave.displacement(t, setting)[0] * np.exp(1j * k * x)).real

    slopes = []
    for way, flow, rho in zip((-1.0, 1.0), wave.flows, setting.densities):

        def along(f, flow=flow):
            """(∂/∂t + U ∂/∂x) f."""
            ahead, back = (f(x + flow * s, t + s) for s in (STEP, -STEP))
            return (ahead - back) / (2.0 * STEP)

        def speed(x, t, way=way):
            return wave.velocity(np.column_stack([x, np.full_like(x, way * near)]), t, setting)

        assert np.abs(speed(x, t)[:, 1] - along(height)).max() < 1e-3 * wave.speed
        rise = (height(x + STEP, t) - height(x - STEP, t)) / (2.0 * STEP)
        slopes.append(rho * (along(speed)[:, 0] - gravity * rise))
    assert np.abs(slopes[0] - slopes[1]).max() < 2e-3 * np.abs(slopes[0]).max() > 0.0
    lids = np.array([[0.13, -0.3], [0.13, 0.5]])
    assert np.abs(wave.velocity(lids, t, setting)[:, 1]).max() == 0.0


def test_waves_between_layers_swing_and_grow_as_told():
    """The periods of layers of half a metre at 2, 10 and 1000 : 1; Rayleigh–Taylor at 1.8 : 1; Kelvin–Helmholtz,
    k ΔU √(ρ₁ρ₂)/(ρ₁ + ρ₂)."""
    wave = InterfacialWave(0.1, 2.0, (0.5, 0.5))
    for light, period in ((500.0, 2.047), (100.0, 1.307), (1.0, 1.183)):
        _, swing = wave.roots(replace(LAYERED, densities=(1000.0, light)))
        assert 2.0 * math.pi / swing.real == pytest.approx(period, abs=6e-4) and swing.imag == 0.0
    deep = InterfacialWave(0.1, 1.0, (5.0, 5.0), (-0.5, 0.5))
    falling = replace(LAYERED, densities=(1.0, 1.8), gravity=(0.0, -1.0))
    _, growth = deep._replace(flows=(0.0, 0.0)).roots(falling)
    assert abs(growth.imag) == pytest.approx(1.3398, abs=1e-4) and growth.real == pytest.approx(
        0.0, abs=1e-12
    )
    for light in (1000.0, 500.0):
        drift, growth = deep.roots(replace(LAYERED, densities=(1000.0, light), gravity=(0.0, 0.0)))
        found = 2.0 * math.pi * math.sqrt(1000.0 * light) / (1000.0 + light)
        assert abs(growth.imag) == pytest.approx(found) and drift.real == pytest.approx(
            math.pi * (light - 1000.0) / (1000.0 + light)
        )


@pytest.mark.parametrize("waves", (0.7, 1.3))
def test_the_surface_of_a_thread_moves_as_the_wave_and_bears_what_laplace_says(waves):
    """Without friction ρ ∂u/∂t = −∂p/∂x at r = R, p = −σ (η/R² + η″), here at a node."""
    radius, setting = 0.9, replace(SURFACED, viscosity=0.0)
    thread, t = LiquidThread(0.1, 2.0 * math.pi * radius / waves, radius), 0.3
    k = waves / radius
    height, rate = thread.displacement(t, setting)
    crest, side = np.array([[0.0, radius, 0.0]]), np.array([[0.25 * thread.length, 0.0, radius]])
    assert thread.velocity(crest, t, setting)[0, 1] == pytest.approx(rate)
    ahead, back = (thread.velocity(side, t + s, setting)[0, 0] for s in (STEP, -STEP))
    pressure_slope = (
        3.0 * (k * k - 1.0 / radius**2) * height * -k
    )  # at a node, σ (k² − 1/R²) η is the pressure
    assert 2.0 * (ahead - back) / (2.0 * STEP) == pytest.approx(-pressure_slope, rel=1e-5)
    growing = thread.roots(setting)[1].imag
    assert (growing != 0.0) == (waves < 1.0)


def test_threads_grow_at_the_rate_of_rayleigh():
    """0.343 √(σ/ρR³) at kR = 0.7, near the fastest."""
    one = replace(SURFACED, density=1.0, surface_tension=1.0, viscosity=0.0)
    _, growth = LiquidThread(0.1, 2.0 * math.pi / 0.7, 1.0).roots(one)
    assert abs(growth) == pytest.approx(0.3433, abs=1e-4)
