"""Viscosities that depend on the rate of strain: the laws, the rate itself, and the friction between two."""

import math
from types import SimpleNamespace

import numba
import numpy as np
import pytest
from invariances.running import begun, by_id
from invariances.scenes import SCENES
from physics.pairs import H, sums_of, view

from psph.physics.fluid.apparent import ApparentFriction, ApparentViscosity, FluidAlone, StickingWalls
from psph.physics.fluid.correction import GradientCorrection
from psph.physics.fluid.friction import Apparent, CorrectedRub, Rub
from psph.physics.fluid.rheology import Cross, Granular, HerschelBulkley, Newtonian, apparent_viscosity
from psph.physics.fluid.viscosity import LaminarViscosity
from psph.physics.motion import Fixed
from psph.physics.walls.slip import GrippedFlow, NoSlip

PASTE = HerschelBulkley(10.0, 2.0, 0.5, 30.0, 1e6)
POWER = HerschelBulkley(0.0, 2.0, 1.5, 0.0, 1e6)
POLYMER = Cross(5.0, 0.1, 2.0, 0.7)
GRAINS = Granular(0.382, 0.643, 0.279, 5.3e-4, 2500.0, 1e-3, 1e6)
LAWS = (Newtonian(), PASTE, POWER, POLYMER, GRAINS)


def test_the_laws_are_what_their_sources_say():
    rate, p = 0.7, 40.0
    assert PASTE.viscosity(rate, p, 0.0) == pytest.approx(2 / rate**0.5 + 10 * (1 - math.exp(-21.0)) / rate)
    assert POWER.viscosity(rate, p, 0.0) == pytest.approx(2 * rate**0.5)
    assert POLYMER.viscosity(rate, p, 0.0) == pytest.approx(0.1 + 4.9 / (1 + 1.4**0.7))
    inertial = rate * 5.3e-4 / math.sqrt(p / 2500.0)
    mu = 0.382 + (0.643 - 0.382) / (1 + 0.279 / inertial)
    assert GRAINS.viscosity(rate, p, 0.0) == pytest.approx(mu * p / math.hypot(rate, 1e-3))
    assert Newtonian().viscosity(rate, p, 3.0) == 3.0


@pytest.mark.parametrize("law", LAWS[1:])
def test_a_law_is_a_number_at_rest_and_never_above_its_largest(law):
    capped = law if isinstance(law, Cross) else law._replace(largest=50.0)
    for rate in (0.0, 1e-300, 1e-9, 1e-3, 1.0, 1e6):
        for p in (-5.0, 0.0, 1e4):
            found = capped.viscosity(rate, p, 0.0)
            assert 0.0 <= found <= capped.largest
    assert PASTE._replace(exponent=1.0).viscosity(0.0, 0.0, 0.0) == pytest.approx(2 + 30 * 10)  # K + m tau


def test_grains_bear_no_shear_without_pressure():
    assert GRAINS.viscosity(1.0, 0.0, 0.0) == GRAINS.viscosity(1.0, -100.0, 0.0) == 0.0
    assert GRAINS.viscosity(0.0, 10.0, 0.0) == pytest.approx(3.82 / 1e-3)  # at rest the lower friction


@numba.njit
def compiled(laws, number, rate, pressure, own):
    return apparent_viscosity(laws, number, rate, pressure, own)


@pytest.mark.parametrize("number", range(len(LAWS)))
def test_each_particle_has_the_law_of_its_fluid(number):
    for rate, p in ((0.0, 0.0), (0.3, 20.0), (1e3, 1e4)):
        expected = LAWS[number].viscosity(rate, p, 7.0)
        assert apparent_viscosity(LAWS, float(number), rate, p, 7.0) == expected
        assert compiled(LAWS, float(number), rate, p, 7.0) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("law", (PASTE, PASTE._replace(exponent=1.3), POWER))
def test_the_speed_between_plates_is_the_integral_of_the_rate(law):
    pull, half = 300.0, 0.1
    y = (np.arange(200_000) + 0.5) / 200_000 * half
    rate = np.array([law.rate_under(stress) for stress in pull * y[::100]])
    assert law.speed_between(pull, half) == pytest.approx(rate.mean() * half, rel=2e-3)
    assert law.rate_under(law.yield_stress) == 0.0
    resting = law._replace(yield_stress=pull * half)
    assert resting.speed_between(pull, half) == 0.0


def test_grains_on_a_slope_have_the_speed_of_bagnold():
    """The numbers of Jop, Forterre & Pouliquen's law for beads of 0.53 mm, 20 of them deep."""
    for degrees, speed in ((24.0, 0.284), (26.0, 0.600)):
        slope, down = math.tan(math.radians(degrees)), 9.81 * math.cos(math.radians(degrees))
        assert GRAINS.speed_on_slope(slope, 1500.0 * down, 0.0106) == pytest.approx(speed, rel=2e-3)
    assert (
        GRAINS.speed_on_slope(0.38, 1e4, 0.01) == 0.0 and GRAINS.speed_on_slope(0.65, 1e4, 0.01) == math.inf
    )


