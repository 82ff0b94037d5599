"""What the fluid alone does to a wall or a body: the sum over its neighbours in the fluid."""

from typing import Any, NamedTuple

from numba.core import types

from psph.composition import terms
from psph.engine.jit import overload
from psph.vectors import add, by_dimension, dot, scale, zero_like

cross = by_dimension(
    lambda a, b, like: (),
    lambda a, b, like: (a[0] * b[1] - a[1] * b[0],),
    lambda a, b, like: (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ),
)
"""(a, b, like) → a × b, about each axis of rotation that the dimension of the vector ``like`` has."""


class Loads(NamedTuple):
    """A pass over the groups that are ``loaded`` (groups,): what it sums as acceleration is the fluid's push.

    ``group`` has the group of each column.  All other sums of these particles are those of every pass.
    """

    loaded: Any
    group: Any


class Pushes(NamedTuple):
    """The same where nothing flows: what it sums as acceleration is the push of all neighbours."""

    loaded: Any
    group: Any


class Unloaded(NamedTuple):
    """The pass over all other groups.  None in its place: one over all groups."""

    loaded: Any
    group: Any


class Among(NamedTuple):
    """The pass over the groups that are ``loaded`` alone, with all that it sums elsewhere."""

    loaded: Any
    group: Any


class Couple(NamedTuple):
    """A sum of a pass of loads: the moment of the load about the particle's own place.

    Σ_j (x_j − x_i)/2 × f_ij, f_ij what ``effects`` give of a fluid neighbour j that is not along the line of
    the pair.  What two particles exchange passes between them, on average halfway: a wall that turns has its
    moment at its face, and not where its particles are.  By mass, m²/s².
    """

    effects: tuple

    def start(self, i):
        """No neighbour yet."""
        return cross(i.position, i.position, i.position)

    def gather(self, total, i, j, pair):
        """Take the push of neighbour j at half the way to it."""
        across = terms.pushed(zero_like(pair.x_ij), pair.u_ij, terms.shear(self.effects, i, j, pair))
        force = terms.added(across, terms.push(self.effects, i, j, pair))
        return add(total, scale(cross(pair.x_ij, force, pair.x_ij), -0.5 * told(j, pair)))

    def finish_value(self, total, i, kernel):
        """The couple, m²/s²."""
        return total


ON_LOADED = (Loads, Pushes)
"""Passes over the groups whose load is asked for: of what comes from outside they sum nothing."""


CHOSEN = (*ON_LOADED, Among)
"""Passes over the groups that are ``loaded`` and no others."""


def _is(kinds, loads) -> bool:
    """Whether the type of ``loads`` is that of one of these ``kinds`` of passes."""
    return getattr(loads, "instance_class", None) in kinds


def is_due(loads, k):
    """Whether a pass has sums for the particle in column ``k``."""
    return loads is None or bool(loads.loaded[loads.group[k]]) == isinstance(loads, CHOSEN)


@overload(is_due)
def _typed_is_due(loads, k):
    if _is(CHOSEN, loads):
        return lambda loads, k: loads.loaded[loads.group[k]]
    if _is((Unloaded,), loads):
        return lambda loads, k: not loads.loaded[loads.group[k]]
    return lambda loads, k: True


def told(j, pair):
    """The part of what neighbour j does that counts as a load: 0 unless j is fluid, and where levels of sizes
    share in it (psph.scene.levels) the share half the way to who bears it, s_j + ∇s_j·(x_i − x_j)/2."""
    if not hasattr(j, "share"):
        return j.is_fluid
    return (j.share + 0.5 * dot(j.share_slope, pair.x_ij)) * j.is_fluid


@overload(told)
def _typed_told(j, pair):
    if "share" in j.instance_class._fields:
        return lambda j, pair: (j.share + 0.5 * dot(j.share_slope, pair.x_ij)) * j.is_fluid
    return lambda j, pair: j.is_fluid


def by_fluid(loads, j, pair, coefficient):
    """A neighbour's part of a sum, in a pass of loads what is :func:`told` of it; None stays None."""
    if not isinstance(loads, Loads) or coefficient is None:
        return coefficient
    part = told(j, pair)
    return scale(coefficient, part) if isinstance(coefficient, tuple) else part * coefficient


@overload(by_fluid)
def _typed_by_fluid(loads, j, pair, coefficient):
    if not _is((Loads,), loads) or isinstance(coefficient, types.NoneType):
        return lambda loads, j, pair, coefficient: coefficient
    if isinstance(coefficient, types.BaseTuple):
        return lambda loads, j, pair, coefficient: scale(coefficient, told(j, pair))
    return lambda loads, j, pair, coefficient: told(j, pair) * coefficient


def completed(loads, effects, reductions, folded, i, force):
    """The acceleration with that by finished sums and from outside, m/s²; a load has none of these."""
    if isinstance(loads, ON_LOADED):
        return force
    return add(add(force, terms.finish_acceleration(reductions, folded, i)), terms.body(effects, i))


@overload(completed)
def _typed_completed(loads, effects, reductions, folded, i, force):
    if _is(ON_LOADED, loads):
        return lambda loads, effects, reductions, folded, i, force: force
    return lambda loads, effects, reductions, folded, i, force: add(
        add(force, terms.finish_acceleration(reductions, folded, i)), terms.body(effects, i)
    )
