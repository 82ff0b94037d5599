"""What loops make of the affine maps of poses (psph.physics.rigid.pose): of places, directions and turns."""

from psph.engine.jit import overload, tuple_of, unrolled
from psph.vectors import Vector, dot


def affine(maps, which: int, a: Vector) -> Vector:
    """m₀ + M a of the affine map ``which`` of some (n, dim, 1 + dim), each component m₀ and its row of M."""
    return tuple(m[0] + dot(tuple(m[1:]), a) for m in maps[which])


@overload(affine)
def _affine(maps, which, a):
    n = range(len(a))
    sums = (
        " + ".join([f"maps[which, {d}, 0]", *(f"maps[which, {d}, {1 + e}] * a[{e}]" for e in n)]) for d in n
    )
    return unrolled("maps, which, a", f"return {tuple_of(sums)}")


def linear(maps, which: int, a: Vector) -> Vector:
    """M a of such a map: what becomes of a direction, whatever the place and the unit of places."""
    return tuple(dot(tuple(m[1:]), a) for m in maps[which])


@overload(linear)
def _linear(maps, which, a):
    n = range(len(a))
    sums = (" + ".join(f"maps[which, {d}, {1 + e}] * a[{e}]" for e in n) for d in n)
    return unrolled("maps, which, a", f"return {tuple_of(sums)}")


def onto(maps, one: int, other: int, a: Vector) -> Vector:
    """A Bᵀ, by rows, of the matrices of two affine maps of some (n, dim, 1 + dim): what ``one`` makes of what
    ``other``, a turn, has made; ``a`` is any vector of the dimension."""
    return tuple(dot(tuple(m[1:]), tuple(n[1:])) for m in maps[one] for n in maps[other])


@overload(onto)
def _onto(maps, one, other, a):
    n = range(len(a))
    sums = (
        " + ".join(f"maps[one, {d}, {1 + f}] * maps[other, {e}, {1 + f}]" for f in n) for d in n for e in n
    )
    return unrolled("maps, one, other, a", f"return {tuple_of(sums)}")
