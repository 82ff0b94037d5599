"""Bodies that are joined meet others as the whole that they are: joints and contacts are solved as one."""

import numpy as np
import pytest
from drafts import draft
from dry import FLAT, Dry, parts

from psph.simulation.touching import Contacts

THROWN = (
    FLAT.replace("-9.81", "0.0")
    + """
[walls.wall]
shape.box = {{ lower = [1.0, -1.0], upper = [1.3, 1.0] }}
[bodies.front]
shape.box = {{ lower = [0.4, 0.0], upper = [0.8, 0.4] }}
density = 1000.0
velocity = [1.0, 0.0]
[bodies.rear]
shape.box = {{ lower = [0.0, 0.0], upper = [0.4, 0.4] }}
density = 3000.0
velocity = [1.0, 0.0]
[joints.weld]
of = ["rear", "front"]
fixed = {{}}
"""
)


@pytest.fixture(name="one_after_the_other")
def one_after_the_other_fixture(monkeypatch):
    """Contacts that know nothing of joints, as a control."""
    meet, rest = Contacts.meet, Contacts.rest
    monkeypatch.setattr(Contacts, "meet", lambda *args: meet(*args[:5]))
    monkeypatch.setattr(Contacts, "rest", lambda *args: rest(*args[:3]))


@pytest.mark.parametrize("restitution", (0.0, 0.5, 1.0))
def test_what_is_welded_bounces_as_one(tmp_path, restitution):
    """With e times its speed, whichever part meets the wall."""
    text = THROWN.format(dx=0.05, friction=0.0, restitution=restitution)
    bodies = Dry(draft(tmp_path, text)).to(0.4)
    assert bodies.velocity[:, 0] == pytest.approx(-restitution, abs=1e-9)
    assert np.abs(bodies.spin).max() < 1e-9


def test_what_is_welded_does_not_bounce_if_one_is_solved_after_the_other(tmp_path, one_after_the_other):
    bodies = Dry(draft(tmp_path, THROWN.format(dx=0.05, friction=0.0, restitution=1.0))).to(0.4)
    assert np.abs(bodies.velocity[:, 0]).max() < 0.1


ARM = (
    FLAT.replace("-9.81", "0.0")
    + """
[walls.stop]
shape.box = {{ lower = [0.6, -0.9], upper = [0.9, -0.5] }}
[bodies.arm]
shape.box = {{ lower = [0.0, -0.1], upper = [1.0, 0.1] }}
density = 1000.0
velocity = [0.0, -1.0]
spin = -2.0
[joints.pin]
of = ["arm"]
hinge = {{ at = [0.0, 0.0] }}
"""
)


@pytest.mark.parametrize("restitution", (0.3, 1.0))
def test_an_arm_on_a_hinge_bounces_off_what_it_meets(tmp_path, restitution):
    """The speed of its turn is e times that before, and its pin does not gape."""
    dry = Dry(draft(tmp_path, ARM.format(dx=0.05, friction=0.0, restitution=restitution)))
    dry.to(0.1)
    before = dry.bodies.spin[0, 2]
    assert dry.to(0.4).spin[0, 2] == pytest.approx(-restitution * before, rel=1e-3)
    assert dry.floating.joints.widest()[0] < 1e-12


def links(count, up, length=0.3):
    """Boxes in a row, hinged to each other."""
    text = ""
    for k in range(count):
        begin, end = k * length, (k + 1) * length
        text += f"""
[bodies.link{k}]
shape.box = {{ lower = [{begin}, {up}], upper = [{end}, {up + 0.15}] }}
density = 2000.0
"""
        if k:
            text += f"""
[joints.pin{k}]
of = ["link{k}", "link{k - 1}"]
hinge = {{ at = [{begin}, {up + 0.075}] }}
"""
    return FLAT.format(dx=0.05, friction=0.5, restitution=0.0) + parts(-4.0, 6.0) + text


HUNG = """
[joints.end]
of = ["link0"]
hinge = { at = [0.0, 0.875] }
"""


def swung(folder, steps):
    """A chain of six that hangs by one end and falls onto the floor: how deep bodies got into it and how wide joints
    gaped in ``steps`` of 2 ms, m, and its energies, J."""
    dry, deep, wide, energy = Dry(draft(folder, links(6, 0.8) + HUNG)), 0.0, 0.0, []
    for _ in range(steps):
        dry.step()
        deep = max(deep, dry.floating.contacts.deepest(dry.bodies).depth)
        wide = max(wide, dry.floating.joints.widest()[0])
        energy.append(dry.bodies.kinetic_energy().sum() - (dry.bodies.weight * dry.bodies.centre).sum())
    return deep, wide, np.array(energy)


def test_a_chain_swings_onto_the_floor(tmp_path):
    """It gets into that by 4e-6 m, its joints gape by 1e-12 m, and it wins no energy but by the steps."""
    deep, wide, energy = swung(tmp_path, 400)
    assert deep < 1e-5 and wide < 1e-12
    assert np.diff(energy).max() < 2e-4 * energy[0] and energy[-1] < 0.4 * energy[0]


