"""Growth on lattices: the prototype's numbers, the windows, the remedies, the search itself."""

import itertools

import numpy as np
import pytest
from theory.stability.settings import TENSION, of

from psph.smoothing import KERNELS
from psph.theory.stability import parts
from psph.theory.stability.couplings import couplings
from psph.theory.stability.errors import StabilityError
from psph.theory.stability.growth import box_growth, growth, is_stable, waves_of
from psph.theory.stability.lattices import LATTICES, lattice
from psph.theory.stability.uniform import Uniform
from psph.theory.stability.windows import SMOOTHINGS, windows


@pytest.mark.parametrize(
    ("kernel", "smoothing", "infinite", "box"),
    [
        ("cubic", 1.2, 2812, 2693),
        ("cubic", 1.3, 2201, 2127),
        ("hyperbolic", 1.2, 3107, 3004),
        ("hyperbolic", 1.3, 2609, 2543),
    ],
)
def test_case_4_2(kernel, smoothing, infinite, box):
    settings = TENSION._replace(kernel=kernel, smoothing=smoothing)
    found = growth(settings)
    assert found.rate == pytest.approx(infinite, abs=0.5) and not found.stable
    assert np.linalg.norm(found.wave_vector) == pytest.approx(np.pi / 1e-3)  # two spacings long
    assert box_growth(settings, 15).rate == pytest.approx(box, abs=0.5)


def test_a_box_comes_to_the_infinite_lattice():
    """Monotonically: a larger box leaves the fastest wave more room."""
    rates = [box_growth(TENSION, n).rate for n in (1, 3, 7, 15, 21)] + [growth(TENSION).rate]
    assert rates == sorted(rates) and rates[-2] > 0.97 * rates[-1]


def test_units():
    """Per second is √(|P|/ρ)/dx times as much, whatever the units."""
    unit = (2500.0 / 900.0) ** 0.5 / 1e-3
    plain = of("cubic", 1.2, pressure=-1.0, sound_speed=3.0)
    assert growth(TENSION).rate == pytest.approx(growth(plain).rate * unit, rel=1e-9)
    assert growth(TENSION).wave_vector == pytest.approx(growth(plain).wave_vector / 1e-3)


@pytest.mark.parametrize("c", (3.0, 10.0, 100.0))
def test_hyperbolic_under_compression_has_a_window(c):
    """What grows is transverse: c plays no part."""
    rates = {h: growth(of("hyperbolic", h, sound_speed=c)) for h in (1.2, 1.25, 1.3, 1.35, 1.4)}
    assert [h for h, one in rates.items() if one.stable] == [1.25, 1.3, 1.35]
    assert rates[1.2].rate == pytest.approx(0.2785, abs=5e-5)
    assert all(one.rate == 0.0 for one in rates.values() if one.stable)


def test_windows_of_the_square_lattice():
    held = {name: windows(h for h in SMOOTHINGS if is_stable(of(name, h))) for name in KERNELS}
    assert held["hyperbolic"] == "1.25–1.35" and held["cubic"] == "1.2"
    assert held["gaussian"] == held["wendland-c6"] == ""


@pytest.mark.parametrize("name", KERNELS)
def test_nothing_holds_under_tension(name):
    assert not any(is_stable(of(name, h, pressure=-1.0)) for h in SMOOTHINGS)


@pytest.mark.parametrize(("name", "most"), [("cubic", 0.0), ("bcc", 0.12), ("fcc", 0.075)])
def test_wendland_is_nearly_stable_in_3d(name, most):
    pressed, drawn = (growth(of("wendland-c2", 1.4, name, p)).rate for p in (1.0, -1.0))
    assert 0.9 * most <= pressed <= most and drawn > 0.9


@pytest.mark.parametrize("smoothing", (1.25, 1.3))
def test_hyperbolic_holds_the_hexagonal_lattice(smoothing):
    assert is_stable(of("hyperbolic", smoothing, "hexagonal"))
    assert not is_stable(of("hyperbolic", 1.35, "hexagonal"))


