"""Two discs of gas that spin, in balance with their own pull, and meet on a parabola."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from gauging import start
from simulation.test_collapse import energies

from psph.case import load

DISCS = Path(CASES) / "gas/colliding_discs.toml"
COARSE = "space.spacing=0.09"
STILL = ("ideal_gases.left.velocity=[0.39,-0.219,0.0]", "ideal_gases.right.velocity=[-0.39,0.219,0.0]")
"""Without their spin."""


def middle(time: float) -> np.ndarray:
    """Of the right disc on the parabola of two masses of 1 kg that are 5 m apart at first and 1.2 m at the
    least, m: Barker's equation."""
    q, both = 1.2, 2.0
    unit = np.sqrt(2.0 * q**3 / both)
    first = np.sqrt(5.0 / q - 1.0)
    roots = np.roots([1.0 / 3.0, 0.0, 1.0, first + first**3 / 3.0 - time / unit])
    root = -roots[np.abs(roots.imag).argmin()].real  # of those to come: half of the angle's tangent
    angle = 2.0 * (np.arctan(first) - np.arctan(root))
    return 0.5 * q * (1.0 + root**2) * np.array([np.cos(angle), np.sin(angle)])


def radius(simulation) -> float:
    """Mean distance from the axis of the right disc, m."""
    x = simulation.store.shown("position")[simulation.store.shown("group") == 1]
    return float(np.linalg.norm((x - x.mean(axis=0))[:, :2], axis=1).mean())


def spin(simulation) -> float:
    """Angular momentum about z of all, kg m²/s."""
    x, v = (simulation.store.shown(name) for name in ("position", "velocity"))
    return float(simulation.store.constants["mass"] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]).sum())


def test_discs_turn_in_balance_and_keep_to_their_parabola():
    """For a quarter of a turn; energy and spin stay; without spin they fall together."""
    turning, still = start(load(DISCS, (COARSE,))), start(load(DISCS, (COARSE, *STILL)))
    wide, energy, first = radius(turning), sum(energies(turning)), spin(turning)
    assert wide == pytest.approx(0.58, abs=0.02)
    for simulation in (turning, still):
        while simulation.time < 1.3:
            simulation.step(1.3)
    store = turning.store
    there = store.shown("position")[store.shown("group") == 1].mean(axis=0)
    assert np.abs(there[:2] - middle(1.3)).max() < 0.01 and abs(there[2]) < 0.005
    assert radius(turning) == pytest.approx(wide, rel=0.1)  # 4 particles thick; with 8: 1.4 %
    assert radius(still) < 0.8 * wide
    assert sum(energies(turning)) == pytest.approx(energy, rel=1e-3)
    assert spin(turning) == pytest.approx(first, rel=2e-4)
