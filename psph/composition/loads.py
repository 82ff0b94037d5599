"""What the fluid alone does to a wall or a body: the sum over its neighbours in the fluid; and contacts."""

from typing import Any, NamedTuple

from numba.core import types

from psph.composition import terms
from psph.engine.jit import overload
from psph.vectors import scale, zero_like


class Loads(NamedTuple):
    """A pass that sums the push of the fluid alone, on the groups that are ``loaded`` (groups,).

    ``group`` has the group of each column; ``contacts`` are effects by which solids push each other, which
    count whatever the neighbour.  None in its place: a pass over all particles and neighbours.
    """

    loaded: Any
    group: Any
    contacts: tuple = ()


def is_loaded(loads, k):
    """Whether a pass has a sum for the particle in column ``k``."""
    return loads is None or loads.loaded[loads.group[k]]


@overload(is_loaded)
def _typed_is_loaded(loads, k):
    if isinstance(loads, types.NoneType):
        return lambda loads, k: True
    return lambda loads, k: loads.loaded[loads.group[k]]


def by_fluid(loads, j, coefficient):
    """A neighbour's share of a sum, 0 in a pass of loads unless j is fluid; None stays None."""
    return coefficient if loads is None or coefficient is None else j.is_fluid * coefficient


@overload(by_fluid)
def _typed_by_fluid(loads, j, coefficient):
    if isinstance(loads, types.NoneType) or isinstance(coefficient, types.NoneType):
        return lambda loads, j, coefficient: coefficient
    if isinstance(coefficient, types.BaseTuple):
        return lambda loads, j, coefficient: scale(coefficient, j.is_fluid)
    return lambda loads, j, coefficient: j.is_fluid * coefficient


def by_contact(loads, i, j, pair):
    """Coefficient of x_ij in the acceleration by contacts, 1/s², or None."""
    return None if loads is None else terms.radial(loads.contacts, i, j, pair)


@overload(by_contact)
def _typed_by_contact(loads, i, j, pair):
    if isinstance(loads, types.NoneType):
        return lambda loads, i, j, pair: None
    return lambda loads, i, j, pair: terms.radial(loads.contacts, i, j, pair)


def from_outside(loads, effects, i):
    """Acceleration from outside, m/s²; a load has none of it."""
    return terms.body(effects, i) if loads is None else zero_like(i.position)


@overload(from_outside)
def _typed_from_outside(loads, effects, i):
    if isinstance(loads, types.NoneType):
        return lambda loads, effects, i: terms.body(effects, i)
    return lambda loads, effects, i: zero_like(i.position)
