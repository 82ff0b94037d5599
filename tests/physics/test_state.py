"""Equations of state: pressure, its inverse and the energy that belongs to it."""

import numpy as np
import pytest

from psph.physics.fluid.state import Linear, Tait


@pytest.mark.parametrize("state", [Linear(), Tait()])
def test_the_energy_is_that_of_the_pressure(state):
    """du/dρ = p/ρ², and u = 0 at rest."""
    density = np.linspace(900.0, 1100.0, 2001)
    energy = state.energy(density, 1000.0, 30.0)
    slope = np.gradient(energy, density)[1:-1]
    wanted = (state.pressure(density, 1000.0, 30.0) / density**2)[1:-1]
    assert np.abs(slope - wanted).max() < 1e-5 * np.abs(wanted).max()
    assert energy[1000] == pytest.approx(0.0, abs=1e-12) and (np.delete(energy, 1000) > 0.0).all()