def test_a_chain_gets_into_the_floor_if_one_is_solved_after_the_other(tmp_path, one_after_the_other):
    assert swung(tmp_path, 400)[0] > 1e-3


def test_a_chain_lies_on_the_floor(tmp_path):
    """At rest, the floor bears its weight."""
    dry = Dry(draft(tmp_path, links(6, 0.0)))
    bodies = dry.to(0.2)
    assert np.abs(bodies.place - bodies.reference).max() < 1e-9 and np.abs(bodies.velocity).max() < 1e-9
    assert bodies.pressing[:, 1].sum() == pytest.approx(-bodies.weight[:, 1].sum(), rel=1e-9)


def bar(name, begin, end, wide=0.08):
    """A bar between two points whose ends stop short of these."""
    a, b = np.array(begin), np.array(end)
    along = (b - a) / np.hypot(*(b - a))
    across = wide * np.array([-along[1], along[0]])
    a, b = a + 0.12 * along, b - 0.12 * along
    points = [[round(float(x), 12) for x in p] for p in (a - across, b - across, b + across, a + across)]
    return f"[bodies.{name}]\nshape.polygon.points = {points}\ndensity = 2000.0\n"


def toggle(folder):
    """Two bars in a flat roof that hold a block against a wall; and the push that statics asks for, N."""
    rise, half = 0.2, 0.8
    foot, knee, head = (0.0, 0.3), (half, 0.3 + rise), (2.0 * half, 0.3)
    text = FLAT.format(dx=0.05, friction=0.0, restitution=0.0) + parts(-1.0, 4.0)
    text += "[walls.stop.shape.box]\nlower = [2.1, 0.0]\nupper = [2.4, 1.0]\n"
    text += bar("left", foot, knee) + bar("right", knee, head)
    text += "[bodies.block]\nshape.box = { lower = [1.7, 0.0], upper = [2.1, 0.6] }\ndensity = 2000.0\n"
    for n, (of, at) in enumerate(((["left"], foot), (["right", "left"], knee), (["right", "block"], head))):
        text += f"[joints.hinge{n}]\nof = {of}\nhinge = {{ at = {list(at)} }}\n".replace("'", '"')
    dry = Dry(draft(folder, text))
    left = [one.name for one in dry.bodies.bodies].index("left")
    return dry, -dry.bodies.weight[left, 1] * half / (2.0 * rise)


def test_a_toggle_presses_a_block_against_a_wall(tmp_path):
    """By w/(2 tan α), with the weight w of a bar, and all stays where it is."""
    dry, push = toggle(tmp_path)
    bodies = dry.to(0.2)
    assert bodies.pressing[:, 0].sum() == pytest.approx(-push, rel=1e-9)
    assert np.abs(bodies.place - bodies.reference).max() < 1e-12


def test_a_toggle_gives_way_if_one_is_solved_after_the_other(tmp_path, one_after_the_other):
    dry, _ = toggle(tmp_path)
    assert dry.floating.contacts.deepest(dry.to(0.2)).depth > 1e-4


GATE = """
time.end = 1.0
physics.gravity = [2.0, 0.0, -9.81]
physics.sound_speed = 20.0
space = {{ dimensions = 3, spacing = 0.1 }}
[fluids.puddle]
shape.box = {{ lower = [3.0, 0.0, 0.0], upper = [3.3, 0.3, 0.3] }}
[walls.channel]
shape.difference.from.box = {{ lower = [-1.0, -0.3, -0.3], upper = [4.0, 0.8, 1.2] }}
shape.difference.minus = [{{ box = {{ lower = [-1.0, 0.0, 0.0], upper = [4.0, 0.5, 1.2] }} }}]
[bodies.gate]
shape.box = {{ lower = [1.4, {low}, 0.3], upper = [1.7, {high}, 0.9] }}
density = 500.0
[joints.top]
of = ["gate"]
hinge = {{ at = [1.5, 0.25, 0.9], axis = [0.0, 1.0, 0.0] }}
"""
"""A gate that hangs in a channel."""


def test_a_gate_between_walls_that_its_hinge_keeps_it_from_swings_as_if_they_were_not_there(tmp_path):
    """Contacts that took the gate as it stood before the step asked the hinge for 1e15 N s."""
    spins, borne = [], []
    for low, high in ((0.0, 0.5), (0.1, 0.4)):
        dry = Dry(draft(tmp_path, GATE.format(low=low, high=high)), dt=2e-3)
        most = 0.0
        while dry.time < 0.2:
            dry.to(dry.time + 0.02)
            most = max(most, float(np.abs(dry.bodies.bearing).max()))
        spins.append(dry.bodies.spin[0])
        borne.append(most / dry.bodies.mass[0, 0])
    assert spins[0] == pytest.approx(spins[1], abs=1e-9) and abs(spins[0][1]) > 0.1
    assert borne[0] == pytest.approx(borne[1], rel=1e-6)
