"""A pair of particles as formulas see it: two views and the geometry between them."""

import itertools
from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import turning, where
from psph.smoothing import slope_over_r, weight
from psph.vectors import at, dot, subtract

FOLDED = True
"""Stands for ``is_fluid`` in a view of neighbours whose specific volume is negative but in fluids."""


class Pair(NamedTuple):
    """Geometry of an ordered pair; what no effect reads is not computed."""

    x_ij: Any = None
    """x_i − x_j, m, nearest periodic image."""
    u_ij: Any = None
    """u_i − u_j, m/s."""
    r2: Any = None
    """|x_ij|², m²."""
    r: Any = None
    """|x_ij|, m."""
    inverse_r: Any = None
    """1/|x_ij|, 1/m."""
    u_dot_x: Any = None
    """u_ij·x_ij, m²/s."""
    w: Any = None
    """W_ij, 1/m^d."""
    dw_r: Any = None
    """W′(r)/r, so that ∇W_ij = dw_r x_ij; negative inside the support, zero outside."""
    m_dw_r: Any = None
    """m_j W′(r)/r: what neighbour j weighs in a sum over gradients.  All such sums share it."""


PAIR_VECTORS = ("x_ij", "u_ij")
"""Entries of a pair with a number for each axis."""


def take(view, k: int):
    """The values of particle ``k`` of a view (psph.fields.view_of) of all."""
    return type(view)(
        *(
            at(entry, k) if isinstance(entry, tuple) else entry[k] if isinstance(entry, np.ndarray) else entry
            for entry in view
        )
    )


@overload(take)
def _typed_take(view, k):
    parts = (
        tuple_of(f"view.{name}[{d}][k]" for d in range(len(kind)))
        if isinstance(kind, types.BaseTuple)
        else f"view.{name}[k]"
        if isinstance(kind, types.Array)
        else f"view.{name}"
        for name, kind in zip(view.instance_class._fields, view.types)
    )
    return unrolled("view, k", f"return View{tuple_of(parts)}", View=view.instance_class)


def fetch(view, records, lists, entry: int):
    """The values of the neighbours ``lists[entry]`` and following, as lanes.

    Arrays of ``view`` say which quantities the records hold, in this order.
    """
    left = list(records[lists[entry]])
    found = type(view)(
        *(
            tuple(left.pop(0) for _ in entry)
            if isinstance(entry, tuple)
            else left.pop(0)
            if isinstance(entry, np.ndarray)
            else entry
            for entry in view
        )
    )
    if getattr(found, "is_fluid", None) is not FOLDED:
        return found
    signed = found.specific_volume
    return found._replace(specific_volume=abs(signed), is_fluid=where(signed < 0.0, 0.0, 1.0))


@overload(fetch)
def _typed_fetch(view, records, lists, entry):
    places, names = itertools.count(), view.instance_class._fields
    parts = {
        name: tuple_of(f"numbers[{next(places)}]" for _ in kind)
        if isinstance(kind, types.BaseTuple)
        else f"numbers[{next(places)}]"
        if isinstance(kind, types.Array)
        else f"view.{name}"
        for name, kind in zip(names, view.types)
    }
    if "is_fluid" in names and isinstance(view.types[names.index("is_fluid")], types.Boolean):
        signed = parts["specific_volume"]
        parts |= {"specific_volume": f"abs({signed})", "is_fluid": f"where({signed} < 0.0, 0.0, 1.0)"}
    return unrolled(
        "view, records, lists, entry",
        "numbers = turn(records, lists, entry)",
        f"return View{tuple_of(parts.values())}",
        View=view.instance_class,
        turn=turning(next(places)),
        where=where,
    )


@register_jitable
def geometry(kernel, x_ij, softening, i, j):
    """Pair of the particle views ``i`` and ``j``, ``x_ij`` m apart; ``softening`` (m²) keeps r from zero."""
    u_ij = subtract(i.velocity, j.velocity)
    r2 = dot(x_ij, x_ij) + softening
    r = np.sqrt(r2)
    inverse_r = 1.0 / r
    dw_r = slope_over_r(kernel, r, inverse_r)
    return Pair(x_ij, u_ij, r2, r, inverse_r, dot(u_ij, x_ij), weight(kernel, r), dw_r, j.mass * dw_r)
