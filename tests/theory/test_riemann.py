"""The exact solution of the Riemann problem of an ideal gas."""

import numpy as np
import pytest

from psph.theory.riemann import GasState, riemann

SOD = GasState(1.0, 1.0), GasState(0.125, 0.1)
TUBES = {
    "sod": (*SOD, 1.4, 0.303130, 0.927453, 0.426319, 0.265574, 1.752156),
    "sod of one atom": (*SOD, 5 / 3, 0.293945, 0.841195, 0.479689, 0.229806, 1.844473),
    "blast": (GasState(1.0, 1e3), GasState(1.0, 0.01), 1.4, 460.894, 19.5975, 0.575062, 5.99924, 23.5175),
    "1-2-3": (
        *(GasState(1.0, 0.4, -2.0), GasState(1.0, 0.4, 2.0)),
        *(1.4, 0.001894, 0.0, 0.021852, 0.021852, 2.748331),
    ),
}
"""Both states, γ; p and u between the waves, ρ on both sides of the contact, and the speed of the wave on the
right: of a shock, or of the head of a fan.  Toro (2009), table 4.2, with more digits."""


@pytest.mark.parametrize("tube", TUBES)
def test_waves_of_known_tubes(tube):
    left, right, gamma, *known = TUBES[tube]
    found = riemann(left, right, gamma)
    densities = found.middle_density(left), found.middle_density(right)
    speed, _ = found.edges(right, 1.0)
    assert (found.pressure, found.velocity, *densities, speed) == pytest.approx(known, rel=3e-4, abs=1e-12)


def test_mass_momentum_and_energy_flow_through_a_shock():
    """Rankine and Hugoniot: the fluxes seen from the shock are those of both sides."""
    left, right, gamma = *SOD, 1.4
    found = riemann(left, right, gamma)
    shock, _ = found.edges(right, 1.0)

    def fluxes(density, pressure, velocity):
        flow = density * (velocity - shock)
        enthalpy = gamma / (gamma - 1.0) * pressure / density
        return flow, flow * (velocity - shock) + pressure, enthalpy + 0.5 * (velocity - shock) ** 2

    behind = fluxes(found.middle_density(right), found.pressure, found.velocity)
    assert behind == pytest.approx(fluxes(*right), rel=1e-12)


def test_a_fan_keeps_entropy_and_joins_both_its_edges():
    found = riemann(*SOD, 1.4)
    xi = np.linspace(*found.edges(found.left, -1.0), 50)
    density, pressure, velocity = found.at(xi)
    assert pressure / density**1.4 == pytest.approx(np.ones(50), rel=1e-12)
    ends = [found.middle_density(found.left), found.pressure, found.velocity]
    assert (density[-1], pressure[-1], velocity[-1]) == pytest.approx(ends, rel=1e-9)
    assert (density[0], pressure[0], velocity[0]) == pytest.approx(found.left, abs=1e-9)


def test_a_mirrored_tube_has_the_mirrored_solution():
    left, right = SOD
    xi = np.linspace(-2.0, 2.0, 101)
    one, other = riemann(left, right, 1.4).at(xi), riemann(right, left, 1.4).at(-xi)
    assert np.allclose(one[0], other[0]) and np.allclose(one[2], -other[2])


def test_gases_that_leave_a_vacuum_are_refused():
    with pytest.raises(ValueError, match="vacuum"):
        riemann(GasState(1.0, 0.4, -20.0), GasState(1.0, 0.4, 20.0), 1.4)
