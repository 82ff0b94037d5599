"""Least squares f₀ + f₁·t + … of a few terms, the first of them 1, as compiled loops solve them."""

from psph.formula import helper


@helper
def factor(square, flat):
    """The lower half of ``square`` (n, n) becomes its factors LDLᵀ.  Terms of which those before
    them tell all but the part ``flat`` of the first are left out."""
    total = square[0, 0]
    for i in range(len(square)):
        for j in range(i):
            for k in range(j):
                square[i, j] -= square[i, k] * square[k, k] * square[j, k]
            square[i, j] = square[i, j] / square[j, j] if square[j, j] > 0.0 else 0.0
        for k in range(i):
            square[i, i] -= square[i, k] * square[k, k] * square[i, k]
        if square[i, i] <= flat * total:
            square[i, : i + 1] = 0.0


@helper
def solve(square, share, n):
    """``share`` (n,) of the least squares f₀ = share·right of the first ``n`` terms: the first row of the
    inverse of what is ``square`` in factors."""
    for i in range(n):
        share[i] = 1.0 if i == 0 else 0.0
        for j in range(i):
            share[i] -= square[i, j] * share[j]
    for i in range(n - 1, -1, -1):
        share[i] = share[i] / square[i, i] if square[i, i] > 0.0 else 0.0
        for j in range(i + 1, n):
            share[i] -= square[j, i] * share[j]
