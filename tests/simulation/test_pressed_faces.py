"""Pressures on the faces of solids: none in all on a closed surface, Lamé's ring, faces that turn, work."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import start
from simulation.test_clamps import energy

BLOCK = """
time.end = 1.0
space = {{ dimensions = {d}, spacing = 0.01 }}
[solids.block]
shape.box = {{ lower = {low}, upper = {up} }}
density = 1000.0
young = 1.0e6
poisson = 0.3
jitter = 0.1
loads.all = {{ shape.box = {{ lower = {out}, upper = {far} }}, pressure = 2.0e4 }}
"""


def block(folder, d, *keys):
    corners = {"low": [0.0] * d, "up": [0.1, 0.08, 0.06][:d], "out": [-1.0] * d, "far": [1.0] * d}
    return start(draft(folder, BLOCK.format(d=d, **corners), *keys))


@pytest.mark.parametrize("d, jitter", ((2, 0.0), (2, 0.1), (3, 0.1)))
def test_pressed_on_all_sides_a_block_stays_and_shrinks(tmp_path, d, jitter):
    """Strain −p/(3K), in plane strain −p/(2(λ + μ)).  Momentum: none in order, with jitter a thousandth of the impulse
    on a face, since each particle has an F of its own."""
    keys = [f"solids.block.jitter={jitter}", "solids.block.damping=400.0", "solids.block.load_rise=0.01"]
    simulation = block(tmp_path, d, *keys)
    while simulation.time < 0.04:
        simulation.step()
    store = simulation.store
    momentum = (store.shown("velocity") * store.shown("mass")[:, None]).sum(axis=0)
    least = 2.0e4 * 0.06 ** (d - 1) * 0.04
    assert np.abs(momentum).max() < (1e-12 if not jitter else 1e-3 * least)
    if jitter:
        return
    lame, shear = 1.0e6 * 0.3 / (1.3 * 0.4), 1.0e6 / 2.6
    expected = 2.0e4 / (3.0 * lame + 2.0 * shear if d == 3 else 2.0 * (lame + shear))
    x, gone = store.shown("reference"), store.shown("position")
    for axis in range(d):
        assert np.polyfit(x[:, axis], (gone - x)[:, axis], 1)[0] == pytest.approx(-expected, rel=0.05)


def test_a_pressed_face_turns_with_its_block(tmp_path):
    """A block that is turned by a quarter is pushed along its own axis.  Control: a force stays as it is."""
    face = "shape.box={lower=[-1.0,-1.0],upper=[0.01,1.0]}"
    pushed = {}
    for name, load in (("pressure", "pressure=2e4,facing=[-1.0,0.0]"), ("force", "force=[1600.0,0.0]")):
        simulation = block(tmp_path, 2, "solids.block.loads=off", f"solids.block.loads.end={{{face},{load}}}")
        store = simulation.store
        x, y = store.shown("reference").T
        for of, value in zip(store["position"], (0.3 - y, 0.3 + x)):
            of[store.inner] = value
        simulation.engine.of("solids").strain(0.0)
        pushed[name] = (store.shown("drawn") * store.shown("mass")[:, None]).sum(axis=0)
    assert pushed["pressure"] == pytest.approx([0.0, 1600.0], abs=1e-6)
    assert pushed["force"] == pytest.approx([1600.0, 0.0], abs=1e-6)


RING = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.0025 }
[solids.ring]
shape.difference = { from.disc = { center = [0.0, 0.0], radius = 0.1 }, minus = [{ disc = { center = [0.0, 0.0], radius = 0.05 } }] }
density = 1000.0
young = 1.0e6
poisson = 0.3
damping = 400.0
loads.inside = { shape.disc = { center = [0.0, 0.0], radius = 0.06 }, pressure = 2.0e4 }
load_rise = 0.03
"""


def test_a_ring_under_pressure_widens_as_lame_has_it(tmp_path):
    """In plane strain u(r) = (1 + ν) p a²/(E (b² − a²)) ((1 − 2ν) r + b²/r); the work of the pressure is half of p
    times the area that the hole has grown by, once it is at rest."""
    ring = start(draft(tmp_path, RING))
    while ring.time < 0.12:
        ring.step()
    x, gone = ring.store.shown("reference"), ring.store.shown("position")
    r = np.hypot(*x.T)
    moved = ((gone - x) * x).sum(axis=1) / r
    share = 1.3 * 2.0e4 * 0.05**2 / (1.0e6 * (0.1**2 - 0.05**2))
    expected = share * (0.4 * r + 0.01 / r)
    middle = (r > 0.06) & (r < 0.09)
    assert (moved / expected)[middle].mean() == pytest.approx(1.0, abs=0.04)
    assert (moved / expected)[middle].std() < 0.02
    whole, work = energy(ring)
    assert work > 0.0 and whole < work  # friction has taken what was not stored


def test_the_work_of_a_pressure_is_what_a_solid_gains(tmp_path):
    simulation = block(tmp_path, 2, "solids.block.load_rise=0.02")
    for _ in range(300):
        simulation.step()
    whole, work = energy(simulation)
    assert work > 0.1 and whole == pytest.approx(work, rel=2e-3)


@pytest.mark.parametrize(
    ("load", "says"),
    (
        ("pressure=1.0,force=[1.0,0.0]", "is a force or a pressure; give one of the two"),
        (
            "force=[1.0,0.0],facing=[1.0,0.0]",
            "facing is of a pressure, and there is none; give another, or remove it",
        ),
        ("pressure=1.0,facing=[0.0,0.0]", "facing has no direction; give another, or remove it"),
    ),
)
def test_what_is_refused(tmp_path, load, says):
    text = BLOCK.format(d=2, low=[0.0] * 2, up=[0.1, 0.1], out=[-1.0] * 2, far=[1.0] * 2)
    shape = "shape={box={lower=[0.0,0.0],upper=[0.1,0.1]}}"
    assert any(says in line for line in refusal(tmp_path, text, f"solids.block.loads.all={{{shape},{load}}}"))
