"""When things are written."""

import h5py
import numpy as np
import pytest
from drafts import draft
from gauging import started
from mpi4py import MPI
from simulation.test_precision import SPACING, box

from psph.runs.record import Record, Schedule
from psph.runs.start import run
from psph.scene import Scene

FALLING = """
scheme = "sph"
time.end = 0.3
physics = { sound_speed = 20.0, gravity = [5.0, 0.0] }
space = { dimensions = 2, spacing = 0.1, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [0.8, 0.8] }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.8] }
velocity = [3.0, 0.0]
"""


def due_times(schedule, dt, steps):
    return [k for k in range(steps) if schedule.due(k * dt)]


def test_due_at_the_first_step_at_or_after_each_multiple():
    assert due_times(Schedule(0.1), 0.03, 12) == [0, 4, 7, 10]


def test_a_cadence_finer_than_the_steps_is_due_once_a_step():
    assert due_times(Schedule(0.001), 0.03, 5) == [0, 1, 2, 3, 4]


def test_exact_multiples_are_not_missed():
    assert due_times(Schedule(0.3), 0.1, 10) == [0, 3, 6, 9]


def test_no_height_across_a_period(tmp_path):
    """Gravity along a periodic axis accelerates; its potential would jump where a particle wraps."""
    case = draft(tmp_path, FALLING, "guards.energy=10.0")  # gravity drives it round and round
    run(case, tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    log = np.genfromtxt(tmp_path / "run/log.csv", delimiter=",", names=True)
    mass, moved = 1000.0 * 0.64, 3.0 * log["time"] + 0.5 * 5.0 * log["time"] ** 2
    assert moved[-1] > 0.8  # once around
    assert log["kinetic_energy"][-1] == pytest.approx(0.5 * mass * (3.0 + 5.0 * 0.3) ** 2, rel=1e-3)
    assert np.abs(np.diff(log["potential_energy"])).max() < 1e-9
    assert Scene(case).layout.height_gravity == (0.0, 0.0)
    walled = draft(tmp_path, FALLING, 'space.periodic=["y"]')
    assert Scene(walled).layout.height_gravity == (5.0, 0.0)


def test_a_frame_holds_positions_inside_the_periods(tmp_path):
    """All move as one: lists last, and particles leave the domain between two of them."""
    case = box(2, "double", periodic=True, sides=20)
    simulation, scene = started(case)
    store = simulation.store
    record = Record(scene, simulation, tmp_path)
    length = 20 * SPACING
    while max(x[store.inner].max() for x in store["position"]) < length:
        simulation.step()
    record.write_frame()
    record.close()
    with h5py.File(tmp_path / f"{case.name}.h5") as file:
        [frame] = file["frames"].values()
        written = frame["position"][...]
    assert written.min() >= 0.0 and written.max() < length
    apart = (written - store.owned_rows("position")) / length
    assert np.abs(apart - np.rint(apart)).max() < 1e-12 and np.abs(np.rint(apart)).max() == 1.0