def test_a_row_follows_the_sign_of_the_curvature():
    """In 1D W″ ≥ 0 is enough under compression: the hyperbolic kernel always holds."""
    for h in SMOOTHINGS:
        assert is_stable(of("hyperbolic", h, "row"))
        assert not is_stable(of("hyperbolic", h, "row", -1.0))
    assert is_stable(of("cubic", 1.5, "row", -1.0))  # the nearest stand where W″ < 0


@pytest.mark.parametrize("form", ("minimum", "difference"))
def test_other_forms_are_neutral(form):
    for pressure in (-1.0, 1.0):
        assert growth(of("cubic", 1.3, pressure=pressure, form=form)).stable
    assert not growth(of("cubic", 1.3)).stable


@pytest.mark.parametrize("name", LATTICES)
@pytest.mark.parametrize(
    ("kernel", "smoothing", "pressure"),
    [("cubic", 1.2, -1.0), ("quintic", 1.7, -1.0), ("wendland-c4", 1.35, 1.0)],
)
def test_no_wave_grows_faster_than_the_one_that_is_found(name, kernel, smoothing, pressure):
    """Against a finer grid of the whole zone, and that wave does grow so."""
    settings = of(kernel, smoothing, name, pressure)
    found, made = growth(settings), lattice(name, 1.0)
    pairs = couplings(Uniform(settings)).halved
    count = {1: 2000, 2: 90, 3: 24}[made.dimensions]
    parts = np.array(list(itertools.product(np.arange(count) / count, repeat=made.dimensions)))
    rates = waves_of(pairs, parts @ made.reciprocal).urge()
    assert rates.max() <= found.rate + 1e-6
    if not found.stable:
        assert rates.max() > 0.97 * found.rate
        assert waves_of(pairs, found.wave_vector[None]).urge()[0] == pytest.approx(found.rate)


def test_is_stable_agrees_with_growth():
    for name, h in itertools.product(("hyperbolic", "quintic", "wendland-c2"), SMOOTHINGS):
        assert is_stable(of(name, h)) == growth(of(name, h)).stable


# Remedies


def test_a_background_pressure_shifts_the_pressure():
    """With −1 + 2 all is as under +1, but for c² − 2P/ρ; and p_b = |P| leaves sound alone."""
    lifted = of("hyperbolic", 1.3, pressure=-1.0, remedies=(parts.LinearBackground(2.0),))
    assert growth(lifted).stable
    assert growth(lifted._replace(smoothing=1.2)).rate == pytest.approx(0.2785, abs=5e-4)
    assert growth(lifted._replace(remedies=(parts.LinearBackground(1.0),))).stable
    assert not growth(lifted._replace(remedies=(parts.LinearBackground(0.5),))).stable


def test_artificial_stress_holds_only_near_1_1():
    """ε = 0.2, n = 4 in case 4.2, where the prototype's runs found the same."""

    def rate(h, *added):
        return growth(TENSION._replace(kernel="hyperbolic", smoothing=h, remedies=added)).rate

    stress = parts.LinearArtificialStress(0.2)
    assert rate(1.1, stress) == 0.0 < 3700.0 < rate(1.1)
    assert all(0.15 * rate(h) < rate(h, stress) < 0.45 * rate(h) for h in (1.0, 1.2, 1.3, 1.4))


def test_normalised_gradients_scale():
    """g and H are divided by M₁: the pressure's part by M₁, in ω², that of sound by M₁²."""
    plain = of("hyperbolic", 1.3, pressure=-1.0, form="symmetric")
    uniform = Uniform(plain)
    assert uniform.first_moment == pytest.approx(0.9740, abs=5e-5)
    normalised = plain._replace(remedies=(parts.NormalisedGradient(),))
    one, other = couplings(uniform), couplings(Uniform(normalised))
    assert other.stiffness == pytest.approx(one.stiffness / uniform.first_moment)
    assert other.pull == pytest.approx(one.pull / uniform.first_moment)
    assert -(other.sites * other.pull).sum() / 2.0 == pytest.approx(1.0)


