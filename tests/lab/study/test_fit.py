"""What is predicted from a ladder whose law is known."""

import math

import numpy as np
import pytest

from psph.lab.study.fit import Ladder, RunPoint, own_error, richardson


def run(dx: float, order: float = 2.0, noise: float = 1.0) -> RunPoint:
    """A run in 2D: error 5 dx^p, 1e-7 s a particle-step and 1e-4 s a step."""
    particles, steps = round(dx**-2), round(10 / dx)
    return RunPoint(dx, noise * 5.0 * dx**order, 1e-7 * particles * steps + 1e-4 * steps, particles, steps)


def test_error_and_seconds_of_a_run_that_was_not_made():
    ladder = Ladder([run(0.04), run(0.02), run(0.01)], 2)
    assert ladder.order.value == pytest.approx(2.0)
    for dx in (0.03, 0.015, 0.005):  # inside the ladder and beyond
        assert ladder.error(dx).value == pytest.approx(run(dx).error, rel=1e-9)
        assert ladder.seconds(dx).value == pytest.approx(run(dx).seconds, rel=0.02)
    dx = ladder.spacing_for_error(5 * 0.007**2)
    assert dx == pytest.approx(0.007, rel=1e-6)
    assert ladder.spacing_for_seconds(run(0.007).seconds) == pytest.approx(0.007, rel=0.02)
    assert math.isnan(ladder.spacing_for_error(1e-12))


def test_scatter_makes_the_interval_that_holds_the_truth():
    rng = np.random.default_rng(1)
    held = 0
    for _ in range(200):
        noise = np.exp(0.1 * rng.standard_normal(5))
        runs = [run(dx, noise=x) for dx, x in zip((0.08, 0.04, 0.02, 0.01), noise)]
        predicted = Ladder(runs, 2).error(0.005)
        truth = run(0.005, noise=noise[-1]).error
        held += predicted.low <= truth <= predicted.high
        assert predicted.low < predicted.value < predicted.high
    assert 160 < held  # 90 % are promised, of the line through all; three points place the middle


def test_two_runs_give_a_value_without_an_interval():
    ladder = Ladder([run(0.04), run(0.02)], 2)
    assert ladder.error(0.01).value == pytest.approx(5e-4)
    assert math.isnan(ladder.error(0.01).low) and math.isnan(ladder.order.high)
    with pytest.raises(ValueError, match="two runs"):
        Ladder([run(0.04)], 2)


def test_an_error_that_levels_off_has_no_spacing_to_halve_it():
    runs = [run(0.04, 0.0), run(0.02, 0.0), run(0.01, 0.0)]
    assert math.isnan(Ladder(runs, 2).spacing_for_error(1e-3))
    assert not Ladder(runs, 2).steady and Ladder([run(0.04), run(0.02)], 2).steady


MEASURED = {
    "Taylor-Green, h/dx 2.0": ((1.59, 0.249, 0.0502), 0.0257),
    "Taylor-Green, h/dx 1.6": ((0.99, 0.25, 0.077), 0.029),
    "the Gresho vortex": ((4.38, 1.39, 0.499), 0.200),
    "a stretched drop": ((5.68, 2.85, 1.88), 1.69),
    "a standing wave": ((10.5, 4.04, 2.43), 2.48),
}
"""Errors in % at spacings that halve (docs/accuracy.md), and at half the finest of them."""


@pytest.mark.parametrize("errors, truth", MEASURED.values(), ids=MEASURED)
def test_errors_that_were_measured_are_predicted_within_a_factor(errors, truth):
    runs = [run(dx)._replace(error=e / 100) for dx, e in zip((0.04, 0.02, 0.01), errors)]
    ladder = Ladder(runs, 2)
    predicted = ladder.error(0.005)
    assert 1 / 1.5 < 100 * predicted.value / truth < 1.5
    assert predicted.low < truth / 100 < predicted.high
    assert 0.0 < ladder.floor < predicted.value


def test_steps_grow_as_along_the_ladder():
    """Friction limits them by dx²: half the spacing takes four times as many."""

    def slow(dx):
        plain = run(dx)
        steps = round(0.1 / dx**2)
        return plain._replace(steps=steps, seconds=1e-7 * plain.particles * steps + 1e-4 * steps)

    ladder = Ladder([slow(0.04), slow(0.02), slow(0.01)], 2)
    for dx in (0.05, 0.015, 0.005):
        assert ladder.seconds(dx).value == pytest.approx(slow(dx).seconds, rel=0.03)


