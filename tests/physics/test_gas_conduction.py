"""Heat that spreads in a gas: not where it is in balance, whatever pulls at it and whatever its γ."""

from typing import NamedTuple

import numpy as np
import pytest
from drafts import draft
from gauging import start
from physics.test_gas import of

from psph.physics.gas import conduction

ATMOSPHERE = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.05
lower = [0.0, 0.0]
upper = [1.5, 2.0]
periodic = ["x"]
[time]
end = 4.0
[physics]
gravity = [0.0, -1.0]
[walls.floor]
shape.box = { lower = [0.0, -0.2], upper = [1.5, 0.0] }
condition = "mirror"
[walls.lid]
shape.box = { lower = [0.0, 2.0], upper = [1.5, 2.2] }
condition = "mirror"
[ideal_gases.air]
shape.box = { lower = [0.0, 0.0], upper = [1.5, 2.0] }
gamma = 1.4
density = "(1 - 0.4 / 1.4 * y) ** 2.5"
pressure = "(1 - 0.4 / 1.4 * y) ** 3.5"
stretch = "y"
"""
"""p/ρ^γ = 1 everywhere: it is in balance, and as warm as air that is mixed."""


def entropies(simulation):
    """p/ρ^γ of the upper and of the lower quarter."""
    simulation.settle_pressure()
    x, p, rho = of(simulation, "position", "pressure", "density")
    number, y = p / rho**1.4, x[:, 1]
    return number[y > 1.5].mean(), number[y < 0.5].mean()


def changed(folder):
    """By how much both have changed after 4 s, over the start."""
    simulation = start(draft(folder, ATMOSPHERE))
    begun = np.array(entropies(simulation))
    while simulation.time < 4.0:
        simulation.step(4.0)
    return np.array(entropies(simulation)) / begun - 1.0


def test_air_in_balance_with_gravity_keeps_its_entropy(tmp_path, monkeypatch):
    """To 0.3 %.  The control: spread by differences of the pressure, which a weight makes, heat rises."""
    assert np.abs(changed(tmp_path)).max() < 0.005
    monkeypatch.setattr(conduction, "OfMotion", conduction.OfPressure)
    above, below = changed(tmp_path)
    assert above > 0.08 and below < -0.004


SIDES = """
scheme = "gas"
[space]
dimensions = 1
spacing = 0.02
periodic = ["x"]
lower = [-1.0]
upper = [1.0]
[time]
end = 1.0
[ideal_gases.left]
shape.box = { lower = [-1.0], upper = [0.0] }
density = 1.0
pressure = 1.0
gamma = 1.2
[ideal_gases.right]
shape.box = { lower = [0.0], upper = [1.0] }
density = 1.0
pressure = 1.0
gamma = 1.6666666666666667
"""


def test_gases_of_unlike_gamma_rest_beside_each_other(tmp_path, monkeypatch):
    """Of one density and pressure: exactly nothing moves.  The control: their u differs threefold, and spreads."""

    def pressures():
        simulation = start(draft(tmp_path, SIDES))
        while simulation.time < 1.0:
            simulation.step(1.0)
        simulation.settle_pressure()
        return of(simulation, "pressure")[0]

    assert pressures() == pytest.approx(1.0, abs=1e-9)
    monkeypatch.setattr(conduction, "OfUnlikeGamma", conduction.OfOneGamma)
    assert np.abs(pressures() - 1.0).max() > 0.1


def test_gases_of_unlike_gamma_and_densities_are_little_disturbed(tmp_path, monkeypatch):
    """At one pressure, 1.4 beside 1.01 and 4 : 1: p in the middle of each after 0.5 s.  By the plain mean of 1/(γ − 1), the
    control, the gas of small γ sets the pace."""
    text = SIDES.replace("gamma = 1.2", "gamma = 1.4").replace("gamma = 1.6666666666666667", "gamma = 1.01")
    text = text.replace("density = 1.0", "density = 0.25").replace("density = 0.25", "density = 1.0", 1)

    def middles():
        simulation = start(draft(tmp_path, text))
        while simulation.time < 0.5:
            simulation.step(0.5)
        simulation.settle_pressure()
        x, p = of(simulation, "position")[0].ravel(), of(simulation, "pressure")[0]
        return np.array([p[np.abs(x - at) < 0.06].mean() for at in (-0.5, 0.5)])

    found = np.abs(middles() - 1.0).max()
    monkeypatch.setattr(conduction, "OfUnlikeGamma", ByPlainMean)
    assert found < 0.7 * np.abs(middles() - 1.0).max()


class ByPlainMean(NamedTuple):
    """What spreads is p/ρ by the plain mean of u/(p/ρ)."""

    def excess(self, i, j, pair):
        """J/kg."""
        own, other = i.pressure * i.specific_volume, j.pressure * j.specific_volume
        return 0.5 * (own - other) * (i.thermal_energy / own + j.thermal_energy / other)
