"""Solve symmetric systems some rows of which say the same, by L D Lᵀ."""

from psph.engine.jit import elementwise

SHARED = 1e-10
"""Part of its answer to itself that is left of a row which says what others do: it bears nothing."""


@elementwise
def factored(matrix):
    """L below, and D on the diagonal, of the ``matrix`` (m, m) = L D Lᵀ; zeros in D of rows that say
    nothing new.  Other units change no bit of it but by their powers of two."""
    a = matrix.copy()
    for k in range(len(a)):
        if not a[k, k] > SHARED * matrix[k, k]:
            a[k, k] = 0.0
            continue
        for i in range(k + 1, len(a)):
            factor = a[i, k] / a[k, k]
            for j in range(k + 1, i + 1):
                a[i, j] -= factor * a[j, k]
        for i in range(k + 1, len(a)):
            a[i, k] /= a[k, k]
    return a


@elementwise
def solved(factors, rates):
    """x (m,) with L D Lᵀ x = ``rates``; zeros where D is."""
    x = rates.copy()
    for k in range(len(x)):
        if factors[k, k] > 0.0:
            for i in range(k + 1, len(x)):
                x[i] -= factors[i, k] * x[k]
            x[k] /= factors[k, k]
        else:
            x[k] = 0.0
    for k in range(len(x) - 1, -1, -1):
        if factors[k, k] > 0.0:
            for i in range(k + 1, len(x)):
                x[k] -= factors[i, k] * x[i]
    return x
