"""Small vectors: the compiled form against the plain one, in 1D, 2D and 3D."""

import numba
import numpy as np
import pytest

from psph import vectors

A, B = (0.7, -1.1, 2.3), (1.9, 0.4, -0.6)


@numba.njit
def every(a, b):
    return (
        vectors.add(a, b),
        vectors.subtract(a, b),
        vectors.scale(a, 3.0),
        vectors.dot(a, b),
        vectors.zero_like(a),
    )


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_compiled_is_plain(dim):
    a, b = A[:dim], B[:dim]
    for compiled, plain in zip(every(a, b), every.py_func(a, b)):
        assert compiled == pytest.approx(plain)


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_arrays_of_components(dim):
    @numba.njit
    def move(arrays, k, a):
        vectors.put(arrays, k, vectors.add(vectors.at(arrays, k), a))

    for run in (move, move.py_func):
        arrays = tuple(np.arange(4.0) + d for d in range(dim))
        run(arrays, 2, A[:dim])
        assert [x[2] for x in arrays] == [2.0 + d + A[d] for d in range(dim)]
        assert [x[1] for x in arrays] == [1.0 + d for d in range(dim)]


@numba.njit
def image(a, periods):
    return vectors.nearest_image(a, periods)


@pytest.mark.parametrize("compiled", (True, False))
def test_nearest_image(compiled):
    wrap = image if compiled else image.py_func
    assert wrap((0.9, 0.9), (1.0, None)) == pytest.approx((-0.1, 0.9))
    assert wrap((-0.9, 0.2), (1.0, 1.0)) == pytest.approx((0.1, 0.2))
    assert wrap((0.4,), (1.0,)) == (0.4,)
    assert wrap((-1e30,), (1.0,))[0] < -1e29  # x_ij of the dummy, which stays far
    for x in np.random.default_rng(1).uniform(-1, 1, 100):
        assert wrap((x,), (1.0,))[0] == -wrap((-x,), (1.0,))[0]
