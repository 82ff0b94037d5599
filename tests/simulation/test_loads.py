"""Loads on solids: the work that they do, and the guard of the energy that counts it."""

import numpy as np
import pytest
from drafts import draft
from runs.test_moving_guards import watched
from simulation.test_clamps import BAR, FLAP, advanced, begun, energy

PULLED = (
    BAR
    + """
[solids.bar.loads.end]
shape.box = { lower = [0.5, 0.0], upper = [0.6, 0.06] }
force = [0.2, -0.05]
[solids.bar.loads.middle]
shape.box = { lower = [0.2, 0.0], upper = [0.4, 0.03] }
force = [-0.03, 0.1]
"""
)
"""The bar of the clamps, under two forces."""


def pulled(store):
    """Work of the forces at their full size, by where their particles are, J."""
    x = store.shown("reference")
    u = store.shown("position") - x
    end = x[:, 0] > 0.5
    middle = (x[:, 0] > 0.2) & (x[:, 0] < 0.4) & (x[:, 1] < 0.03)
    return u[end].mean(axis=0) @ [0.2, -0.05] + u[middle].mean(axis=0) @ [-0.03, 0.1]


def test_what_loads_have_done_is_what_the_bar_has_gained(tmp_path):
    bar = begun(draft(tmp_path, PULLED))
    for time in (0.4, 0.9, 1.7):
        whole, work = energy(advanced(bar, time))
        assert work == pytest.approx(pulled(bar.store), rel=1e-11) and work > 2e-4
        assert whole == pytest.approx(work, rel=5e-3)


def test_the_guard_of_the_energy_counts_the_work_of_loads(tmp_path):
    simulation, guards = watched(tmp_path, PULLED)
    assert guards._books
    gains, given = [], []
    while simulation.time < 1.0:
        simulation.step()
        gains.append(guards._gain())
        given.append(simulation.store.shown("work").sum() / guards._unit)
    assert np.abs(gains).max() < 0.01 * max(given)


def test_loads_that_rise_do_work_by_their_share(tmp_path):
    bar = begun(draft(tmp_path, PULLED, "solids.bar.load_rise=1.5"))
    for time in (0.8, 1.6):
        whole, work = energy(advanced(bar, time))
        assert whole == pytest.approx(work, rel=5e-3)
        assert work < 0.8 * pulled(bar.store)


def test_loads_work_against_a_clamp_that_carries_their_particles(tmp_path):
    moves = "solids.bar.clamps.far={shape={box={lower=[0.5,0.0],upper=[0.6,0.06]}},motion={translation=[0.01,0.02],ramp=0.2}}"
    bar = begun(draft(tmp_path, PULLED, moves))
    whole, work = energy(advanced(bar, 0.7), (False, True, True))
    assert whole == pytest.approx(work, rel=2e-2) and work > 0.0


def test_loads_of_a_flap_in_water_do_work_in_each_of_its_steps(tmp_path):
    """Several in one of the water, in a domain that repeats."""
    load = "solids.flap.loads.end={shape={box={lower=[0.5,0.7],upper=[0.7,0.9]}},force=[900.0,-300.0]}"
    flap = begun(draft(tmp_path, FLAP, load, "solids.flap.young=2e7", "solids.flap.clamps=off"))
    for _ in range(40):
        flap.step()
    store = flap.store
    own = store.shown("group") == 1
    x = store.shown("reference")[own]
    u = store.shown("position")[own] - x
    work = store.shown("work")[own]
    end = x[:, 1] > 0.7
    assert work.sum() == pytest.approx(u[end].mean(axis=0) @ [900.0, -300.0], rel=1e-10)
    assert work[end].sum() > 0.0 and not work[~end].any()
