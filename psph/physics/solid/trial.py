"""A law of elasticity that is tried: whether its stress, energy and moduli fit each other."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

SMALL = 1e-4
"""Change of the deformation gradient by which derivatives are taken."""

ALIKE = 1e-3
"""Of the modulus λ + 2μ: what derivatives may differ by."""

ASKEW = ((1.05, 0.04, -0.02, 0.97), (1.05, 0.04, 0.01, -0.02, 0.97, 0.03, 0.02, -0.01, 1.02))
"""Deformation gradients, by rows, at which an energy and a stress are compared."""


def misfit(law: Any) -> str | None:
    """Why a ``law`` cannot be right, in a few words; None where it may be.

    At rest it has no stress, and P grows with F as the moduli λ and μ have it; elsewhere P = ∂ψ/∂F.
    """
    for name in ("moduli", "stress", "across", "energy"):
        if not callable(getattr(law, name, None)):
            return f"has no {name}()"
    try:
        with np.errstate(all="ignore"):
            return next(_misfits(law), None)
    except (ArithmeticError, AttributeError, LookupError, NameError, TypeError, ValueError) as error:
        return f"cannot be tried: {error}"


def _misfits(law: Any) -> Iterator[str]:
    lame, shear = law.moduli()
    if not lame + 2.0 * shear > 0.0:
        return  # which is refused elsewhere
    for f in ASKEW:
        yield from _misfits_at(law, lame, shear, f, round(len(f) ** 0.5))


def _misfits_at(law: Any, lame: float, shear: float, f: tuple[float, ...], d: int) -> Iterator[str]:
    """At rest in so many dimensions, and at F."""
    most, a, rest = lame + 2.0 * shear, (0.0,) * d, tuple(np.eye(d).ravel().tolist())

    def differ(one: float, other: float) -> bool:
        return not abs(one - other) < ALIKE * most

    def pressed(k: int) -> Callable[[tuple[float, ...]], float]:
        return lambda g: law.stress(g, a)[k]

    still = [*law.stress(rest, a), *([law.across(rest, a)] if d == 2 else [])]
    yield from (f"has a stress of {one:.4g} Pa at rest in {d}D" for one in still if differ(one, 0.0))
    wanted = [(0, 0, most), (0, d + 1, lame), (1, 1, shear), (1, d, shear)]
    slopes = [(_slope(pressed(k), rest, by), expected) for by, k, expected in wanted]
    slopes += [(_slope(lambda g: law.across(g, a), rest, 0), lame)] if d == 2 else []
    for found, expected in slopes:
        if differ(found, expected):
            yield (
                f"has moduli() of {lame:.4g} and {shear:.4g} Pa, and its stress at rest in {d}D grows by "
                f"{found:.4g} in the place of {expected:.4g} Pa"
            )
    for k, stress in enumerate(law.stress(f, a)):
        if differ(found := _slope(lambda g: law.energy(g, a), f, k), stress):
            yield f"has a stress of {stress:.4g} Pa where its energy grows by {found:.4g} Pa, in {d}D"


def _slope(of: Callable[[tuple[float, ...]], float], f: tuple[float, ...], k: int) -> float:
    """How much ``of`` grows with the entry ``k`` of F."""
    up, low = ((*f[:k], f[k] + by, *f[k + 1 :]) for by in (SMALL, -SMALL))
    return float((of(up) - of(low)) / (2.0 * SMALL))
