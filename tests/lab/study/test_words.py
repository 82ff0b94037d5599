"""Sentences follow from the rows."""

from psph.lab.study.fit import Estimate, Ladder, RunPoint, richardson
from psph.lab.study.words import advice, against_base, ladder_words, limit_words


def ladder(*errors: float) -> Ladder:
    """Runs at 0.04, 0.02, 0.01 m with these errors, their seconds those of 1e-7 s a particle-step."""
    return Ladder(
        [
            RunPoint(0.04 / 2**k, e, 1e-7 * 625 * 4**k * 100 * 2**k, 625 * 4**k, 100 * 2**k)
            for k, e in enumerate(errors)
        ],
        2,
    )


def test_the_price_of_half_the_error():
    first, order, half = ladder_words(ladder(0.16, 0.04, 0.01), "")
    assert first == "1 % costs 0.4 s (spacing 0.01 m)."
    assert order.startswith("the error falls with order 2.00")
    assert "spacing of 0.00707 m, in 2.8 times the time" in half  # √2 finer, to the third power


def test_a_floor_is_said_and_no_spacing_promised_below_it():
    *_, floor = ladder_words(ladder(0.13, 0.07, 0.055), "")
    assert floor == "extrapolated from the last 3 runs, 5 % remains at zero spacing."


def test_four_runs_say_what_three_would_have_predicted():
    words = list(ladder_words(ladder(0.16, 0.04, 0.01, 0.003), ""))
    assert words[3].startswith("the other runs predict 0.25 % in 3.2 s for the finest one")


def test_no_law_no_prediction():
    lines = list(ladder_words(ladder(0.02, 0.01, 0.03), "kernel cubic"))
    assert lines[1].startswith("kernel cubic: the error does not fall steadily: it is smallest at 0.02 m")
    assert not any("half" in line for line in lines)


def test_too_few_runs_leave_the_uncertainty_unknown():
    _, order, _ = ladder_words(ladder(0.16, 0.04), "")
    assert order == "the error falls with order 2.00; its uncertainty is unknown with 2 runs."
    spacings = [0.04, 0.02, 0.01, 0.005]
    values = [3.0 - 7.0 * x**1.5 for x in spacings]
    three = limit_words("mean P", richardson(spacings[:3], values[:3]), values[2], 3)
    # 1.25 (q₀ − q) with q₀ − q = 7·0.01^1.5 = 0.007
    index = "mean P goes to 3 ± 0.00875 (by the grid convergence index) at zero spacing, with order 1.50; "
    assert three.startswith(index)
    values[1] += 1e-4
    four = limit_words("mean P", richardson(spacings, values), values[3], 4)
    assert "unknown" not in four and four.count("±") == 2


def test_a_choice_is_weighed_at_equal_error():
    base = {"status": "done", "seconds": 1.0, "error_l2": 0.04, "space.spacing": 0.02}
    better = base | {"space.kernel": "cubic", "seconds": 1.5, "error_l2": 0.02}
    said = against_base(better, base, "kernel cubic", ladder(0.16, 0.04, 0.01))
    assert said.startswith("kernel cubic takes 1.50 times as long and has 0.50 times the error")
    assert said.endswith("about 0.53 of the time for the same error.")  # 1.5/2^(3/2)
    same = base | {"space.kernel": "cubic", "error_l2": 0.04001}
    assert "has the same error." in against_base(same, base, "kernel cubic", None)
    failed = {"status": "it blew up", "space.kernel": "cubic"}
    assert against_base(failed, base, "kernel cubic", None) == "kernel cubic: it blew up."


def test_advice_can_be_pasted():
    error, time = Estimate(0.01, 0.008, 0.0125), Estimate(42.0, float("nan"), float("nan"))
    lines = list(advice({"space.spacing": 0.01, "space.kernel": "cubic", "precision": "mixed"}, error, time))
    assert lines[0] == (
        "expect an error of 1 % (0.8 % to 1.25 %) in 42 s (too few runs for an uncertainty), "
        "without compiling, with:"
    )
    assert lines[1:] == ['precision = "mixed"', "[space]", "spacing = 0.01", 'kernel = "cubic"']


def test_where_nothing_is_resolved_no_spacing_is_advised():
    *_, last = ladder_words(ladder(4.52, 2.26, 1.13), "")
    assert last.startswith("nothing is resolved yet")
    *_, last = ladder_words(ladder(3.6, 1.8, 0.9), "")
    assert last.startswith("half that error")
