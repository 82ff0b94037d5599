"""Flows of ideal gases that are not shocks: layers that roll up, and a square that should not move."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from drafts import draft
from gauging import start
from physics.test_gas import of

from psph.case import load

LAYERS = Path(CASES) / "gas/kelvin_helmholtz.toml"
EVERYWHERE = "physics.shock_viscosity={ alpha = 1.0, beta = 2.0, least = 1.0 }"


def mode(simulation):
    """Size of v_y with two waves along x at both faces, m/s: eq. (10) to (13) of McNally and others (2012)."""
    x, v, mass, rho = of(simulation, "position", "velocity", "mass", "density")
    near = mass / rho * np.exp(-4.0 * np.pi * np.abs(np.abs(x[:, 1]) - 0.25))
    sine, cosine = (near * v[:, 1] @ wave(4.0 * np.pi * x[:, 0]) for wave in (np.sin, np.cos))
    return 2.0 * np.hypot(sine, cosine) / near.sum()


def growth(spacing, *sets):
    """By what factor the mode grows from 0.75 to 1.5 s."""
    simulation = start(load(LAYERS, (f"space.spacing={spacing}", *sets)))
    found = []
    for time in (0.75, 1.5):
        while simulation.time < time:
            simulation.step(time)
        found.append(mode(simulation))
    return found[1] / found[0]


def test_layers_of_gas_roll_up_and_do_not_with_the_same_viscosity_everywhere():
    assert growth(1 / 32) > 5.0 and growth(1 / 32, EVERYWHERE) < 1.5


@pytest.mark.long
def test_layers_of_gas_roll_up_as_they_do_with_twice_the_resolution():
    assert growth(1 / 64) == pytest.approx(growth(1 / 32), rel=0.1)


SQUARE = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.03125
kernel = "wendland-c4"
smoothing = 2.2
periodic = ["x", "y"]
lower = [-0.5, -0.5]
upper = [0.5, 0.5]
[time]
end = 1.0
[ideal_gases.gas]
shape.box = { lower = [-0.5, -0.5], upper = [0.5, 0.5] }
density = "4 if max(abs(x), abs(y)) < 0.25 else 1"
pressure = 2.5
"""


def corners(tmp_path, *sets):
    """Of a dense square at rest after 1 s: how far its corners are from the middle, over the start, and the
    largest speed over that of sound."""
    simulation = start(draft(tmp_path, SQUARE, *sets))
    number, x = of(simulation, "id", "position")
    corner = number[(np.abs(x).max(axis=1) < 0.25) & (np.abs(x).min(axis=1) > 0.2)]
    begun = np.linalg.norm(x[np.isin(number, corner)], axis=1).mean()
    while simulation.time < 1.0:
        simulation.step(1.0)
    number, x, v, c = of(simulation, "id", "position", "velocity", "sound")
    far = np.linalg.norm(x[np.isin(number, corner)], axis=1).mean()
    return far / begun, np.linalg.norm(v, axis=1).max() / c.min()


def test_a_dense_square_keeps_its_corners_as_it_does_not_without_conduction(tmp_path):
    """At rest: exactly nothing moves.  Density smoothed over a contact acts as a surface tension."""
    kept, speed = corners(tmp_path)
    assert abs(kept - 1.0) < 0.05 and speed < 0.07
    kept, speed = corners(tmp_path, "physics.heat_conduction=0.65")  # 0.4 to 0.75: 0.047 to 0.049
    assert abs(kept - 1.0) < 0.05 and speed < 0.05
    rounded, _ = corners(tmp_path, "physics.heat_conduction=off")
    assert rounded < 0.9
