"""One material point of soil against what its laws say: elastic, yielding, torn, under water."""

import math

import numpy as np
import pytest
from physics.stress_point import Point

from psph.case.soils import Soil


def soil(**keys):
    """A soil with some keys of its table."""
    told = {"shape": {"box": {"lower": [0.0], "upper": [1.0]}}, "density": 1850.0, "young": 5e6}
    told |= {"poisson": 0.3, "friction_angle": 25.0}
    return Soil.model_validate(told | keys)


def squeezed(dim, rate):
    """The gradient of a flow that presses along the last axis alone."""
    gradient = np.zeros((dim, dim))
    gradient[-1, -1] = -rate
    return gradient


def sheared(dim, rate):
    """That of a simple shear."""
    gradient = np.zeros((dim, dim))
    gradient[0, 1] = rate
    return gradient


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize("poisson", (0.0, 0.2, 0.3, 0.45))
def test_in_an_oedometer_the_stress_across_is_nu_over_one_less_nu(dim, poisson):
    point = Point(soil(poisson=poisson, friction_angle=80.0, cohesion=1e9), dim).strained(
        squeezed(dim, 1e-3), 7
    )
    across, along = point.s[0] - point.p, point.s[-1] - point.p
    assert along < 0.0
    assert across / along == pytest.approx(poisson / (1.0 - poisson), abs=1e-10)
    out_of_plane = -(point.s[0] + point.s[2]) - point.p if dim == 2 else point.s[3] - point.p
    assert out_of_plane == pytest.approx(across, rel=1e-10, abs=1e-10 * abs(along))


@pytest.mark.parametrize("dim", (2, 3))
def test_level_ground_at_rest_is_elastic_in_plane_strain_too(dim):
    """By Mohr and Coulomb (1 − K₀)/(1 + K₀) < sin φ; √J₂ > p sin φ, beyond the cone of plane strain."""
    one, k = soil(friction_angle=30.0), 0.3 / 0.7
    point = Point(one, dim, pressure=(1.0 + 2.0 * k) / 3.0 * 1e4)
    shape = np.eye(dim) / 3.0
    shape[-1, -1] -= 1.0
    point.s = tuple((1.0 - k) * 1e4 * shape[np.triu_indices(dim)])
    assert point.root > 0.5 * point.p * 1.05
    assert point.law.returned(point, point.s, point.rho) == (point.s, point.rho, 0.0)


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize("angle, cohesion", ((0.0, 2e3), (19.8, 0.0), (30.0, 1e3)))
def test_sheared_at_constant_pressure_it_flows_on_its_cone(dim, angle, cohesion):
    one = soil(friction_angle=angle, cohesion=cohesion)
    point = Point(one, dim, pressure=9e3).strained(sheared(dim, 1e-4), 400)
    friction, k, _ = one.pyramid
    assert point.p == pytest.approx(9e3, rel=1e-10)
    assert point.root == pytest.approx(k + friction * 9e3, rel=1e-10)  # k − αI₁ with I₁ = −3p
    unbounded = Point(one, dim, pressure=9e3).strained(sheared(dim, 1e-4), 400, bounded=False)
    assert unbounded.root > 2.0 * point.root
    # What it is sheared by beyond the elastic part is plastic: Δγ/√3.
    elastic = point.root / one.shear_modulus
    assert point.plastic == pytest.approx((0.04 - elastic) / math.sqrt(3.0), rel=2e-2)


@pytest.mark.parametrize("dilatancy", (0.0, 10.0, 25.0))
def test_in_plane_strain_its_strength_is_that_of_mohr_and_coulomb(dilatancy):
    one = soil(dilatancy=dilatancy, cohesion=1e3, young=5e8)
    open_up = 1e-5 * math.sin(math.radians(dilatancy))  # as fast as its slip has it: the pressure stays
    gradient = [[1e-5 + open_up, 0.0], [0.0, -1e-5 + open_up]]
    point = Point(one, 2, pressure=2e4).strained(gradient, 300)
    a, b = point.s[0] - point.p, point.s[2] - point.p
    phi = math.radians(25.0)
    expected = -0.5 * (a + b) * math.sin(phi) + 1e3 * math.cos(phi)
    assert 0.5 * abs(a - b) == pytest.approx(expected, rel=1e-6)


def test_the_potential_of_its_flow_is_the_usual_cone():
    for angle, alpha in ((19.8, 0.1108), (21.9, 0.1215), (30.0, 0.1601)):
        _, _, flow = soil(friction_angle=angle, dilatancy=angle).pyramid
        assert flow / 3.0 == pytest.approx(alpha, abs=5e-5)


