"""Lanes against numpy: operators, choices, records turned, sums folded."""

import math

import numba
import numpy as np
import pytest

from psph.engine import simd
from psph.engine.jit import FAST
from psph.engine.simd import sums

compiled = numba.njit(fastmath=FAST, error_model="numpy")
ENTRIES = 8


@pytest.fixture
def records():
    return np.random.default_rng(3).uniform(0.1, 2.0, (50, 4))


@pytest.fixture
def lists():
    return np.random.default_rng(4).integers(0, 50, 64).astype(np.uint32)


def summed(formula, count=2):
    """A compiled function: the sum of ``formula(a, b)`` over listed records."""
    turn, one = simd.turning(count), compiled(formula)

    @compiled
    def run(table, lists):
        found = simd.spread(0.0, table)
        for n in range(np.uint64(0), np.uint64(ENTRIES), simd.width_of(table)):
            numbers = turn(table, lists, n)
            found += one(numbers[0], numbers[1])
        return simd.total(found)

    return run


@pytest.mark.parametrize(
    "formula, numpys",
    [
        (lambda a, b: a + b, None),
        (lambda a, b: 3.0 - a * b + 2, None),
        (lambda a, b: -a / b, None),
        (lambda a, b: 1.0 / (+a), None),
        (lambda a, b: a**5 + b**1, None),
        (lambda a, b: math.sqrt(a) * math.exp(-b), lambda a, b: np.sqrt(a) * np.exp(-b)),
        (lambda a, b: np.sqrt(a) * np.exp(-b), None),
        (lambda a, b: abs(a - b), None),
        (lambda a, b: round(a * 3.0), np.vectorize(lambda a, b: round(a * 3.0))),
        (lambda a, b: max(a, b) + min(a, 0.7), lambda a, b: np.maximum(a, b) + np.minimum(a, 0.7)),
        (lambda a, b: max(1.0 - a, 0), lambda a, b: np.maximum(1.0 - a, 0)),
        (lambda a, b: simd.where(a < b, a, 5.0), lambda a, b: np.where(a < b, a, 5.0)),
        (lambda a, b: simd.where(a >= 1.0, 0.0, b), lambda a, b: np.where(a >= 1.0, 0.0, b)),
        (lambda a, b: simd.where(a > b, 1.0, 2.0), lambda a, b: np.where(a > b, 1.0, 2.0)),
        (lambda a, b: simd.where(a <= b, a, b), np.minimum),
        (lambda a, b: simd.where(len((1, 2)) > 1, a, 5.0), lambda a, b: a),  # the same for all lanes
    ],
)
def test_formulas(records, lists, formula, numpys):
    a, b = records[lists[:ENTRIES], :2].T
    expected = (numpys or formula)(a, b).sum()
    assert summed(formula)(records, lists) == pytest.approx(expected, rel=1e-14)


def test_a_choice_of_plain_numbers_is_a_plain_number():
    assert simd.where(True, 1.0, 2.0) == 1.0
    assert compiled(lambda c: simd.where(c > 0.0, c, 7.0))(-1.0) == 7.0


@pytest.mark.parametrize("count", [1, 3, 4, 6, 8, 9])
def test_records_are_turned(lists, count):
    width = -(-count // simd.GROUP) * simd.GROUP
    table = np.arange(50.0 * width).reshape(50, width)
    turn = simd.turning(count)
    lane = sums._first

    @compiled
    def first_of_each(table, lists, entry):
        return lane(turn(table, lists, np.uint64(entry)))

    for entry in (0, 1, 9):
        assert first_of_each(table, lists, entry) == tuple(table[lists[entry], :count])


def test_eight_doubles_become_singles(records):
    @compiled
    def write(into, numbers):
        simd.put_consecutive(into, np.uint64(3), simd.narrowed(simd.eight(numbers, np.uint64(2)) * 3.0))

    into, numbers = np.zeros(32, np.float32), records.ravel()
    write(into, numbers)
    written = slice(3, 3 + simd.EIGHT)
    assert (into[written] == (3.0 * numbers[2 : 2 + simd.EIGHT]).astype(np.float32)).all()
    assert not np.delete(into, written).any()


def test_set_bits_are_counted():
    counted = compiled(lambda number: simd.set_bits(np.uint64(number)))
    for number in (0, 1, 0b1011, 2**62 + 2**32):
        assert counted(number) == simd.set_bits(number) == bin(number).count("1")


def test_a_sum_is_folded_by_its_own_join(records, lists):
    turn = simd.turning(2)

    @compiled
    def join(scale, a, b):
        return min(a[0], b[0]), (a[1][0] + scale * b[1][0],)

    @compiled
    def folded(table, lists):
        numbers = turn(table, lists, np.uint64(0))
        return simd.fold(join, 1.0, (numbers[0], (numbers[1],)))

    a, b = records[lists[: simd.WIDTH], :2].T
    lowest, (total,) = folded(records, lists)
    assert lowest == a.min() and total == pytest.approx(b.sum(), rel=1e-15)


def test_a_loop_of_lanes_uses_whole_registers(records, lists):
    total = summed(lambda a, b: a * b + 1.0)
    total(records, lists)
    [assembly] = total.inspect_asm().values()
    assert "mulpd" in assembly or "fmadd" in assembly


def test_a_branch_on_lanes_is_refused(records, lists):
    with pytest.raises(numba.TypingError):
        summed(lambda a, b: a if a > b else b)(records, lists)