def crowd(dim, n=14, seed=5):
    """Fluid particles all within reach of the first, in a linear flow, and two of a wall."""
    p = view(n=n, dim=dim, seed=seed)
    rng = np.random.default_rng(seed)
    gradient = rng.normal(size=(dim, dim))
    velocity = tuple(gradient @ np.array(p.position) + 0.3)
    fluid = np.array([1.0] * (n - 2) + [0.0] * 2)
    return p._replace(velocity=velocity, is_fluid=fluid, rubs=np.ones(n), rheology=np.ones(n)), gradient


def strain_rate(gradient):
    """The root of 2 D:D."""
    d = 0.5 * (gradient + gradient.T)
    return math.sqrt(2.0 * (d * d).sum())


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_the_rate_of_strain_is_exact_in_a_linear_flow_in_disorder_and_on_one_side(dim):
    p, gradient = crowd(dim)
    p = p._replace(mass=p.mass * 1e4)  # a dense crowd: its determinant is above where the rate fades
    effect = ApparentFriction((Newtonian(), PASTE), 1.0, FluidAlone(), Rub(Apparent()))
    for k in range(3):
        rate, eta, *found = sums_of(effect, p, k)
        assert rate == pytest.approx(strain_rate(gradient), rel=1e-9)
        assert found == pytest.approx(gradient.ravel(), rel=1e-9)
        assert eta == pytest.approx(PASTE.viscosity(rate, 0.0, 0.0))
    assert not np.any(sums_of(effect, p, len(p.mass) - 1))  # a wall has none
    turning = np.triu(gradient, 1) - np.triu(gradient, 1).T
    turned = p._replace(velocity=tuple(turning @ np.array(p.position)))
    assert sums_of(effect, turned, 0)[0] == pytest.approx(0.0, abs=1e-9)


def test_a_wall_counts_by_its_grip_with_what_it_mirrors():
    """A wall that mirrors the linear flow itself leaves it exact, whatever the grip; another one does not."""
    p, gradient = crowd(2)
    p = p._replace(mass=p.mass * 1e4, grip=np.where(p.is_fluid > 0, 0.0, 0.6))
    shown, still = np.array(p.velocity), np.array(p.velocity)
    still[:, p.is_fluid == 0] = 0.0
    right = p._replace(velocity=tuple(still), slip=tuple(np.where(p.is_fluid > 0, 0.0, shown)))
    effect = ApparentFriction((Newtonian(), PASTE), 1.0, StickingWalls(), Rub(Apparent()))
    assert sums_of(effect, right, 0)[0] == pytest.approx(strain_rate(gradient), rel=1e-9)
    wrong = right._replace(slip=tuple(np.zeros_like(shown)))
    assert sums_of(effect, wrong, 0)[0] != pytest.approx(strain_rate(gradient), rel=1e-3)
    loose = wrong._replace(grip=np.zeros(len(p.mass)))
    assert sums_of(effect, loose, 0)[0] == pytest.approx(strain_rate(gradient), rel=1e-9)


@pytest.mark.parametrize("correction", (None, GradientCorrection(0.5)))
def test_no_slip_rubs_as_the_fluid_does(correction):
    physics = SimpleNamespace(gradient_correction=correction, central_friction=None, laplacian_friction=None)
    mud = SimpleNamespace(
        no_slip=True, rheology=1, density=1000.0, viscosity=0.0, rubs=True, motion=Fixed(), bonded=None
    )
    scene = SimpleNamespace(physics=physics, species=(mud,), rheologies=(PASTE,))
    friction, sticking = ApparentViscosity().in_scene(scene), NoSlip().in_scene(scene)
    assert isinstance(sticking, GrippedFlow) and friction.largest == PASTE.largest / 1000.0
    for one in (friction, sticking):
        assert isinstance(one.friction.of, Apparent)
        assert isinstance(one.friction, CorrectedRub if correction else Rub)
    assert LaminarViscosity().in_scene(scene) is None


def test_the_grip_is_one_at_the_face_and_fades_behind_it():
    """A wall of three layers below a lattice of fluid: 1, a little, nothing."""
    dx = H / 1.4
    x, y = (a.ravel() for a in np.meshgrid(np.arange(-4, 5) * dx, (np.arange(-3, 4) + 0.5) * dx))
    n, fluid = len(x), (y > 0).astype(float)
    p = view(n=n)._replace(
        position=(x, y),
        is_fluid=fluid,
        no_slip=1.0 - fluid,
        mass=np.full(n, 1000.0 * dx * dx),
        specific_volume=np.full(n, 1e-3),
    )
    effect = GrippedFlow(Rub())
    grips = [sums_of(effect, p, np.argmin(abs(x) + abs(y - level * dx)))[-1] for level in (-0.5, -1.5, -2.5)]
    assert grips[0] > 0.9 and 0.0 < grips[1] < 0.1 and grips[2] == 0.0
    assert sums_of(effect, p, np.argmin(abs(x) + abs(y - 0.5 * dx)))[-1] == 0.0  # fluid


def test_mud_begins_in_single_precision_as_in_double(tmp_path):
    """Before the first sums no particle has an apparent viscosity: the mean of two such was 0/0 in single
    precision, and no mud made a step."""
    found = []
    for precision in ("mixed", "double"):
        ran = begun({**SCENES["mud by bingham"], "precision": precision}, tmp_path)
        for _ in range(3):
            ran.step()
        found.append(by_id(ran, "velocity"))
    single, double = found
    assert 0.0 < np.abs(single - double).max() < 1e-5 * np.abs(double).max()