@pytest.mark.parametrize("way", (1.0, -1.0))
def test_pressed_and_stretched_along_one_axis_it_has_the_strength_of_mohr_and_coulomb(way):
    """Principal stresses a ≥ b ≥ c of soil in 3D: ½(a − c) = ½(a + c) sin φ + c cos φ, whatever b."""
    one = soil(cohesion=1e3, young=5e8)
    point = Point(one, 3, pressure=2e4).strained(np.diag([0.5, 0.5, -1.0]) * way * 1e-5, 300)
    along, across = point.p - point.s[5], point.p - point.s[0]
    phi = math.radians(25.0)
    expected = 0.5 * (along + across) * math.sin(phi) + 1e3 * math.cos(phi)
    assert 0.5 * abs(along - across) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("dilatancy", (0.0, 10.0))
def test_in_plane_strain_soil_is_as_strong_in_3d_as_in_2d(dilatancy):
    """The cone of the edges of compression was 1.39 times as strong at 30°."""
    one = soil(friction_angle=30.0, dilatancy=dilatancy, cohesion=1e3, young=5e8)
    open_up = 1e-5 * math.sin(math.radians(dilatancy))
    gradient = np.diag([1e-5 + open_up, -1e-5 + open_up, 0.0])
    plane = Point(one, 2, pressure=2e4).strained(gradient[:2, :2], 400)
    whole = Point(one, 3, pressure=2e4).strained(gradient, 400)
    assert (whole.s[0] - whole.s[3]) / whole.p == pytest.approx((plane.s[0] - plane.s[2]) / plane.p, rel=1e-4)


def test_confined_soil_that_dilates_gains_pressure_in_shear_and_other_soil_does_not():
    pressures = [Point(soil(dilatancy=psi), 2, 5e3).strained(sheared(2, 1e-4), 200).p for psi in (0.0, 8.0)]
    assert pressures[0] == pytest.approx(5e3, rel=1e-10)
    assert pressures[1] > 1.5 * pressures[0]


@pytest.mark.parametrize("dim", (2, 3))
def test_pulled_apart_it_bears_no_tension_and_has_to_close_its_crack(dim):
    sand = Point(soil(), dim).strained(-np.eye(dim) * -1e-3, 5)  # expands
    assert sand.p == pytest.approx(0.0, abs=1e-8) and sand.root < 1e-8
    sand.strained(squeezed(dim, 1e-3), 5 * dim - 1)
    assert sand.p == pytest.approx(0.0, abs=1e-8)
    assert sand.strained(squeezed(dim, 1e-3), 2).p > 1e3
    clay = soil(cohesion=3e3)
    torn = Point(clay, dim).strained(np.eye(dim) * 1e-3, 50)
    friction, k, _ = clay.pyramid
    assert torn.p == pytest.approx(-k / friction, rel=1e-10) and torn.root == pytest.approx(0.0, abs=1e-6)
    weak = Point(soil(cohesion=3e3, tension=500.0), dim).strained(np.eye(dim) * 1e-3, 50)
    assert weak.p == pytest.approx(-500.0, rel=1e-10)


def test_water_in_the_pores_bears_no_shear():
    one = soil(water_level=2.0, water_density=1000.0)
    water = 1000.0 * 9.81 * 1.5
    wet = Point(one, 2, water + 5e3, (0.0, 0.5)).strained(sheared(2, 1e-4), 400)
    dry = Point(soil(), 2, 5e3).strained(sheared(2, 1e-4), 400)
    assert wet.root == pytest.approx(dry.root, rel=1e-10)
    assert wet.p == pytest.approx(water + 5e3, rel=1e-10)
    high = Point(one, 2, 5e3, (0.0, 2.5)).strained(sheared(2, 1e-4), 400)
    assert high.root == pytest.approx(dry.root, rel=1e-10)


def test_an_admissible_stress_stays_to_the_last_bit():
    point = Point(soil(cohesion=1e3), 2, 7e3)
    point.s = (100.0, 30.0, -220.0)
    assert point.law.returned(point, point.s, point.rho) == (point.s, point.rho, 0.0)


def test_the_strength_is_reduced_in_all_its_parts():
    half, whole = soil(cohesion=2e3, strength_reduction=2.0), soil(cohesion=2e3)
    angle = math.degrees(math.atan(math.tan(math.radians(25.0)) / 2.0))
    assert half.pyramid == pytest.approx(soil(friction_angle=angle, cohesion=1e3).pyramid, rel=1e-12)
    assert half.pyramid[0] < whole.pyramid[0]
