"""Open ends whose planes go with a wall, against the same at rest."""

import numpy as np
import pytest
from cases.measures import CASES
from cases.test_open_ends import PIPE
from drafts import draft
from gauging import start
from scipy.spatial import cKDTree

from psph.case import load

DUCT = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 9.0
physics = { sound_speed = 20.0, position_shift = "off" }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
velocity = [SPEED, 0.0]
[walls.duct]
shape.difference.from.box = { lower = [-0.6, -0.4], upper = [1.6, 1.0] }
shape.difference.minus = [{ box = { lower = [-0.6, 0.0], upper = [1.6, 0.6] } }]
motion = [{ translation = { velocity = [PACE, 0.0] } }]
[ends.inlet]
at = 0.0
inward = "+x"
velocity = 1.0
on = "duct"
[ends.outlet]
at = 1.0
inward = "-x"
pressure = 0.0
on = "duct"
"""


def carried(folder, pace, on):
    """Places and speeds beside a duct that goes at a pace, after 1 s of a stream of 1 m/s in it, and the books."""
    text = DUCT.replace("SPEED", str(1.0 + pace)).replace("PACE", str(pace))
    simulation = start(draft(folder, text if on else text.replace('on = "duct"', "")))
    while simulation.time < 1.0:
        simulation.step()
    store, states = simulation.store, simulation.engine.of("ends").states
    fluid, way = store.shown("kind") == 0, np.array([pace, 0.0])
    books = [(one.books.number_in, one.books.number_out) for one in states]
    return store.shown("position")[fluid] - way * simulation.time, store.shown("velocity")[fluid] - way, books


@pytest.mark.parametrize("pace", [0.5, -1.5])
def test_ends_go_with_a_duct_as_if_it_were_still(tmp_path, pace):
    """As many pass, and what is inside is where it would be to 0.2 dx, as fast to 1 %: steps are others.  Without
    `position_shift`, which is bounded by the largest speed in the domain.
    Control: between planes that stay behind it is not."""
    x, v, books = carried(tmp_path, 0.0, True)
    for on in (True, False):
        places, speeds, passed = carried(tmp_path, pace, on)
        apart, rows = cKDTree(x).query(places)
        off = abs(speeds - v[rows]).max()
        assert (passed == books) == on
        assert (apart.max() < 0.02 and off < 0.01) if on else off > 0.4


PISTON = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 9.0
physics.sound_speed = 15.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
[walls.tank]
shape.difference.from.box = { lower = [-0.6, -0.2], upper = [1.2, 0.8] }
shape.difference.minus = [{ box = { lower = [-0.6, 0.0], upper = [1.0, 0.6] } }]
[walls.piston]
shape.difference.from.box = { lower = [-0.2, 0.0], upper = [0.0, 0.6] }
shape.difference.minus = [{ box = { lower = [-0.2, 0.05], upper = [0.0, 0.55] } }]
motion = [{ translation = { velocity = [PACE, 0.0] }, ramp = 0.2 }]
[ends.hole]
at = 0.0
inward = "+x"
span.y = [0.05, 0.55]
pressure = 300.0
on = "piston"
"""


@pytest.mark.parametrize("pace", [0.4, 0.0])
def test_what_a_piston_displaces_leaves_through_its_hole(tmp_path, pace):
    """But for a row, where the hole is nearly as wide; and nothing where it rests."""
    simulation = start(draft(tmp_path, PISTON.replace("PACE", str(pace))))
    while simulation.time < 1.1:
        simulation.step()
    [state] = simulation.engine.of("ends").states
    left = state.books.number_out - state.books.number_in
    assert left == pytest.approx(pace * 1.0 * 0.6 / 0.05**2, abs=10)


@pytest.mark.parametrize("keys, speed", [((), 0.0), (("ends.mouth.on=off",), 1.0)])
def test_water_from_a_nozzle_that_draws_back_falls_straight_down(keys, speed):
    """Its speed along the ground is that of the mouth and that beside it, 0.02 m/s at most in the mean.  Control:
    from a plane that stays it is 1 m/s."""
    simulation = start(load(f"{CASES}/ends/retreating_nozzle.toml", keys))
    while simulation.time < 0.5:
        simulation.step()
    store, [state] = simulation.store, simulation.engine.of("ends").states
    x, y = store.shown("position").T
    falls = (store.shown("kind") == 0) & (y > 0.3) & (x > 1.8 - simulation.time)
    assert store.shown("velocity")[falls, 0].mean() == pytest.approx(speed, abs=0.02 if speed == 0.0 else 0.1)
    assert state.books.number_in == pytest.approx(0.5 * 0.1 / 0.02**2, rel=0.05)


def test_books_are_right_beside_planes_that_go(tmp_path):
    """Energy and momentum that a pressure gives to water between planes on a cart, within 3 %.  Control: less
    than a fifth of the energy is won where the cart rests."""
    given = []
    for pace in (0.0, 1.0):
        text = PIPE.replace("[-0.2, 0.0], upper = [2.2, 0.3]", "[-6.2, 0.0], upper = [6.2, 0.3]")
        text = text.replace('waves = "back"', 'waves = "back"\non = "cart"') + CART.replace("PACE", str(pace))
        simulation = start(draft(tmp_path, text, f"fluids.water.velocity=[{pace}, 0.0]"))

        def moving(store=simulation.store):
            fluid = store.shown("kind") == 0
            mass, v = store.shown("mass")[fluid], store.shown("velocity")[fluid]
            return np.array([0.5 * (mass * (v * v).sum(axis=1)).sum(), (mass * v[:, 0]).sum()])

        before = moving()
        while simulation.time < 0.8:
            simulation.step()
        ends = simulation.engine.of("ends")
        one, two = (state.books for state in ends.states)
        pushed = one.momentum + one.impulse - two.momentum - two.impulse
        given.append(ends.given()[0])
        assert [given[-1], pushed] == pytest.approx(moving() - before, rel=0.03)
    assert given[0] < 0.2 * given[1]


CART = """
[walls.cart]
shape.box = { lower = [3.0, 0.0], upper = [3.2, 0.3] }
motion = [{ translation = { velocity = [PACE, 0.0] } }]
"""
