"""Lines with weight: at rest against the elastic catenary, and in motion against theory."""

import math

import numpy as np
import pytest
from physics.rigid.catenary import catenary
from physics.rigid.test_bodies import body

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.chains import Chain, Hanging, bearing_of
from psph.physics.rigid.lines import Lines, SpringLine, longest_step

STILL = np.zeros((2, 3))
ALONG_Z = (0.0, 0.0, -9.81)


def chain(pieces=20, length=3.0, bed=False, **different):
    """One of 1 kg/m in air; what differs is given."""
    one = Chain(
        pieces, length, 1.0, 1e4, 0.0, 0.0, 0.0, 0.0, 0.0, ALONG_Z, (0.0, 0.0, 1.0), math.inf,
        (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, 0.0,
    )._replace(**different)  # fmt: skip
    each = length / pieces
    return one._replace(bearing=bearing_of(one.mass, one.pull, one.stiffness, each)) if bed else one


def between(one, top, anchor=(0.0, 0.0, 0.0)):
    """It at rest."""
    return Hanging(one, np.array([top, anchor]), STILL)


@pytest.mark.parametrize(
    ("length", "stiffness", "bed", "x", "z"),
    [
        (1.2, 1e3, False, 1.0, 0.5),
        (1.2, 1e8, False, 1.0, 0.5),
        (0.9, 200.0, False, 1.0, 0.3),
        (3.0, 1e3, True, 2.6, 1.0),
        (3.0, 1e8, True, 2.6, 1.0),
    ],
)
def test_a_line_at_rest_is_an_elastic_catenary(length, stiffness, bed, x, z):
    """Tensions and places; they come nearer by four for pieces half as long."""
    exact, apart = catenary(9.81, length, stiffness, x, z, bed), []
    for pieces in (20, 40):
        hung = between(chain(pieces, length, bed, stiffness=stiffness), (0.6 * x, 0.8 * x, z))
        across = -hung.pulls[0, :2] @ [0.6, 0.8]
        shape = [exact.point(length * k / pieces) for k in range(pieces, -1, -1)]
        places = np.stack([hung.place[:, :2] @ [0.6, 0.8], hung.place[:, 2]], axis=1)
        apart.append(
            [across / exact.h - 1.0, -hung.pulls[0, 2] / exact.v - 1.0, np.abs(places - shape).max()]
        )
        assert hung.pulls[:, :2].sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert np.abs(apart[0]).max() < 0.005 and np.abs(apart[1]).max() < 0.0015
    assert np.abs(apart[1][:2]).max() < 0.35 * np.abs(apart[0][:2]).max()


def test_a_line_over_its_anchor_and_one_on_a_slope_or_in_a_loop_come_to_rest():
    loop = between(chain(30, 2.0), (0.0, 0.0, 0.0))
    assert loop.pulls[:, 2] == pytest.approx([-9.81, -9.81]) and loop.place[:, 2].min() < -0.99
    heap = between(chain(30, 2.0, bed=True), (0.0, 0.0, 1.0))
    assert -heap.pulls[0, 2] == pytest.approx(9.81, rel=0.06)  # what hangs
    slope = (-math.sin(0.3), 0.0, math.cos(0.3))
    lying = between(chain(30, 2.2, bed=True, normal=slope), (2.0 * math.cos(0.3), 0.0, 2.0 * math.sin(0.3)))
    assert (lying.place @ slope).min() > -1e-3 and (lying.place @ slope).max() < 0.01
    assert -lying.pulls[0] @ [math.cos(0.3), 0.0, math.sin(0.3)] == pytest.approx(
        2.0 * 9.81 * math.sin(0.3), rel=0.05
    )


def test_water_carries_what_is_below_its_level():
    """Up to half of the line: its weight is that of the rest and of what water leaves."""
    half = chain(40, 1.0, displaced=0.6, level=0.5)
    pulls = between(half, (0.0, 0.0, 1.0)).pulls
    assert -pulls[:, 2].sum() == pytest.approx(9.81 * (1.0 - 0.6 * 0.5), rel=1e-3)


@pytest.mark.parametrize("added", [0.0, 0.5])
def test_a_taut_string_swings_as_it_should(added):
    """f = √(T/(m + a))/2L, with added mass a."""
    one = chain(40, 1.0, pull=(0.0, 0.0, 0.0), displaced=added, added=added)
    tension, ends = 100.0, np.array([[1.01, 0.0, 0.0], [0.0, 0.0, 0.0]])
    hung = Hanging(one, ends, STILL)
    hung.velocity[:, 2] = 0.01 * np.sin(math.pi * hung.place[:, 0] / 1.01)
    period = 2.0 * 1.01 / math.sqrt(tension / ((1.0 + added) / 1.01))
    middle, dt = [], period / 2000
    for _ in range(2400):
        hung.advance(ends, STILL, dt)
        middle.append(hung.place[20, 2])
    falls = [k for k in range(1, len(middle)) if middle[k - 1] > 0.0 >= middle[k]]
    rises = [k for k in range(1, len(middle)) if middle[k - 1] < 0.0 <= middle[k]]
    assert 2.0 * (rises[0] - falls[0]) * dt == pytest.approx(period, rel=2e-3)
    assert max(middle) == pytest.approx(0.01 * period / (2.0 * math.pi), rel=5e-3)


def test_drag_across_and_along_is_that_of_a_rod():
    """Ends that go on at 2 m/s drag the line after them; in the end it pulls with the drag of its pieces."""
    for way, coefficient in (((0.0, 0.0, 1.0), 6.0), ((1.0, 0.0, 0.0), 2.0)):
        one = chain(20, 1.0, pull=(0.0,) * 3, drag=6.0, skin=2.0, damping=0.3)
        going = 2.0 * np.array([way, way])
        hung = Hanging(one, np.array([[1.02, 0.0, 0.0], [0.0, 0.0, 0.0]]), going)
        for k in range(1, 2001):
            hung.advance(np.array([[1.02, 0.0, 0.0], [0.0, 0.0, 0.0]]) + 1e-3 * k * going, going, 1e-3)
        inner = 1.0 - 1.0 / 20
        assert -hung.pulls.sum(axis=0) @ way == pytest.approx(coefficient * 4.0 * inner, rel=0.03)


def test_a_bed_rubs_with_its_friction():
    """A line that is drawn along it by its ends."""
    one = chain(20, 1.0, bed=True, friction=0.4, damping=0.3)
    ends, going = np.array([[1.001, 0.0, 0.0], [0.0, 0.0, 0.0]]), np.array([[0.5, 0.0, 0.0]] * 2)
    hung, pulls = Hanging(one, ends, going), []
    for k in range(1, 2001):
        hung.advance(ends + 1e-3 * k * going, going, 1e-3)
        pulls.append(hung.pulls[:, 0].sum())
    assert -np.mean(pulls[1000:]) == pytest.approx(0.4 * 9.81 * 0.95, rel=0.02)
    assert between(one._replace(friction=0.0), (1.001, 0.0, 0.0)).pulls[:, 0].sum() == pytest.approx(
        0.0, abs=1e-9
    )


def shaken(pieces):
    """Tensions (N) of a chain in water on a bed whose end goes round in 1.2 s, 3 cm from its middle."""
    water = {"displaced": 0.154, "added": 0.154, "drag": 8.4, "skin": 1.1, "damping": 0.1}
    hung = between(chain(pieces, 1.28, bed=True, stiffness=2e4, **water), (1.2, 0.0, 0.3))
    rate, told = 2.0 * math.pi / 1.2, []
    for k in range(1, 3601):
        size, angle = 0.03 * min(k / 1200.0, 1.0), 1e-3 * k * rate
        at = (1.2 + size * math.sin(angle), 0.0, 0.3 + size * (math.cos(angle) - 1.0))
        going = (size * rate * math.cos(angle), 0.0, -size * rate * math.sin(angle))
        hung.advance(np.array([at, (0.0,) * 3]), np.array([going, (0.0,) * 3]), 1e-3)
        told.append(np.linalg.norm(hung.pulls[0]))
    return np.array(told[2400:])


def test_what_motion_adds_hardly_depends_on_the_pieces():
    """Twenty of them, or eighty: means within 0.5 %, peaks, half as much again as the mean, within 5 %."""
    few, many = shaken(20), shaken(80)
    assert few.mean() == pytest.approx(many.mean(), rel=5e-3)
    assert few.max() == pytest.approx(many.max(), rel=0.05) and many.max() > 1.5 * many.mean()


def line(hanging, at, anchor, **different):
    """A chain from the body 0 to an anchor."""
    long = hanging.stiffness / hanging.length
    given = SpringLine("brick.l", 0, at, None, anchor, long, hanging.length, 0.0, False, chain=hanging)
    return given._replace(**different)


def swung(lines, dt, steps, gravity=(0.0,) * 3, see=None, **different):
    """A body on lines after so many steps, and its lines; ``see`` looks at both after each."""
    bodies = Bodies([body(**different)], gravity)
    held = Lines(lines, bodies)
    bodies.load(*held.pulls(bodies, 0.0, 0.0))
    for n in range(1, steps + 1):
        bodies.drift(n * dt, dt)
        bodies.load(*held.pulls(bodies, n * dt, dt))
        bodies.kick(n * dt, dt)
        if see:
            see(bodies, held)
    return bodies, held


def test_a_light_taut_line_does_as_a_spring():
    hanging = chain(10, 1.0, mass=1e-3, stiffness=12.0, pull=(0.0,) * 3)
    weightless = line(hanging, (1.0, -2.0, 0.5), (1.0, -2.0, 1.55))
    spring = weightless._replace(chain=None, pulls_only=True)
    thrown = {"velocity": (0.02, 0.0, 0.05)}
    places = [swung([one], 1e-2, 200, **thrown)[0].place[0] for one in (weightless, spring)]
    start = np.array([1.0, -2.0, 0.5])
    assert np.linalg.norm(places[0] - places[1]) < 0.005 * np.linalg.norm(places[1] - start)


def test_body_and_line_keep_their_energy_and_the_anchor_takes_their_momentum():
    """A body of 3 kg on a chain of 1 kg swings in air, without damping; measured 0.6 % of each."""
    hanging = chain(20, 1.0, stiffness=3e3)
    told, moments, energies = [], [], []

    def see(bodies, held):
        hung = held._hanging[0]
        each = hanging.length / hanging.pieces
        moments.append(3.0 * bodies.velocity[0] + each * hung.velocity[1:-1].sum(axis=0))
        weight = 9.81 * (
            3.0 * bodies.place[0, 2] + each * (hung.place[1:-1, 2].sum() + 0.5 * bodies.place[0, 2])
        )
        long = np.linalg.norm(np.diff(hung.place, axis=0), axis=1)
        stretch = 0.5 * hanging.stiffness / each * (np.maximum(long - each, 0.0) ** 2).sum()
        going = 1.5 * (bodies.velocity[0] ** 2).sum() + 0.5 * each * (hung.velocity[1:-1] ** 2).sum()
        energies.append(going + stretch + weight)
        told.append(hung.pulls[1] * -1.0)

    dt, start = 5e-4, (1.0, -2.0, 0.5)
    swung(
        [line(hanging, start, (1.8, -2.0, 1.0))],
        dt,
        3000,
        ALONG_Z,
        see,
        velocity=(0.5, 0.3, 0.0),
        turns=(False,) * 3,
    )
    moments, told, energies = np.array(moments), np.array(told), np.array(energies)
    weight = (3.0 + 1.0) * np.array(ALONG_Z)  # half a piece hangs at each end
    gained = np.cumsum((weight + told) * dt, axis=0)
    apart = moments - moments[0] - (gained - gained[0])
    assert np.abs(moments).max() > 3.0 and np.abs(apart).max() < 0.01 * np.abs(moments).max()
    assert np.ptp(energies) < 0.01 * np.ptp(moments[:, 2] ** 2 / 6.0)


def test_a_line_that_snaps_taut_wins_no_energy_and_lets_go_at_its_load():
    hanging = chain(20, 1.0, mass=0.05, stiffness=1e4, pull=(0.0,) * 3, damping=0.1)
    slack = line(hanging, (1.0, -2.0, 0.5), (1.0, -2.0, 1.4))
    peak = []
    bodies, _ = swung(
        [slack], 1e-3, 400, see=lambda b, h: peak.append(h.tensions[0]), velocity=(0.0, 0.0, -2.0)
    )
    assert 1.5 < bodies.velocity[0, 2] < 2.01  # thrown back
    assert max(peak) == pytest.approx(2.0 * math.sqrt(3.0 * 1e4), rel=0.15)  # v √(mk)
    weak = slack._replace(breaks=0.5 * max(peak))
    bodies, held = swung([weak], 1e-3, 400, velocity=(0.0, 0.0, -2.0))
    assert held.parted[0] == pytest.approx(0.06, abs=0.02) and held.borne[0] >= weak.breaks
    assert bodies.velocity[0, 2] < -1.0 and not held.tensions[0]
    assert not list(held.shapes(bodies, 1.0))
    text = held.parting(0)
    assert text.startswith("bodies.brick.lines.l has parted at 0.0") and text.endswith(" N")


@pytest.mark.parametrize("mass", [0.2, 3.0])
def test_the_limit_of_the_step_holds_without_damping_and_beyond_it_lines_feed_what_they_hold(mass):
    """The end piece is twenty times as stiff as the line, and swings several times within a step."""
    hanging = chain(20, 1.0, mass=mass, stiffness=2e3, pull=(0.0,) * 3)
    lines = [line(hanging, (1.0, -2.0, 0.5), (1.0, -2.0, z)) for z in (1.52, -0.52)]
    limit = longest_step(lines, Bodies([body(turns=(False,) * 3)], (0.0,) * 3))

    def farthest(times):
        far = []
        with np.errstate(all="ignore"):
            swung(
                lines,
                times * limit,
                600,
                see=lambda b, _: far.append(abs(b.place[0, 2] - 0.5)),
                turns=(False,) * 3,
                velocity=(0.0, 0.0, 0.01),
            )
        return max(far)

    assert max(farthest(times) for times in (1.0, 0.93, 0.8, 0.55)) < 4e-4
    assert not farthest(2.9) < 1.0


def test_what_is_kept_of_lines_goes_on_with_the_same_bits():
    lines = [line(chain(10, 1.0, bed=True, damping=0.1), (1.0, -2.0, 0.5), (0.4, -2.0, 0.0))]
    ends = []
    for stop in (100, 50):
        bodies, held = swung(lines, 1e-3, stop, ALONG_Z)
        if stop == 50:
            kept, fresh = (bodies.state(), held.state()), Bodies([body()], ALONG_Z)
            again = Lines(lines, fresh)
            fresh.restore(kept[0])
            again.restore(kept[1])
            for n in range(51, 101):
                fresh.drift(n * 1e-3, 1e-3)
                fresh.load(*again.pulls(fresh, n * 1e-3, 1e-3))
                fresh.kick(n * 1e-3, 1e-3)
            bodies, held = fresh, again
        ends.append((bodies.state(), held.state()))
    assert ends[0] == ends[1]
