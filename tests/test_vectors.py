"""Small vectors: the compiled form against the plain one, in 1D, 2D and 3D."""

import numba
import numpy as np
import pytest

from psph import vectors

ENTRIES = [[(0, 0)], [(0, 0), (0, 1), (1, 1)], [(p, q) for p in range(3) for q in range(p, 3)]]
"""Places of a symmetric matrix's numbers, by dimension less one."""

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


@numba.njit
def matrices(m, a):
    return (
        vectors.outer(a),
        vectors.times(m, a),
        vectors.adjugate(m, a),
        (vectors.determinant(m, a),),
        vectors.less_diagonal(m, 2.0, a),
    )


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_symmetric_matrices(dim):
    a, places = A[:dim], tuple(zip(*ENTRIES[dim - 1]))
    full = np.cov(np.random.default_rng(4).normal(size=(dim, 9))).reshape(dim, dim)
    m, one = tuple(full[places].tolist()), np.eye(dim)
    expected = (
        np.outer(a, a)[places],
        full @ a,
        (np.linalg.inv(full) * np.linalg.det(full))[places],
        [np.linalg.det(full)],
        (full - 2.0 * one)[places],
    )
    for compiled, plain, told in zip(matrices(m, a), matrices.py_func(m, a), expected):
        assert compiled == pytest.approx(told) and plain == pytest.approx(told)


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
    for x in np.random.default_rng(1).uniform(-1, 1, 100):
        assert wrap((x,), (1.0,))[0] == -wrap((-x,), (1.0,))[0]
