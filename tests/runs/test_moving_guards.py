"""The guards beside walls that move: their work is booked, and what is behind them is seen."""

import numpy as np
import pytest
from drafts import draft
from guests.test_guests import begin
from long import LONG
from scipy.spatial import cKDTree

from psph.case import load
from psph.fields import FLUID, WALL
from psph.physics.rigid.pose import rotation
from psph.runs.guards import Guards
from psph.scene import Scene

POOL = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 2.0
parallel.axis = "x"
physics.gravity = [0.0, -9.81]
physics.sound_speed = 30.0
fluids.water = { shape.box = { lower = [0.3, 0.0], upper = [2.0, 0.5] }, pressure = "hydrostatic" }
[walls.pool]
shape.difference.from.box = { lower = [-0.15, -0.15], upper = [2.15, 1.5] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 1.5] } }]
[walls.paddle]
shape.box = { lower = [0.1, 0.0], upper = [0.3, 1.4] }
motion = { sinusoid = { amplitude = [0.1, 0.0], period = 0.5, phase = -1.5708 } }
"""


def watched(tmp_path, text=POOL, *sets):
    """A simulation and its guards, which say nothing."""
    draft(tmp_path, text, *sets)
    simulation = begin(tmp_path / "case.toml")
    scene = Scene(load(tmp_path / "case.toml", sets))
    return simulation, Guards(scene, simulation, None, tmp_path, lambda line: None)


def booked(tmp_path, scheme, spacing=0.05, aside=lambda simulation, kernel: 0.0, more=""):
    """Every 20 steps for half a second the energy won, what the paddle has given and the time integral of the
    power ``aside``, J (n, 3)."""
    text = POOL.replace("spacing = 0.05", f"spacing = {spacing}")
    simulation, guards = watched(tmp_path, f'scheme = "{scheme}"\n{more}\n{text}')
    rows, beside = [], 0.0
    while simulation.time < 0.5:
        simulation.step()
        beside += simulation.dt * aside(simulation, guards.scene.kernel)
        if simulation.steps % 20 == 0:
            given = simulation.store.shown("work").sum()
            rows.append((guards._gain() * guards._unit, given, beside))
    return np.array(rows)


def untaken(simulation, kernel):
    """Σ m_i m_w p_i/ρ_i² (L_i ∇W)·u_iw over fluid i with p_i < 0 and walls w, W: the power that walls would
    take from the fluid if they pulled it (psph.physics.fluid.parting)."""
    simulation.settle_pressure()
    x, u, m, p, rho, kind, corrected = (
        simulation.store.shown(name)
        for name in ("position", "velocity", "mass", "pressure", "density", "kind", "gradient_correction")
    )
    wall, pulled = np.flatnonzero(kind == WALL), np.flatnonzero((kind == FLUID) & (p < 0.0))
    lists = cKDTree(x[pulled]).query_ball_tree(cKDTree(x[wall]), kernel.support / kernel.inverse_h)
    i = np.repeat(pulled, [len(one) for one in lists])
    w = wall[[k for one in lists for k in one]]
    apart, speed = x[i] - x[w], u[i] - u[w]
    r = np.hypot(*apart.T)
    slope = np.array([kernel.dw(one) for one in r]) / r
    xx, xy, yy = corrected[i].T
    along = ((1.0 + xx) * apart[:, 0] + xy * apart[:, 1]) * speed[:, 0]
    along += (xy * apart[:, 0] + (1.0 + yy) * apart[:, 1]) * speed[:, 1]
    return float((m[i] * m[w] * p[i] / rho[i] ** 2 * slope * along).sum())


@pytest.mark.parametrize("scheme, spacing", [("sph", 0.05), pytest.param("stable", 0.025, marks=LONG)])
def test_a_paddle_may_give_energy_and_the_balance_is_kept(scheme, spacing, tmp_path):
    """Without the booking the gain would be all that the paddle gives: the control."""
    gain, given, _ = booked(tmp_path, scheme, spacing).T
    assert given.max() > 200.0
    # The paddle slides over the ground: what these two walls do to each other is not booked.
    assert gain.max() < 0.04 * given.max()


@LONG
def test_what_the_balance_misses_is_a_pull_that_walls_do_not_have(tmp_path):
    """Fluid that a wall leaves expands before it parts, and the wall does not hold it: energy from nowhere, up
    to 7 % of what the paddle gives at 10 spacings of depth.  Walls that do not count all that comes nearer
    add to that: the control."""
    gain, given, beside = booked(tmp_path, "stable", aside=untaken, more='physics.wall_approach = "off"').T
    assert gain.max() > 0.04 * given.max()
    assert (gain - beside).max() < 0.02 * given.max()
    gain, given, beside = booked(tmp_path, "stable", aside=untaken).T
    assert (gain - beside).max() > 0.04 * given.max()


def test_the_work_of_a_wall_is_force_times_way(tmp_path):
    """Water between two lids that a piston presses together: E grows by what the piston gives."""
    simulation, guards = watched(
        tmp_path,
        """