def test_an_error_that_came_down_at_once_stays():
    errors = {0.025: 0.208, 0.02: 0.107, 0.0125: 0.101}  # still water: no power, a floor
    ladder = Ladder([run(dx)._replace(error=e) for dx, e in errors.items()], 2)
    assert ladder.floor == pytest.approx(0.101, rel=0.01)
    assert ladder.error(0.00625).value == pytest.approx(0.101, rel=0.01)
    assert math.isnan(ladder.spacing_for_error(0.05))
    assert richardson(list(errors), list(errors.values())) is None  # not an order of a scheme


def test_a_ladder_of_four_predicts_its_finest_run_by_the_others():
    runs = [run(dx) for dx in (0.04, 0.02, 0.01)]
    assert Ladder(runs, 2).prediction is None
    finest = run(0.005, noise=2.0)
    found = Ladder([finest, *runs], 2).prediction
    assert found.run == finest
    assert found.error.value == pytest.approx(finest.error / 2)
    assert found.seconds.value == pytest.approx(finest.seconds, rel=0.02)
    unsteady = runs[2]._replace(error=1.0)
    assert Ladder([finest, *runs[:2], unsteady], 2).prediction is None


def test_without_a_floor_the_error_goes_on_as_a_power():
    assert Ladder([run(0.04), run(0.02), run(0.01, noise=0.8)], 2).floor is None
    floored = [r._replace(error=r.error + 1e-3) for r in (run(0.04), run(0.02), run(0.01))]
    ladder = Ladder(floored, 2)
    assert ladder.floor == pytest.approx(1e-3, rel=1e-3)
    assert ladder.error(0.002).value == pytest.approx(run(0.002).error + 1e-3, rel=1e-3)
    assert math.isnan(ladder.spacing_for_error(0.9e-3))


def test_richardson_finds_limit_and_order():
    dx = [0.04, 0.02, 0.01, 0.005]
    q = [3.0 - 7.0 * x**1.5 for x in dx]
    found = richardson(dx[:3], q[:3])
    assert found.value.value == pytest.approx(3.0, rel=1e-4)
    assert found.order.value == pytest.approx(1.5, rel=1e-3) and math.isnan(found.order.low)
    found = richardson(dx[::-1], [x + 1e-5 * (-1) ** k for k, x in enumerate(q[::-1])])
    assert found.value.low < 3.0 < found.value.high
    assert richardson(dx[:2], q[:2]) is None
    assert richardson(dx, [1.0, 2.0, 1.5, 1.7]) is None  # it does not converge


@pytest.mark.parametrize("order", [0.7, 1.0, 1.9])
@pytest.mark.parametrize("spacings", [(0.03, 0.02, 0.01), (0.01, 0.04, 0.02, 0.005)])
def test_the_finest_runs_own_error_from_how_others_differ_from_it(spacings, order):
    finest = min(spacings)
    differences = [5.0 * (dx**order - finest**order) if dx > finest else math.nan for dx in spacings]
    own = own_error(spacings, differences)
    assert own.measured and own.order == pytest.approx(order, abs=1e-4)
    assert own.error == pytest.approx(5.0 * finest**order, rel=1e-3)


def test_one_difference_leaves_the_order_to_be_assumed():
    own = own_error([0.02, 0.01], [0.03, math.nan])
    assert not own.measured and own.order == 1.0 and own.error == pytest.approx(0.03)
    assert own_error([0.01], [math.nan]) is None and own_error([], []) is None
    assert own_error([0.02, 0.01], [0.0, math.nan]).error == 0.0


@pytest.mark.parametrize("differences, order", [((0.05, 0.045), 0.5), ((0.5, 0.01), 2.0)])
def test_an_order_that_no_scheme_has_is_none_that_runs_tell(differences, order):
    own = own_error([0.04, 0.02, 0.01], [*differences, math.nan])
    assert not own.measured and own.order == pytest.approx(order, abs=0.01)


def test_errors_that_hold_an_estimate_tell_less():
    runs = [run(0.04), run(0.02, noise=1.1), run(0.01)]
    assert math.isnan(Ladder(runs, 2, estimated=True).order.low)
    four = [*runs, run(0.005)]
    plain, estimated = Ladder(four, 2), Ladder(four, 2, estimated=True)
    assert estimated.order.value == plain.order.value and estimated.order.low < plain.order.low
    assert estimated.error(0.0025).high > plain.error(0.0025).high
    assert estimated.floor is None is estimated.prediction and plain.prediction
