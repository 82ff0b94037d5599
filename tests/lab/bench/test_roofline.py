"""The ceiling is a ceiling: vectors of multiply-adds, and more memory than caches hold."""

import re

import numba
import numpy as np
import pytest

from psph.engine.jit import FAST
from psph.lab.bench.roofline import CHAINS, LINKS, TERM, measure_ceiling, multiply_add
from psph.parallel.reductions import alone


def test_it_is_positive():
    ceiling = measure_ceiling(alone())
    assert 1e8 < ceiling.bytes_per_second < 1e13
    assert 1e9 < ceiling.flops_per_second < 1e13


def test_every_multiply_add_is_there_and_a_vector():
    loop = numba.njit(fastmath=FAST, error_model="numpy")(multiply_add.py_func)
    loop(np.zeros(64), 1, TERM)
    [assembly] = loop.inspect_asm().values()
    if "vfmadd" not in assembly:
        pytest.skip("a processor without the instructions that this test knows")
    vectors = len(re.findall(r"vfmadd\d+pd[^\n]*[yz]mm", assembly))
    assert vectors >= CHAINS * LINKS


def test_numbers_stay_normal():
    line = np.zeros(64)
    multiply_add(line, 50, TERM)
    plain = np.zeros(2)
    multiply_add.py_func(plain, 50, TERM)
    assert line == pytest.approx(plain[0], rel=1e-12)
    assert 0.1 < abs(line[0]) < 1.0
