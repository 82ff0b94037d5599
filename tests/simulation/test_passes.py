"""Which sums are taken in which order, and what travels between them."""

from typing import NamedTuple

import pytest

from psph.composition.trial import Reads
from psph.fields import PRESSURE, Field
from psph.simulation.passes import SumsInACircle, make_passes

A, B, C = (Field(name, "1", f"the sum {name}") for name in "abc")
STORED = ("position", "predicted_velocity", "mass", "pressure", "specific_volume", "a", "b", "c")


class Called(NamedTuple):
    """An effect, and what its formulas read."""

    effect: object
    reads: Reads


def effect(writes, in_sum=(), in_rates=(), neighbour=(), **marks):
    """An effect that sums a field from some fields, and reads others in its rates."""
    kind = type("Summed", (), {"start": None, "writes": writes, **marks})
    every = frozenset((*in_sum, *in_rates))
    return Called(kind(), Reads(every, frozenset(neighbour), frozenset(), frozenset(in_sum), every))


def passes_of(*called, gather_every=1):
    seen_as = lambda name: name.replace("velocity", "predicted_velocity")
    return make_passes(called, STORED, seen_as, gather_every)


def stores(passes):
    return [one.stores for one in passes]


def test_a_sum_that_only_the_particle_itself_reads_needs_no_pass():
    [only] = passes_of(effect(A))
    assert only.gives_rates and only.stores == ("a",) and only.brought == ()


def test_a_sum_that_pairs_read_comes_before_and_travels():
    first, last = passes_of(effect(A, in_rates="a", neighbour="a"))
    assert (first.gives_rates, last.gives_rates) == (False, True)
    assert first.stores == ("a",) and last.stores == () and last.brought == ("a",)


def test_an_effect_may_fill_several_fields_with_one_sum():
    both = effect((A, B), in_rates="ab", neighbour="ab")
    first, last = passes_of(both)
    assert first.stores == (("a", "b"),) and len(first.reductions) == 1
    assert first.written == {"a", "b"} and last.stores == () and last.brought == ("a", "b")
    [only] = passes_of(effect((A, B), in_rates="ab", neighbour="ab", lagged=True))
    assert only.stores == (("a", "b"),) and only.brought == ()


def test_a_pressure_that_a_pass_tells_settles_the_density_and_travels_twice():
    """What it reads of a neighbour is that of the step; what it writes goes to the ghosts once more."""
    tells = effect(PRESSURE, in_sum=("pressure",), in_rates=("pressure",), neighbour=("pressure",))
    reads = effect(A, in_rates=("specific_volume",), neighbour=("specific_volume",), lagged=True)
    first, last = passes_of(tells, reads)
    assert first.settles and not last.settles and first.stores == ("pressure",)
    assert first.written == {"pressure", "specific_volume"}
    assert first.brought == () and set(last.brought) == {"pressure", "specific_volume"}


def test_forces_of_two_passes_are_summed_on_what_moves_alone():
    """Unless a sum beside them does more than displace, or is read of a neighbour."""
    displaces = {"displacement": None, "lagged": True}

    def last(*called, midway=True):
        return make_passes(called, STORED, lambda name: name, midway=midway)[-1]

    assert last(effect(A, **displaces)).free_only
    assert not last(effect(A, **displaces), midway=False).free_only
    assert not last(effect(A, lagged=True)).free_only
    reads = effect(A, in_rates="a", neighbour="a", **displaces)
    for where in ("beside", "in_density_rate"):
        assert not last(reads._replace(reads=reads.reads._replace(**{where: frozenset("a")}))).free_only


def test_what_is_read_of_the_particle_alone_does_not_travel():
    _, last = passes_of(effect(A, in_rates="a"))
    assert last.brought == () and "a" not in last.neighbour_fields


def test_one_that_is_content_with_the_step_before_needs_no_pass():
    [only] = passes_of(effect(A, in_rates="a", neighbour="a", lagged=True))
    assert only.stores == ("a",) and only.brought == () and "a" in only.neighbour_fields


def test_sums_of_sums_come_one_after_the_other_and_others_together():
    b, a, c = effect(B, in_sum="a", in_rates="b"), effect(A), effect(C, in_rates="c")
    assert stores(passes_of(b, a, c)) == [("a", "c"), ("b",), ()]


def test_sums_in_a_circle_are_refused():
    with pytest.raises(SumsInACircle, match="lagged = True"):
        passes_of(effect(A, in_sum="b"), effect(B, in_sum="a"))


def test_a_pass_may_run_in_every_third_step():
    first, second, last = passes_of(effect(A, in_rates="a", every=3), effect(B, in_rates="b"))
    by_field = {one.stores: one for one in (first, second)}
    assert [by_field[("a",)].due(n) for n in range(4)] == [True, False, False, True]
    assert all(by_field[("b",)].due(n) and last.due(n) for n in range(4))


SLOW = (
    effect(A, in_rates="a", neighbour="a", lagged=True, slow=True),
    effect(B, in_sum="a", in_rates="b", lagged=True, slow=True),
    effect(C, in_rates="c", lagged=True),
)


def test_what_changes_slowly_may_be_gathered_in_every_fifth_step_together():
    """One that reads another's sum has it as it was five steps before; what is not slow stays."""
    seldom, last = passes_of(*SLOW, gather_every=5)
    assert (seldom.stores, last.stores) == (("a", "b"), ("c",))
    assert [seldom.due(n) for n in range(6)] == [True, False, False, False, False, True]
    assert last.brought == ("a",) and last.due(1)


def test_what_changes_slowly_comes_with_the_rates_unless_told():
    [only] = passes_of(*SLOW)
    assert only.stores == ("a", "b", "c") and only.brought == ()


def test_a_rate_of_a_field_that_evolves_is_summed_with_the_rates():
    stress = Field("stress", "Pa", "stress", evolves=True)
    [only] = passes_of(effect(stress, in_rates=("stress",), neighbour=("stress",)))
    assert only.stores == ("stress_rate",)
