"""When things are written."""

from psph.solver.record import Schedule


def due_times(schedule, dt, steps):
    return [k for k in range(steps) if schedule.due(k * dt)]


def test_due_at_the_first_step_at_or_after_each_multiple():
    assert due_times(Schedule(0.1), 0.03, 12) == [0, 4, 7, 10]


def test_a_cadence_finer_than_the_steps_is_due_once_a_step():
    assert due_times(Schedule(0.001), 0.03, 5) == [0, 1, 2, 3, 4]


def test_exact_multiples_are_not_missed():
    assert due_times(Schedule(0.3), 0.1, 10) == [0, 3, 6, 9]
