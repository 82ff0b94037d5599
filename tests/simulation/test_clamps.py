"""Clamps that move: what they do to their solids, and the energy and momentum that they give."""

import numpy as np
import pytest
from drafts import draft
from long import LONG
from mpi4py import MPI

from psph.output.diagnostics import total_energy, work_done
from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene, check
from psph.simulation.immersion import substeps
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan
from psph.simulation.step import Simulation

BAR = """
time.end = 10.0
space = { dimensions = 2, spacing = 0.01 }
[solids.bar]
shape.box = { lower = [-0.09, 0.0], upper = [0.6, 0.06] }
density = 1000.0
young = 1000.0
poisson = 0.0
[solids.bar.clamps.grip]
shape.box = { lower = [-0.09, 0.0], upper = [0.0, 0.06] }
"""
"""A bar 0.6 m long in which waves along it run at 1 m/s, and its grip."""

LENGTH, SWING = 0.6, 1e-4


def begun(case, profile=None):
    """The simulation of a case; with another velocity along x at the start, of X (n,) in m."""
    scene = Scene(case)
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    if profile is not None:
        for name in ("velocity", "predicted_velocity"):
            store[name][0][store.inner] = profile(store.shown("reference")[:, 0])
    return Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())


def advanced(simulation, end):
    """The same at ``end`` s."""
    while simulation.time < end:
        simulation.step(end)
    return simulation


def energy(simulation, led=(False, True)):
    """Of what is not in the clamp, with what is stored everywhere; and the work of clamp and loads, J."""
    comm, store = simulation.comm, simulation.store
    moving = total_energy(comm, store, (0.0, 0.0), lambda density, rest: 0.0 * density, np.array(led))
    return moving + simulation.engine.stored_energy(), work_done(comm, store)


def test_a_bar_whose_end_swings_answers_as_waves_along_it_do(tmp_path):
    """u = a cos(k(L − X))/cos(kL) sin ωt with kL = 1, from that state: displacement and velocity after 1.25
    periods, where the free end moves 1.85 times as far as the clamp."""
    turn = 1.0 / LENGTH
    swing = {"amplitude": [SWING, 0.0], "frequency": turn / (2.0 * np.pi)}
    text = f"motion.sinusoid = {{ amplitude = [{SWING}, 0.0], frequency = {swing['frequency']!r} }}\n"

    def shape(x):
        return np.where(x > 0.0, np.cos(turn * (LENGTH - x)) / np.cos(turn * LENGTH), 1.0)

    bar = begun(draft(tmp_path, BAR + text), lambda x: SWING * turn * shape(x))
    start, _ = energy(bar)
    given = []
    for quarter in range(1, 6):
        advanced(bar, quarter * 0.5 * np.pi / turn)
        given.append(energy(bar))
    x = bar.store.shown("reference")[:, 0]
    u = bar.store.shown("position")[:, 0] - x
    held = x < 0.0
    assert np.abs(u[held] - SWING).max() < 1e-12 * SWING * 1e3  # at its turn
    assert np.sqrt(((u - SWING * shape(x)) ** 2).mean()) < 0.03 * SWING * 1.85
    assert u[x > 0.59].mean() == pytest.approx(SWING / np.cos(1.0), rel=0.03)
    whole, work = np.transpose(given)
    assert np.abs(work).max() > 0.05 * start  # without it the balance would be off by as much
    assert np.abs(whole - work - start).max() < 1e-3 * start


def test_a_bar_that_moves_along_with_its_clamp_has_no_stress(tmp_path):
    way = np.array([0.3, -0.2])
    moves = "motion.translation = [0.3, -0.2]\n"
    bar = begun(draft(tmp_path, BAR + moves, "solids.bar.velocity=[0.3, -0.2]"))
    advanced(bar, 1.0)
    bar.engine.of("solids").measure()
    store = bar.store
    assert np.abs(store.shown("position") - store.shown("reference") - way).max() < 1e-12
    assert store.shown("von_mises").max() < 1e-10 * 1000.0
    assert energy(bar)[1] == pytest.approx(0.0, abs=1e-12)
    left = advanced(begun(draft(tmp_path, BAR + moves)), 0.2)  # the control: at rest at the start
    left.engine.of("solids").measure()
    assert left.store.shown("von_mises").max() > 0.1 * 1000.0


@LONG
def test_clamps_of_updated_solids_move_too(tmp_path):
    text = 'scheme = "solid"\n' + BAR + "motion.translation = [0.3, -0.2]\n"
    more = ("solids.bar.description=updated", "solids.bar.velocity=[0.3, -0.2]")
    bar = advanced(begun(draft(tmp_path, text, *more)), 0.2)
    bar.settle_pressure()
    store = bar.store
    held = store.shown("group") == 1
    way = store.shown("position")[held] - store.shown("anchor")[held]
    assert np.abs(way - [0.06, -0.04]).max() < 1e-12 and np.abs(store.shown("pressure")).max() < 1e-9
    left = advanced(begun(draft(tmp_path, text, more[0])), 0.2)  # the control: at rest at the start
    left.settle_pressure()
    assert np.abs(left.store.shown("pressure")).max() > 10.0


