"""Steps of their own that particles of a gas take: how long they are, who is woken, and what is kept."""

import numpy as np
import pytest
from drafts import WATER, draft, refusal
from gauging import start
from physics.test_gas import SWITCHED, of

from psph.runs.explain import explain
from psph.scene import Scene
from psph.simulation.each_step import TICKS, EachStep, kick_own_rows, predict_own_rows, turn
from psph.simulation.gas import Gases
from psph.simulation.gas_shares import Sharing, find_shares
from psph.simulation.gas_steps import FINER, ROUNDING, GasSteps, fitting

BLAST = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.02
kernel = "wendland-c4"
smoothing = 1.8
periodic = ["x", "y"]
lower = [-0.5, -0.5]
upper = [0.5, 0.5]
[time]
end = 1.0
halvings = 4
[ideal_gases.gas]
shape.box = { lower = [-0.5, -0.5], upper = [0.5, 0.5] }
density = 1.0
thermal_energy = "125 if r < 0.05 else 1e-3"
"""
"""1 J in a disc: run/cases/gas/sedov.toml with half as many particles along an axis."""


def blast(folder, end, *sets):
    """It ``end`` seconds on: the simulation, what its energy has gained, as a part of it, and its momentum,
    as a part of what all move with."""
    simulation = start(draft(folder, BLAST, *sets))
    mass = of(simulation, "mass")[0]
    begun = mass @ of(simulation, "thermal_energy")[0]
    while simulation.time < end:
        simulation.step(end)
    mass, v, u = of(simulation, "mass", "velocity", "thermal_energy")
    gained = mass @ (0.5 * (v**2).sum(axis=1) + u) / begun - 1.0
    return simulation, gained, np.abs(mass @ v).max() / (mass @ np.abs(v)).max()


def front(simulation):
    """The largest mean density over a ring, and where, m."""
    x, rho = of(simulation, "position", "density")
    edges = np.arange(0.1, 0.4, 0.02)
    ring = np.digitize(np.hypot(*x.T), edges)
    mean = [rho[ring == k].mean() for k in range(1, len(edges))]
    return max(mean), edges[np.argmax(mean)] + 0.01


@pytest.mark.parametrize(
    "now, longest, long", [(0, 1.0, 16), (0, 0.99, 8), (8, 1.0, 8), (12, 1.0, 4), (3, 1.0, 1)]
)
def test_a_step_is_a_power_of_two_that_divides_its_beginning(now, longest, long):
    tick, part = 1.0 / TICKS, TICKS // 16
    assert fitting(float(now * part), longest, tick) == long * part


def test_a_step_of_its_own_in_parts_is_one_leapfrog():
    """u' = −2u + 1 by a particle whose step has three parts, seen at its end as after a whole step."""
    data, of_step = np.array([[1.0], [0.0], [-1.0], [0.0], [0.0]]), EachStep(*np.zeros((6, 1)))
    rows, whole = np.array([[0, 1, 2, 3, 4]]), 0.25
    of_step.long[0] = TICKS / 4
    for now, ticks in ((0, TICKS / 16), (TICKS / 16, TICKS / 16), (TICKS / 8, TICKS / 8)):
        dt = whole * 4 * ticks / TICKS
        turn(0, 1, float(now), ticks, whole * 4 / TICKS, of_step)
        predict_own_rows(0, 1, dt, data, rows, of_step)
        seen = 1.0 - (now + ticks) / TICKS * 4 * whole
        assert data[1, 0] == pytest.approx(seen, rel=1e-14)
        if of_step.last[0] > 0.0:
            data[2, 0] = -2.0 * data[1, 0] + 1.0
        kick_own_rows(0, 1, dt, data, rows, of_step)
    assert of_step.step[0] == whole and data[0, 0] == pytest.approx(
        1.0 - 0.5 * whole * (1.0 + 0.5), rel=1e-14
    )


def test_a_blast_keeps_its_energy_where_who_sleeps_is_woken(tmp_path, monkeypatch):
    """2D, 50 particles along an edge, 0.04 s; without waking the shock runs into gas that does not answer."""
    together, *_ = blast(tmp_path, 0.04, "time.halvings=0")
    each, gained, momentum = blast(tmp_path, 0.04)
    assert abs(gained) < 1e-3 and momentum < 1e-3
    (dense, place), (denser, farther) = front(each), front(together)
    assert dense == pytest.approx(denser, rel=0.01) and place == pytest.approx(farther, abs=1e-9)
    due, woken, every = (
        getattr(each.engine.of("ideal_gases").steps, name) for name in ("_due", "_woken", "_all")
    )
    assert 0 < woken < 0.05 * every and due < 0.5 * every
    monkeypatch.setattr(GasSteps, "wake", lambda self, dt: None)
    assert abs(blast(tmp_path, 0.04)[1]) > 2e-2


