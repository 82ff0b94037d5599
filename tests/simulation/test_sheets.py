"""A sheet in plane stress, pulled: Young's modulus and Poisson's ratio; a bar that creeps."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

PULLED = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.005 }
[solids.bar]
shape.box = { lower = [0.0, 0.0], upper = [0.1, 0.02] }
density = 1000.0
young = 1.0e6
poisson = 0.4
damping = 150.0
loads.left = { shape.box = { lower = [0.0, 0.0], upper = [0.01, 0.02] }, force = [-200.0, 0.0] }
loads.right = { shape.box = { lower = [0.09, 0.0], upper = [0.1, 0.02] }, force = [200.0, 0.0] }
load_rise = 0.02
"""


def strains(folder, end, *keys):
    """Along and across the middle of the bar under 1e4 Pa, by straight lines through its particles."""
    simulation = start(draft(folder, PULLED, *keys))
    while simulation.time < end:
        simulation.step()
    places, gone = simulation.store.shown("reference"), simulation.store.shown("position")
    middle = np.abs(places[:, 0] - 0.05) < 0.02
    return [np.polyfit(places[middle, d], (gone - places)[middle, d], 1)[0] for d in range(2)]


@pytest.mark.parametrize("plane, along", (("stress", 1.0), ("strain", 1.0 - 0.4**2)))
def test_a_sheet_is_pulled_by_youngs_modulus(tmp_path, plane, along):
    """σ/E, and in plane strain σ(1 − ν²)/E; across −ν, and −ν/(1 − ν), of it."""
    x, y = strains(tmp_path, 0.1, f'solids.bar.plane="{plane}"')
    assert x == pytest.approx(0.01 * along, rel=0.02)
    assert -y / x == pytest.approx(0.4 if plane == "stress" else 0.4 / 0.6, rel=0.02)


def test_a_bar_creeps_as_its_branch_relaxes(tmp_path):
    """In shear a spring G∞ beside a Maxwell branch G, τ creeps with τ(G∞ + G)/G∞ from σ/(G∞ + G) to σ/G∞ (the solid of
    Zener); the bulk does not, so that in plane strain the length has a part that is there at once."""
    creeping = "solids.bar.relaxation=[{ shear = 3.5e5, time = 0.05 }]"
    early, late = (strains(tmp_path, t, creeping)[0] for t in (0.045, 0.5))
    lame, shear = 1.0e6 * 0.4 / (1.4 * 0.2), 1.0e6 / 2.8
    bulk = lame + 2.0 * shear / 3.0

    def length(g):
        """Strain along in plane strain under 1e4 Pa with the shear modulus g."""
        first = bulk - 2.0 * g / 3.0
        return 1e4 * (first + 2.0 * g) / (4.0 * g * (first + g))

    assert late == pytest.approx(length(shear), rel=0.02)
    assert length(shear + 3.5e5) < early < 0.8 * late
