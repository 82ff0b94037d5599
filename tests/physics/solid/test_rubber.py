"""Laws of rubber with numbers of their own, and sheets in plane stress, against closed forms."""

import numpy as np
import pytest
from physics.solid.test_laws import BULK, LAME, RUBBERS, SHEAR, axis, laws, rows, turned

from psph.engine.jit import compiled
from psph.physics.solid.laws import NeoHookean, SaintVenantKirchhoff
from psph.physics.solid.plane import PlaneStress
from psph.physics.solid.powers import power
from psph.physics.solid.rubber import MooneyRivlin, Ogden


def deformed(d, seed=7):
    return np.eye(d) + 0.2 * np.random.default_rng(seed).standard_normal((d, d))


@pytest.mark.parametrize("law", RUBBERS, ids=lambda law: type(law).__name__)
def test_moduli_at_rest(law):
    assert law.moduli() == pytest.approx((LAME, SHEAR), rel=1e-9)


@pytest.mark.parametrize("d", (2, 3))
def test_ogden_with_the_powers_2_and_minus_2_is_mooney_and_rivlin(d):
    one, two = MooneyRivlin(3e5, 1e5, 5e6), Ogden((6e5, -2e5), (2.0, -2.0), 5e6)
    f = rows(deformed(d))
    assert one.stress(f, axis(d)) == pytest.approx(two.stress(f, axis(d)), rel=1e-10)
    assert one.energy(f, axis(d)) == pytest.approx(two.energy(f, axis(d)), rel=1e-10)
    if d == 2:
        assert one.across(f, axis(d)) == pytest.approx(two.across(f, axis(d)), rel=1e-10)


@pytest.mark.parametrize("stretch", (0.5, 1.3, 3.0))
def test_a_bar_of_rubber_that_keeps_its_volume(stretch):
    """Pulled in one direction: P = Σ μ_p (λ^{α−1} − λ^{−α/2−1}) (Ogden 1972)."""
    law = Ogden((6.3e5, 1.2e3, -1e4), (1.3, 5.0, -2.0), 1e12)
    thin = stretch**-0.5
    sheet = PlaneStress(law).stress((stretch, 0.0, 0.0, thin), axis(2))
    expected = sum(
        m * (stretch ** (n - 1.0) - stretch ** (-0.5 * n - 1.0)) for m, n in zip(law.shear, law.exponents)
    )
    assert sheet[0] == pytest.approx(expected, rel=1e-5) and abs(sheet[3]) < 1e-5 * abs(sheet[0])


@pytest.mark.parametrize("d", (2, 3))
@pytest.mark.parametrize("apart", (1.0, 1e-4, 1e-6, 1e-9, 0.0))
@pytest.mark.parametrize("p", (-2.0, 0.65, 4.0))
def test_powers_of_matrices_whose_eigenvalues_are_alike(d, apart, p):
    rng = np.random.default_rng(2)
    q = np.linalg.qr(rng.standard_normal((d, d)))[0]
    values = 1.0 + apart * rng.uniform(-0.8, 2.0, d)
    b, expected = (q @ np.diag(of) @ q.T for of in (values, values**p))
    places = np.triu_indices(d)
    found = np.array(power(tuple(b[places]), p, axis(d)))
    assert found == pytest.approx(expected[places], rel=1e-12, abs=1e-12)


@laws
def test_a_sheet_has_no_stress_across_and_hookes_moduli(law):
    """E and ν of a bar that is pulled; in plane strain it has E/(1 − ν²)."""
    sheet, strain = PlaneStress(law), 1e-6
    young, poisson = SHEAR * (3.0 * LAME + 2.0 * SHEAR) / (LAME + SHEAR), 0.5 * LAME / (LAME + SHEAR)
    f = (1.0 + strain, 0.0, 0.0, 1.0 - poisson * strain)
    p = sheet.stress(f, axis(2))
    assert p[0] == pytest.approx(young * strain, rel=1e-4) and abs(p[3]) < 1e-4 * p[0]
    assert sheet.thinned(f, axis(2)) == pytest.approx(1.0 - poisson * strain, abs=1e-10)
    assert sheet.across(f, axis(2)) == 0.0


@laws
def test_the_stress_of_a_sheet_is_the_derivative_of_its_energy(law):
    sheet, f, step = PlaneStress(law), deformed(2), 1e-6
    stress = np.reshape(sheet.stress(rows(f), axis(2)), (2, 2))
    for k in np.ndindex(2, 2):
        change = np.zeros((2, 2))
        change[k] = step
        ends = [sheet.energy(rows(f + sign * change), axis(2)) for sign in (1.0, -1.0)]
        assert (ends[0] - ends[1]) / (2.0 * step) == pytest.approx(stress[k], rel=1e-6, abs=1e-3)


def test_a_sheet_of_neo_hookean_rubber_has_the_thickness_of_its_closed_form():
    """μλ_z + (k(J − 1) − μ) A = 0 with k = λ + μ, J = Aλ_z: λ_z = A(k + μ)/(μ + kA²)."""
    f, stiff = deformed(2), LAME + SHEAR
    area = np.linalg.det(f)
    found = PlaneStress(NeoHookean(LAME, SHEAR)).thinned(rows(f), axis(2))
    assert found == pytest.approx(area * (stiff + SHEAR) / (SHEAR + stiff * area**2), rel=1e-12)


def test_a_sheet_of_hookes_law_has_the_thickness_of_its_closed_form():
    """λ_z² = 1 − 2λ/(λ + 2μ) tr E of the plane."""
    f = deformed(2)
    strain = 0.5 * np.trace(f.T @ f - np.eye(2))
    found = PlaneStress(SaintVenantKirchhoff(LAME, SHEAR)).thinned(rows(f), axis(2))
    assert found**2 == pytest.approx(1.0 - 2.0 * LAME / (LAME + 2.0 * SHEAR) * strain, rel=1e-12)


@pytest.mark.parametrize("law", [*RUBBERS, *map(PlaneStress, RUBBERS)], ids=str)
def test_compiled_and_plain_python_agree_and_stress_turns_along(law):
    turn, f = turned(1.1, 2), deformed(2)

    @compiled
    def stress(law, f, a):
        return law_stress(law, f, a)

    from psph.physics.solid.plane import law_stress

    before = np.reshape(law.stress(rows(f), axis(2)), (2, 2))
    assert np.reshape(stress(law, rows(f), axis(2)), (2, 2)) == pytest.approx(before, rel=1e-9)
    assert np.reshape(law.stress(rows(turn @ f), axis(2)), (2, 2)) == pytest.approx(turn @ before, rel=1e-9)


def test_inside_out_it_still_has_a_stress():
    for law in RUBBERS:
        assert np.isfinite(law.stress((-0.5, 0.0, 0.0, 1.0), axis(2))).all()
        assert law.energy((-0.5, 0.0, 0.0, 1.0), axis(2)) > BULK