def test_who_sleeps_keeps_its_share_of_the_viscosity_and_who_ends_a_step_follows_by_that():
    """Of two alike, with sound of 1 m/s in gas that has stopped: s falls by q = 0.05 c τ/H, H = 2 m, τ = 4 s."""
    own, of_both = EachStep(*np.zeros((6, 2))), Sharing(*np.ones((7, 2)))
    own.step[:], own.last[:], of_both.earlier[:] = 4.0, (0.0, 1.0), -1.0
    find_shares(0, 2, 0.0, 2.0, 0.5, own, of_both)
    assert of_both.shocked.tolist() == pytest.approx([1.0, 1.0 / (1.0 + 0.05 * 4.0 / 2.0)])
    assert of_both.earlier.tolist() == [-1.0, 1.0] and of_both.share[0] == 1.0 and of_both.share[1] < 0.5


def calmed(folder, *sets):
    """By how much the shares of a switch have fallen where a blast has not come yet, after 0.04 s."""
    simulation, gained, _ = blast(folder, 0.04, SWITCHED, *sets)
    assert abs(gained) < 1e-2
    x, shocked = of(simulation, "position", "shocked")
    return 1.0 - shocked[np.hypot(*x.T) > 0.35].mean()


def test_shares_fall_in_steps_of_their_own_as_in_those_of_all(tmp_path, monkeypatch):
    """As those of the simulation are shorter, by them shares would fall ten times too slowly."""
    together, each = calmed(tmp_path, "time.halvings=0"), calmed(tmp_path)
    assert each == pytest.approx(together, rel=0.02)
    settle = Gases.after_sums

    def by_the_shortest(self, time, dt):
        told = self._store["own_step"]
        kept, told[:] = np.array(told), dt
        settle(self, time, dt)
        told[:] = kept

    monkeypatch.setattr(Gases, "after_sums", by_the_shortest)
    assert calmed(tmp_path) < 0.3 * together


def test_nobody_sleeps_longer_than_its_neighbours_bear(tmp_path):
    """At each end of a step: of all that is in a list, told before that step."""
    simulation = start(draft(tmp_path, BLAST))
    seen = []

    def look(self, dt):
        GasSteps.wake(self, dt)
        s, lists = self._store, self._domain.lists
        longest, own, sleeps = s["longest_step"], s["own_step"], s["last_kick"] == 0.0
        for row in np.flatnonzero(sleeps[s.inner])[::7]:
            begin = int(lists.begin[row])
            least = longest[lists.lists[begin : begin + int(lists.lengths[row])]].min()
            seen.append(own[s.low + row] / least)

    steps = simulation.engine.of("ideal_gases").steps
    steps.wake = look.__get__(steps)
    for _ in range(2):
        simulation.step()
    assert len(seen) > 1000 and max(seen) <= FINER * (1.0 + 2.0 * ROUNDING)


def test_steps_of_all_end_with_those_of_each(tmp_path):
    """After a step of all everybody has ended one, and the longest is 2^halvings of the shortest at the most."""
    simulation = start(draft(tmp_path, BLAST, "time.halvings=3"))
    for _ in range(3):
        simulation.step()
        own = simulation.store.shown("own_step")
        assert (simulation.store.shown("last_kick") > 0.0).all() and simulation.parts >= 8
        assert simulation.passed(simulation.parts) and own.max() / own.min() >= 4.0


def test_explain_says_how_long_steps_are(tmp_path):
    text = "\n".join(explain(Scene(draft(tmp_path, BLAST)), 1))
    assert "2 to 16 times shorter" in text and "woken" in text


@pytest.mark.parametrize(
    "sets, says",
    [
        (("time.step=1e-4",), "time.step"),
        (('physics.shock_viscosity="off"',), "shock_viscosity"),
        (('ideal_gases.gas.outflow="x.upper"', 'space.periodic=["y"]'), "outflow"),
    ],
)
def test_what_steps_of_their_own_do_not_know_is_refused(tmp_path, sets, says):
    [line] = [one for one in refusal(tmp_path, BLAST, *sets) if "halvings" in one]
    assert says in line


def test_a_liquid_has_no_steps_of_its_own(tmp_path):
    [line] = refusal(tmp_path, WATER, "time.halvings=2")
    assert "gases alone" in line