scheme = "sph"
space = { dimensions = 2, spacing = 0.05, periodic = ["y"], lower = [-0.5, 0.0], upper = [1.5, 0.5] }
time.end = 1.0
parallel.axis = "x"
physics.sound_speed = 30.0
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
walls.end.shape.box = { lower = [1.0, 0.0], upper = [1.2, 0.5] }
[walls.piston]
shape.box = { lower = [-0.2, 0.0], upper = [0.0, 0.5] }
motion = { translation = [0.02, 0.0], ramp = 0.2 }
""",
    )
    pushed = 0.0
    while simulation.time < 0.9:
        simulation.step()
        simulation.settle_pressure()
        fluid = simulation.store.shown("kind") == 0
        speed = simulation.store.shown("velocity")[simulation.store.shown("group") == 2, 0].max()
        pushed += simulation.store.shown("pressure")[fluid].mean() * 0.5 * speed * simulation.dt
    work = simulation.store.shown("work").sum()
    assert pushed > 10.0 and work == pytest.approx(pushed, rel=0.03)
    assert abs(guards._gain()) * guards._unit < 0.01 * work


def test_what_is_behind_a_wall_that_has_moved_is_seen(tmp_path):
    tank = POOL.partition("[walls.paddle]")[0]
    simulation, guards = watched(tmp_path, tank + "motion = { translation = [40.0, 0.0] }", "time.end=0.1")
    assert not guards._hidden().any()
    for _ in range(3):
        simulation.step()
    way = 40.0 * simulation.time
    assert way > 0.05
    store = simulation.store
    fluid = np.flatnonzero(store.shown("kind") == 0)[0]
    for x, deep in ((-0.1 + way, True), (0.1 + way, False)):
        store["position"][0][store.low + fluid], store["position"][1][store.low + fluid] = x, 0.7
        assert guards._hidden()[fluid] == deep
    # The control: where the wall stood at the start this would be in front of it.
    assert not guards._walls[0][0].deep(np.array([[-0.1 + way, 0.7]]), 1.0).any()


def test_walls_that_bear_nothing_have_no_books(tmp_path):
    loose = POOL.replace("[walls.paddle]", '[walls.paddle]\ncondition = "penalty"')
    assert watched(tmp_path)[1]._books and not watched(tmp_path, loose)[1]._books
    still = POOL.partition("motion")[0]
    simulation, guards = watched(tmp_path, still)
    assert guards._books and "work" not in simulation.store


SEAM = """
space = { dimensions = 2, spacing = 0.02, periodic = ["x"], lower = [0.0, -0.06], upper = [1.0, 0.6] }
time.end = 1.0
physics.gravity = [0.0, -9.81]
walls.bed.shape.box = { lower = [0.0, -0.06], upper = [1.0, 0.0] }
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.4] }, velocity = [0.5, 0.0] }
[bodies.box]
shape.box = { lower = [0.7, 0.24], upper = [0.9, 0.44] }
density = 500.0
velocity = [0.5, 0.0]
spin = 1.0
"""


@pytest.mark.parametrize("angle", [0.0, 0.234, 1.0])
@pytest.mark.parametrize("way", [0.0, 0.117, 0.35, 2.3])
def test_behind_a_body_at_the_seam_is_what_it_holds_there(way, angle, tmp_path):
    simulation, guards = watched(tmp_path, SEAM)
    poses, store = simulation.engine.poses, simulation.store
    turn = rotation((0.0, 0.0, 1.0), angle)
    bodies = simulation.engine.of("bodies").bodies
    bodies.place[0, 0] += way
    bodies.turn[0] = np.reshape(turn, (3, 3))
    poses.turn_to(0.0)
    fluid = np.flatnonzero(store.shown("kind") == 0)
    points = np.random.default_rng(3).uniform((0.0, 0.01), (1.0, 0.6), (len(fluid), 2))
    for d in range(2):
        store["position"][d][store.low + fluid] = points[:, d]
    away = points - (0.8 + way, 0.34)
    away[:, 0] -= np.rint(away[:, 0])
    own = np.abs(away @ np.reshape(turn, (3, 3))[:2, :2]).max(axis=1)
    found = guards._hidden()[fluid]
    # Beside the body nothing is behind its face; a depth inside of it, all is: within a lattice's tolerance.
    assert np.count_nonzero(own < 0.078) > 10
    assert not found[own > 0.082].any() and found[own < 0.078].all()