def test_a_zero_virial_pair_force_of_the_size_of_the_tension_holds():
    """The prototype's ψ = S − κL: its pair virial vanishes, and K ≈ |P| stabilises."""

    def psi_slope(r):
        s, wide, kappa = 0.8, 1.17, 0.77122
        near, far = np.maximum(1 - r / 2 / s, 0.0), np.maximum(1 - r / 2 / wide, 0.0)
        first = -5 / (2 * np.pi * s**2) * 1.5 / s * near**2
        second = 7 / (4 * np.pi * wide**2) * (-5.0 * r / wide**2) * far**3
        return first - kappa * second

    sites = lattice("square", 1.0).within(4.0)
    r = np.linalg.norm(sites, axis=1)
    assert abs((r * psi_slope(r)).sum()) < 1e-4 < abs((r * psi_slope(1.1 * r)).sum())

    def held(strength):
        force = parts.PairForce(lambda r: 2.0 * strength * psi_slope(r))
        return growth(of("hyperbolic", 1.3, pressure=-1.0, remedies=(force,))).rate

    assert held(0.0) > held(0.3) > held(1.0) and held(3.0) == 0.0


@pytest.mark.parametrize(
    "friction", (parts.Viscosity(0.2), parts.LinearArtificialViscosity(0.5)), ids=["ν", "α"]
)
def test_friction_slows_but_never_holds(friction):
    plain = of("cubic", 1.2, pressure=-1.0)
    slowed = plain._replace(remedies=(friction,))
    assert 0.0 < growth(slowed).rate < 0.95 * growth(plain).rate
    assert 0.0 < box_growth(slowed, 5).rate < 0.95 * box_growth(plain, 5).rate
    assert growth(slowed._replace(kernel="hyperbolic", smoothing=1.3, pressure=1.0)).stable


def test_friction_of_a_single_wave():
    """λ² + dλ − γ² = 0, the quadratic that the first-order system stands for."""
    plain = of("cubic", 1.2, "row", -1.0)
    rubbed = plain._replace(remedies=(parts.Viscosity(0.2),))
    wave = np.array([[np.pi]])  # where sin k·R = 0: density plays no part
    [square] = waves_of(couplings(Uniform(plain)).halved, wave).squares.ravel()
    system = waves_of(couplings(Uniform(rubbed)).halved, wave)
    [damping] = system.damping.ravel()
    assert damping > 0.0 > square
    assert system.urge()[0] == pytest.approx(-damping / 2 + np.sqrt(damping**2 / 4 - square))


def test_a_box_with_all_remedies_is_bounded_by_the_lattice():
    every = (
        parts.Viscosity(0.05),
        parts.LinearDiffusion(0.1),
        parts.LinearArtificialStress(0.1),
        parts.NormalisedGradient(),
    )
    settings = of("cubic", 1.2, pressure=-1.0, remedies=every)
    assert 0.3 * growth(settings).rate < box_growth(settings, 6).rate <= growth(settings).rate


@pytest.mark.long
def test_boxes_on_other_lattices():
    for name, cells in (("row", 40), ("hexagonal", 8), ("cubic", 6)):
        settings = of("cubic", 1.2, name, -1.0, sound_speed=2.0)
        box, infinite = box_growth(settings, cells), growth(settings)
        assert 0.7 * infinite.rate < box.rate < infinite.rate
        assert box.wave_vector.shape == infinite.wave_vector.shape


@pytest.mark.parametrize(("cells", "says"), [(0, "at least 1"), (40, "at most 38")])
def test_boxes_that_cannot_be(cells, says):
    with pytest.raises(StabilityError, match=says):
        box_growth(TENSION, cells)


def test_windows_in_words():
    assert windows([1.0, 1.05, 1.1, 1.3, 1.95, 2.0]) == "1–1.1, 1.3, 1.95–2" and windows([]) == ""
