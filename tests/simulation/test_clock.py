"""Time steps that the time cannot tell, and cadences: nothing drifts or stands still unseen."""

import math
import re

import numpy as np
import pytest
from mpi4py import MPI
from runs.guarded import boxed, started
from runs.resuming import steps
from runs.test_guards import push_once, report_of

from psph.case.consistency import LARGEST_LOSS, MOST_STEPS
from psph.case.measured import MOST_MOMENTS
from psph.output.checkpoint import checkpoints
from psph.output.reader import Run
from psph.runs.record import Schedule
from psph.runs.start import run
from psph.simulation.step import TimeLost

COMM = MPI.COMM_SELF


def accelerated(acceleration):
    """A change of a simulation: the largest acceleration of all, m/s²."""

    def change(simulation):
        simulation.acceleration = acceleration

    return change


@pytest.mark.parametrize("acceleration", [1e300, float("inf")])
def test_a_step_lost_in_the_time_ends_the_run(tmp_path, monkeypatch, acceleration):
    """Without the guard the loop would never end: the time stands still."""
    push_once(monkeypatch, 5, accelerated(acceleration))
    trouble, _ = started(boxed(tmp_path, COMM), tmp_path / "run", COMM)
    assert isinstance(trouble, Exception) and "\n" not in str(trouble)
    assert re.search(
        r"the run stands still at step 5, time 0\.0\d+ s: a step of \S+ s \(limit: force\) is lost "
        r"in the rounding of the time; particle \d+ is accelerated most, by [\d.e+-]+ m/s2",
        str(trouble),
    )
    text, _ = report_of(tmp_path / "run")
    assert "guards.clock" not in text and "on_trouble=warn" not in text
    assert [path.name for path in checkpoints(tmp_path / "run")] == ["checkpoint-5.h5"]


def test_the_guard_knows_how_much_of_a_step_is_lost(tmp_path):
    """Seconds at which a step of 1 ms is rounded by less, and by more, than the bound."""
    simulation = steps(boxed(tmp_path, COMM, "time.step=1e-3"), COMM, 0)
    lost = {}
    for time in (0.0, 1e-3 * MOST_STEPS / 100, 1e-3 * MOST_STEPS * 100):
        simulation.time = time
        rounded = abs(((time + 1e-3) - time) / 1e-3 - 1.0)
        try:
            simulation.step()
            lost[rounded] = False
        except TimeLost:
            lost[rounded] = True
    assert set(lost.values()) == {True, False}
    assert all(is_lost == (rounded >= LARGEST_LOSS) for rounded, is_lost in lost.items())


@pytest.mark.parametrize("sets", [(), ("time.step=7.3e-4",)])
def test_a_run_ends_on_its_end_and_no_step_vanishes(tmp_path, sets):
    """Wherever the end lies between two steps, the last ones are at least half as long as others."""
    case = boxed(tmp_path, COMM, *sets)
    usual = steps(case, COMM, 3).dt
    for end in (3.0 + np.array([-1e-9, 0.0, 1e-9, 1e-3, 0.3, 0.5, 0.999, 1.001, 1.5])) * usual:
        simulation, taken = steps(case, COMM, 0), []
        while simulation.time < end:
            simulation.step(end)
            taken.append(simulation.dt)
        assert simulation.time == end
        assert min(taken) > 0.499 * usual and max(taken) < usual * (1.0 + 1e-5)
        assert len(taken) <= math.ceil(end / usual - 1e-6) + 1
        assert sum(taken) == pytest.approx(end, rel=1e-14)


def test_a_whole_number_of_fixed_steps_stays_that_number(tmp_path):
    """The rounding of their sum makes no step more."""
    case = boxed(tmp_path, COMM, "time.step=1e-3", "time.end=0.11")
    finished = run(case, tmp_path / "run", COMM, say=lambda *_: None)
    assert (finished.simulation.steps, finished.simulation.time) == (110, 0.11)
    log = np.loadtxt(tmp_path / "run/log.csv", delimiter=",", skiprows=1)
    assert log[-1, 0] == 0.11 and Run(tmp_path / "run").times[-1] == 0.11


def test_frames_do_not_drift():
    """Due at the first step at or after k times the interval, whatever k; once each."""
    schedule, time, dt, found = Schedule(0.1), 0.0, 0.1 / 7, []
    for step in range(70_001):  # the clock of a simulation: it adds up its steps
        if schedule.due(time):
            found.append(step)
        time += dt
    assert found == list(range(0, 70_001, 7))


def test_the_last_of_very_many_moments_are_not_shifted():
    interval, most = 1e-3, int(MOST_MOMENTS)
    schedule = Schedule(interval)
    for k in range(most - 1000, most):
        assert schedule.due(k * interval)
        assert not schedule.due((k + 0.9) * interval)