def test_a_bar_that_turns_with_its_clamp_is_stretched_by_its_spin_alone(tmp_path):
    """About the middle of its fixed end; the mean stretch of a period of its first wave along it is that of
    ρω²L³/3E."""
    spin = 0.1
    turns = f"motion.rotation = {{ speed = {spin}, center = [0.0, 0.03] }}\n"
    field = f"solids.bar.velocity_gradient=[[0.0, -{spin}], [{spin}, 0.0]]"
    bar = begun(draft(tmp_path, BAR + turns, field, "solids.bar.velocity_center=[0.0, 0.03]"))
    x = bar.store.shown("reference")
    tip, inside = x[:, 0] > 0.59, x[:, 0] < -0.04  # all neighbours of these are in the clamp too
    far = []
    for time in np.linspace(0.0, 4.0 * LENGTH, 33)[1:]:
        advanced(bar, time)
        away = bar.store.shown("position")[tip] - [0.0, 0.03]
        far.append(np.linalg.norm(away, axis=1).mean())
    bar.engine.of("solids").measure()
    assert bar.store.shown("von_mises")[inside].max() < 1e-10 * 1000.0  # after a turn of 0.24 rad
    stretch = np.mean(far) - np.linalg.norm(x[tip] - [0.0, 0.03], axis=1).mean()
    assert stretch == pytest.approx(spin**2 * LENGTH**3 / 3.0, rel=0.05)


FLAP = """
[space]
dimensions = 2
spacing = 0.05
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.2, 1.2]
[time]
end = 1.0
[physics]
sound_speed = 20.0
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.2, 1.2] }
shape.difference.minus = [{ box = { lower = [0.5, 0.2], upper = [0.7, 0.9] } }]
density = 1000.0
viscosity = 0.01
velocity = [0.3, -0.1]
jitter = 0.1
[solids.flap]
shape.box = { lower = [0.5, 0.2], upper = [0.7, 0.9] }
density = 1500.0
young = 2.0e5
poisson = 0.3
[solids.flap.clamps.hub]
shape.box = { lower = [0.5, 0.2], upper = [0.7, 0.4] }
motion.sinusoid = { angle = 0.3, center = [0.6, 0.3], frequency = 2.0 }
"""
"""A flap in water that swings about its hub, in a domain that repeats."""


def given_by_hub(flap):
    """The force of the hub on the flap and on the water, N (2,), at this moment."""
    store = flap.store
    hub = store.shown("group") == 2
    inner = store.shown("inertia")[hub, None] * store.shown("acceleration")[hub]
    return -(inner + store.shown("mass")[hub, None] * store.shown("load")[hub]).sum(axis=0)


def test_what_a_hub_gives_to_flap_and_water_is_what_they_gain(tmp_path):
    """Momentum to rounding, with one step of the flap in a step of the water."""
    case = draft(tmp_path, FLAP)
    assert check(Scene(case)) == []
    flap = begun(case)

    def momentum():
        store, free = flap.store, flap.store.shown("group") != 2
        mass, velocity = store.shown("inertia")[free], store.shown("velocity")[free]
        return mass @ velocity, (mass * np.linalg.norm(velocity, axis=1)).sum()

    (before, size), given, force = momentum(), np.zeros(2), given_by_hub(flap)
    own = solid_plan(flap.plan)
    for _ in range(40):
        flap.step()
        pace = flap.previous_speed
        assert substeps(own.solids, own.smoothing_length, flap.dt, pace) == 1
        after = given_by_hub(flap)
        given += 0.5 * flap.dt * (force + after)
        force = after
    gained = momentum()[0] - before
    assert np.abs(gained).max() > 1e-3 * size and np.abs(gained - given).max() < 1e-12 * size
    assert work_done(flap.comm, flap.store) > 0.0


def test_within_a_step_of_the_water_the_clamp_goes_on(tmp_path, monkeypatch):
    """Stiffer, the flap makes several steps in one of the water: at each its hub is where the time has it."""
    flap = begun(draft(tmp_path, FLAP, "solids.flap.young=2e7"))
    store, solids, own = flap.store, flap.engine.of("solids"), solid_plan(flap.plan)
    seen, plain = [], solids.sum

    def watched(time, dt):
        hub = store.shown("group") == 2
        arm = store.shown("anchor")[hub] - [0.6, 0.3]
        angle = 0.3 * np.sin(4.0 * np.pi * time)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        away = store.shown("position")[hub] - [0.6, 0.3] - arm @ turn
        rate = 1.2 * np.pi * np.cos(4.0 * np.pi * time)
        faster = store.shown("predicted_velocity")[hub] - rate * (arm @ turn)[:, ::-1] * [-1.0, 1.0]
        seen.append((time, np.abs(away).max(), np.abs(faster).max()))
        plain(time, dt)

    monkeypatch.setattr(solids, "sum", watched)
    for _ in range(3):
        flap.step()
    times, away, faster = np.transpose(seen)
    count = substeps(own.solids, own.smoothing_length, flap.dt, flap.previous_speed)
    assert count > 3 and len(seen) >= 3 * count and times[-1] == flap.time
    assert np.diff(times) == pytest.approx(flap.dt / count, rel=0.3)
    assert away.max() < 1e-14 and faster.max() < 1e-13
