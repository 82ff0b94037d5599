"""What frames say of the stress of a solid in a uniform stretch, beside its closed form."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI

from psph.output.ledger import Ledger
from psph.physics.solid.laws import moduli
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

YOUNG, POISSON = 2.0e6, 0.3
STRETCHES = 1.3, 0.9, 1.0
"""Along x, along y, and along z, where plane strain has none."""

BLOCK = """
time.end = 1.0
[space]
dimensions = {dimensions}
spacing = 0.1
[solids.block]
shape.box = {{ lower = {lower}, upper = {upper} }}
density = 1000.0
young = {young}
poisson = {poisson}
law = "{law}"
"""


def closed_form(law):
    """The principal Cauchy stresses along x, y and z, Pa: Bonet & Wood (2008), and Smith and others (2018)."""
    lame, shear = moduli(YOUNG, POISSON)
    stretch = np.array(STRETCHES)
    volume = stretch.prod()
    if law == "saint-venant-kirchhoff":
        strain = 0.5 * (stretch**2 - 1.0)
        return stretch**2 * (lame * strain.sum() + 2.0 * shear * strain) / volume
    return (shear * stretch**2 + ((lame + shear) * (volume - 1.0) - shear) * volume) / volume


@pytest.mark.parametrize("law", ("saint-venant-kirchhoff", "neo-hookean"))
@pytest.mark.parametrize("d", (2, 3))
def test_frames_have_the_whole_stress_of_a_stretch_and_its_pressure(tmp_path, d, law):
    numbers = {"young": YOUNG, "poisson": POISSON, "law": law}
    text = BLOCK.format(dimensions=d, lower=[0.0] * d, upper=[0.5] * d, **numbers)
    scene = Scene(draft(tmp_path, text))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    simulation = Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())
    for axis, stretch in enumerate(STRETCHES[:d]):
        store["position"][axis][store.inner] *= stretch
    simulation.settle_pressure()
    expected, close = closed_form(law), {"rel": 1e-9, "abs": 1e-6}
    diagonal = [0, 2] if d == 2 else [0, 3, 5]
    assert store.shown("stress")[:, diagonal] == pytest.approx(
        np.tile(expected[:d], (store.owned, 1)), **close
    )
    if d == 2:
        assert store.shown("stress_zz") == pytest.approx(np.full(store.owned, expected[2]), **close)
    assert ("stress_zz" in {field.name for field in plan.saved}) == (d == 2)
    pressure = simulation.engine.shown_pressure()
    assert pressure == pytest.approx(np.full(store.owned, -expected.mean()), **close)
    assert not store.shown("pressure").any()  # what it shows others is not touched
