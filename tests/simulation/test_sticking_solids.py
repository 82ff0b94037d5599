"""Fluids stick to elastic solids where the case says so: `solids.NAME.no_slip`."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import readings, start, started
from long import LONG

COUETTE = """
[space]
dimensions = 2
spacing = 0.1
periodic = ["x"]
lower = [0.0, -0.6]
upper = [1.2, 1.4]
[time]
end = 4.0
[physics]
sound_speed = 10.0
[fluids.oil]
viscosity = 0.5
shape.box = { lower = [0.0, 0.0], upper = [1.2, 1.0] }
[walls.lid]
shape.box = { lower = [0.0, 1.0], upper = [1.2, 1.4] }
velocity = [0.5, 0.0]
no_slip = true
[solids.slab]
shape.box = { lower = [0.0, -0.6], upper = [1.2, 0.0] }
density = 2000.0
young = 1.0e7
poisson = 0.3
no_slip = true
clamped.box = { lower = [0.0, -0.6], upper = [1.2, -0.4] }
[gauges.held]
reaction.of = ["solids.slab.clamped"]
"""
"""A lid drags oil, of 500 Pa s, over a slab that is held from below."""

RING = """
[space]
dimensions = 2
spacing = 0.05
[time]
end = 2.0
[physics]
sound_speed = 20.0
[fluids.oil]
density = 900.0
viscosity = 0.05
shape.difference.from.disc = { center = [0.0, 0.0], radius = 0.9 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 0.5 } }]
velocity_gradient = [[0.0, -1.0], [1.0, 0.0]]
[solids.disc]
shape.disc = { center = [0.0, 0.0], radius = 0.5 }
density = 1500.0
young = 1.0e7
poisson = 0.3
velocity_gradient = [[0.0, -1.0], [1.0, 0.0]]
no_slip = true
"""
"""A disc that turns within a ring of oil that turns as fast."""

STILL = "fluids.oil.velocity_gradient=[[0.0, 0.0], [0.0, 0.0]]"


def sheared(folder, *overrides):
    """Slope of the velocity over U/H, its value at the face over U, and what the clamp bears along it, N."""
    simulation, scene = started(draft(folder, COUETTE, *overrides))
    while simulation.time < 2.2:
        simulation.step()
    store = simulation.store
    fluid = store.shown("kind") == 0
    height, speed = store.shown("position")[fluid, 1], store.shown("velocity")[fluid, 0]
    return (*np.polyfit(height, speed / 0.5, 1), readings(simulation, scene)["held.reaction_x"])


@pytest.mark.parametrize("finer", (1, pytest.param(2, marks=LONG)))
def test_couette_flow_over_an_elastic_slab(finer, tmp_path):
    """Linear to 1 %, at rest at the face, and the clamp bears μU/H a metre.  Control: over a slab on which
    it slips, the oil goes with the lid."""
    slope, there, force = sheared(tmp_path, f"solids.slab.spacing={0.1 / finer}")
    assert (slope, there) == pytest.approx((1.0, 0.0), abs=0.01)
    assert force == pytest.approx(500.0 * 0.5 * 1.2, rel=0.015)
    if finer == 1:
        slope, there, force = sheared(tmp_path, "solids.slab.no_slip=false")
        assert there > 0.8 and abs(force) < 15.0


def braking(folder, *overrides):
    """The moment on the disc over the first steps, N m."""
    simulation = start(draft(folder, RING, *overrides))
    store = simulation.store

    def turning():
        solid = store.shown("group") == 1
        mass, (x, y), (u, v) = (store.shown(name)[solid].T for name in ("inertia", "position", "velocity"))
        return (mass * (x * v - y * u)).sum()

    before = turning()
    for _ in range(30):
        simulation.step()
    return (turning() - before) / simulation.time


def test_oil_that_turns_with_a_disc_leaves_it_alone(tmp_path):
    """To half a percent of what it brakes the disc where it rests; there the friction is most of it."""
    braked = braking(tmp_path, STILL)
    assert abs(braking(tmp_path)) < 0.005 * abs(braked)
    assert abs(braking(tmp_path, STILL, "solids.disc.no_slip=false")) < 0.2 * abs(braked)


def test_where_nothing_sticks(tmp_path):
    """Without friction, and beside a solid whose neighbours are those of the present."""
    thin = COUETTE.replace("viscosity = 0.5\n", "")
    for text, more in ((thin, ()), (COUETTE, ('solids.slab.description="updated"',))):
        lines = refusal(tmp_path, text, *more)
        assert any("solids.slab.no_slip" in line for line in lines)
