"""Small vectors and symmetric matrices as tuples of numbers, one source for 1D, 2D and 3D.

Every function works on plain tuples in Python and, by the length of the tuple's type, as
straight-line code when compiled: no loop over the axes, no memory.  A symmetric matrix is its rows
from the diagonal on: (xx), (xx, xy, yy), (xx, xy, xz, yy, yz, zz).
"""

import numpy as np
from numba.core import types

from psph.engine.jit import overload, register_jitable, tuple_of, unrolled

Vector = tuple[float, ...]


def _each(component: str):
    """Compile ``function(a, b)``, written for plain tuples, from the text of its d-th component."""

    def attach(function):
        @overload(function)
        def typed(a, b):
            return unrolled("a, b", f"return {tuple_of(component.format(d=d) for d in range(len(a)))}")

        return function

    return attach


@_each("a[{d}] + b[{d}]")
def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return tuple(x + y for x, y in zip(a, b))


@_each("a[{d}] - b[{d}]")
def subtract(a: Vector, b: Vector) -> Vector:
    """a − b."""
    return tuple(x - y for x, y in zip(a, b))


@_each("a[{d}] * b")
def scale(a: Vector, b: float) -> Vector:
    """a · b."""
    return tuple(x * b for x in a)


@_each("a[{d}] * b[{d}]")
def multiply(a: tuple, b: tuple) -> tuple:
    """The products of the entries."""
    return tuple(x * y for x, y in zip(a, b))


@_each("max(a[{d}] - b[{d}], 0.0)")
def excess(a: tuple, b: tuple) -> tuple:
    """By how much each entry of ``a`` is larger than that of ``b``, or 0."""
    return tuple(max(x - y, 0.0) for x, y in zip(a, b))


def plus_less_last(start: float, a: tuple) -> float:
    """``start`` and all entries of ``a``, the last of them subtracted."""
    *others, last = a
    return sum(others, start) - last


@overload(plus_less_last)
def _typed_plus_less_last(start, a):
    signs = [*"+" * (len(a) - 1), "-"]
    return unrolled("start, a", "return start " + " ".join(f"{s} a[{n}]" for n, s in enumerate(signs)))


@_each("a[{d}][b]")
def at(a: tuple, b: int) -> Vector:
    """Component arrays → the vector of particle ``b``."""
    return tuple(array[b] for array in a)


def along(a: Vector, b: tuple[float | None, ...]) -> float:
    """a · b, where None in ``b`` stands for a zero that costs nothing."""
    return sum(x * y for x, y in zip(a, b) if y is not None)


@overload(along)
def _along(a, b):
    terms = [f"a[{d}] * b[{d}]" for d, kind in enumerate(b) if not isinstance(kind, types.NoneType)]
    return unrolled("a, b", f"return {' + '.join(terms) or '0.0'}")


def dot(a: Vector, b: Vector) -> float:
    """a · b."""
    return sum(x * y for x, y in zip(a, b))


@overload(dot)
def _dot(a, b):
    return unrolled("a, b", f"return {' + '.join(f'a[{d}] * b[{d}]' for d in range(len(a)))}")


def zero_like(a: Vector) -> Vector:
    """The zero vector of the same dimension."""
    return tuple(0.0 for _ in a)


@overload(zero_like)
def _zero_like(a):
    return unrolled("a", f"return {tuple_of('0.0' for _ in a)}")


def put(arrays: tuple, k: int, a: Vector) -> None:
    """Write the vector ``a`` of particle ``k`` into its component arrays."""
    for array, component in zip(arrays, a):
        array[k] = component


@overload(put)
def _put(arrays, k, a):
    return unrolled("arrays, k, a", *(f"arrays[{d}][k] = a[{d}]" for d in range(len(arrays))))


def nearest_image(a: Vector, periods: tuple) -> Vector:
    """Difference of positions between nearest periodic images; ``None`` marks an open axis."""
    return tuple(x if p is None else _wrapped(x, p) for x, p in zip(a, periods))


@register_jitable
def _wrapped(x, period):
    return x - period * round(x * (1.0 / period))


@overload(nearest_image)
def _nearest_image(a, periods):
    parts = (
        f"a[{d}]" if isinstance(period, types.NoneType) else f"wrapped(a[{d}], periods[{d}])"
        for d, period in enumerate(periods)
    )
    return unrolled("a, periods", f"return {tuple_of(parts)}", wrapped=_wrapped)


def inside(a: Vector, lower: tuple, periods: tuple) -> Vector:
    """The periodic image of a place ``a`` between ``lower`` and a period beyond, m, by the same operations as
    those by which a domain takes particles back (psph.parallel.domain)."""
    return tuple(x if p is None else _taken_back(x, low, p) for x, low, p in zip(a, lower, periods))


@register_jitable
def _taken_back(x, low, period):
    x = x - period * np.floor((x - low) / period)
    return low if x >= low + period else x


@overload(inside)
def _inside(a, lower, periods):
    parts = (
        f"a[{d}]" if isinstance(period, types.NoneType) else f"taken_back(a[{d}], lower[{d}], periods[{d}])"
        for d, period in enumerate(periods)
    )
    return unrolled("a, lower, periods", f"return {tuple_of(parts)}", taken_back=_taken_back)


def nearest_to(a: Vector, b: Vector, periods: tuple) -> Vector:
    """The periodic image of ``a`` that is nearest to ``b``; exactly a where it is a itself."""
    return tuple(x if p is None else _moved(x, y, p) for x, y, p in zip(a, b, periods))


@register_jitable
def _moved(x, y, period):
    return x - period * np.rint((x - y) / period)


@overload(nearest_to)
def _nearest_to(a, b, periods):
    parts = (
        f"a[{d}]" if isinstance(period, types.NoneType) else f"moved(a[{d}], b[{d}], periods[{d}])"
        for d, period in enumerate(periods)
    )
    return unrolled("a, b, periods", f"return {tuple_of(parts)}", moved=_moved)


def outer(a: Vector) -> Vector:
    """The symmetric matrix a aᵀ."""
    return scale(a, a[0]) + outer(a[1:]) if a else ()


@overload(outer)
def _outer(a):
    parts = (f"a[{d}] * a[{e}]" for d in range(len(a)) for e in range(d, len(a)))
    return unrolled("a", f"return {tuple_of(parts)}")


def dyad(a: Vector, b: Vector) -> Vector:
    """The matrix a bᵀ, by rows."""
    return tuple(x * y for x in a for y in b)


@overload(dyad)
def _dyad(a, b):
    parts = (f"a[{d}] * b[{e}]" for d in range(len(a)) for e in range(len(b)))
    return unrolled("a, b", f"return {tuple_of(parts)}")


def by_dimension(one, two, three):
    """A function of a matrix and more, the last argument a vector that tells the dimension."""

    def function(*args):
        return (one, two, three)[len(args[-1]) - 1](*args)

    @overload(function)
    def typed(*args):
        chosen = register_jitable((one, two, three)[len(args[-1]) - 1])
        return lambda *args: chosen(*args)

    return function


times = by_dimension(
    lambda m, a: (m[0] * a[0],),
    lambda m, a: (m[0] * a[0] + m[1] * a[1], m[1] * a[0] + m[2] * a[1]),
    lambda m, a: (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[1] * a[0] + m[3] * a[1] + m[4] * a[2],
        m[2] * a[0] + m[4] * a[1] + m[5] * a[2],
    ),
)
"""(m, a) → the vector m a."""

adjugate = by_dimension(
    lambda m, a: (1.0,),
    lambda m, a: (m[2], -m[1], m[0]),
    lambda m, a: (
        m[3] * m[5] - m[4] * m[4],
        m[2] * m[4] - m[1] * m[5],
        m[1] * m[4] - m[2] * m[3],
        m[0] * m[5] - m[2] * m[2],
        m[1] * m[2] - m[0] * m[4],
        m[0] * m[3] - m[1] * m[1],
    ),
)
"""(m, a) → the symmetric matrix that is det(m) m⁻¹; ``a`` is any vector of the dimension."""

determinant = by_dimension(
    lambda m, a: m[0],
    lambda m, a: m[0] * m[2] - m[1] * m[1],
    lambda m, a: (
        m[0] * (m[3] * m[5] - m[4] * m[4])
        + m[1] * (m[2] * m[4] - m[1] * m[5])
        + m[2] * (m[1] * m[4] - m[2] * m[3])
    ),
)
"""(m, a) → det(m); ``a`` is any vector of the dimension."""

less_diagonal = by_dimension(
    lambda m, s, a: (m[0] - s,),
    lambda m, s, a: (m[0] - s, m[1], m[2] - s),
    lambda m, s, a: (m[0] - s, m[1], m[2], m[3] - s, m[4], m[5] - s),
)
"""(m, s, a) → m − s on the diagonal; ``a`` is any vector of the dimension."""

symmetric_part = by_dimension(
    lambda m, a: (m[0],),
    lambda m, a: (m[0], 0.5 * (m[1] + m[2]), m[3]),
    lambda m, a: (m[0], 0.5 * (m[1] + m[3]), 0.5 * (m[2] + m[6]), m[4], 0.5 * (m[5] + m[7]), m[8]),
)
"""(m, a) → (m + mᵀ)/2 of a matrix by rows; ``a`` is any vector of the dimension."""

skew_part = by_dimension(
    lambda m, a: (0.0,),
    lambda m, a: (0.0, 0.5 * (m[1] - m[2]), 0.5 * (m[2] - m[1]), 0.0),
    lambda m, a: (
        0.0,
        0.5 * (m[1] - m[3]),
        0.5 * (m[2] - m[6]),
        0.5 * (m[3] - m[1]),
        0.0,
        0.5 * (m[5] - m[7]),
        0.5 * (m[6] - m[2]),
        0.5 * (m[7] - m[5]),
        0.0,
    ),
)
"""(m, a) → (m − mᵀ)/2 of a matrix by rows, by rows; ``a`` is any vector of the dimension."""
transposed = by_dimension(
    lambda m, a: (m[0],),
    lambda m, a: (m[0], m[2], m[1], m[3]),
    lambda m, a: (m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]),
)
"""(m, a) → mᵀ of a matrix by rows; ``a`` is any vector of the dimension."""

matrix_product = by_dimension(
    lambda m, s, a: (m[0] * s[0],),
    lambda m, s, a: (
        m[0] * s[0] + m[1] * s[1],
        m[0] * s[1] + m[1] * s[2],
        m[2] * s[0] + m[3] * s[1],
        m[2] * s[1] + m[3] * s[2],
    ),
    lambda m, s, a: (
        m[0] * s[0] + m[1] * s[1] + m[2] * s[2],
        m[0] * s[1] + m[1] * s[3] + m[2] * s[4],
        m[0] * s[2] + m[1] * s[4] + m[2] * s[5],
        m[3] * s[0] + m[4] * s[1] + m[5] * s[2],
        m[3] * s[1] + m[4] * s[3] + m[5] * s[4],
        m[3] * s[2] + m[4] * s[4] + m[5] * s[5],
        m[6] * s[0] + m[7] * s[1] + m[8] * s[2],
        m[6] * s[1] + m[7] * s[3] + m[8] * s[4],
        m[6] * s[2] + m[7] * s[4] + m[8] * s[5],
    ),
)
"""(m, s, a) → the matrix m s by rows, of a matrix by rows and a symmetric one."""

norm_squared = by_dimension(
    lambda m, a: m[0] * m[0],
    lambda m, a: m[0] * m[0] + 2.0 * (m[1] * m[1]) + m[2] * m[2],
    lambda m, a: (m[0] * m[0] + m[3] * m[3] + m[5] * m[5]) + 2.0 * (m[1] * m[1] + m[2] * m[2] + m[4] * m[4]),
)
"""(m, a) → the sum of the squares of all entries of m; ``a`` is any vector of the dimension."""

transposed_product = by_dimension(
    lambda m, n, a: (m[0] * n[0],),
    lambda m, n, a: (
        m[0] * n[0] + m[2] * n[2],
        0.5 * (m[0] * n[1] + m[2] * n[3] + m[1] * n[0] + m[3] * n[2]),
        m[1] * n[1] + m[3] * n[3],
    ),
    lambda m, n, a: (
        m[0] * n[0] + m[3] * n[3] + m[6] * n[6],
        0.5 * (m[0] * n[1] + m[3] * n[4] + m[6] * n[7] + m[1] * n[0] + m[4] * n[3] + m[7] * n[6]),
        0.5 * (m[0] * n[2] + m[3] * n[5] + m[6] * n[8] + m[2] * n[0] + m[5] * n[3] + m[8] * n[6]),
        m[1] * n[1] + m[4] * n[4] + m[7] * n[7],
        0.5 * (m[1] * n[2] + m[4] * n[5] + m[7] * n[8] + m[2] * n[1] + m[5] * n[4] + m[8] * n[7]),
        m[2] * n[2] + m[5] * n[5] + m[8] * n[8],
    ),
)
"""(m, n, a) → the symmetric part of mᵀ n, of two matrices by rows; ``a`` is any vector of the dimension."""

product_transposed = by_dimension(
    lambda m, n, a: (m[0] * n[0],),
    lambda m, n, a: (
        m[0] * n[0] + m[1] * n[1],
        0.5 * (m[0] * n[2] + m[1] * n[3] + m[2] * n[0] + m[3] * n[1]),
        m[2] * n[2] + m[3] * n[3],
    ),
    lambda m, n, a: (
        m[0] * n[0] + m[1] * n[1] + m[2] * n[2],
        0.5 * (m[0] * n[3] + m[1] * n[4] + m[2] * n[5] + m[3] * n[0] + m[4] * n[1] + m[5] * n[2]),
        0.5 * (m[0] * n[6] + m[1] * n[7] + m[2] * n[8] + m[6] * n[0] + m[7] * n[1] + m[8] * n[2]),
        m[3] * n[3] + m[4] * n[4] + m[5] * n[5],
        0.5 * (m[3] * n[6] + m[4] * n[7] + m[5] * n[8] + m[6] * n[3] + m[7] * n[4] + m[8] * n[5]),
        m[6] * n[6] + m[7] * n[7] + m[8] * n[8],
    ),
)
"""(m, n, a) → the symmetric part of m nᵀ, of two matrices by rows; ``a`` is any vector of the dimension."""

applied = by_dimension(
    lambda m, a: (m[0] * a[0],),
    lambda m, a: (m[0] * a[0] + m[1] * a[1], m[2] * a[0] + m[3] * a[1]),
    lambda m, a: (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
        m[6] * a[0] + m[7] * a[1] + m[8] * a[2],
    ),
)
"""(m, a) → the vector m a, of a matrix by rows."""

cofactor = by_dimension(
    lambda m, a: (1.0,),
    lambda m, a: (m[3], -m[2], -m[1], m[0]),
    lambda m, a: (
        m[4] * m[8] - m[5] * m[7],
        m[5] * m[6] - m[3] * m[8],
        m[3] * m[7] - m[4] * m[6],
        m[2] * m[7] - m[1] * m[8],
        m[0] * m[8] - m[2] * m[6],
        m[1] * m[6] - m[0] * m[7],
        m[1] * m[5] - m[2] * m[4],
        m[2] * m[3] - m[0] * m[5],
        m[0] * m[4] - m[1] * m[3],
    ),
)
"""(m, a) → det(m) m⁻ᵀ of a matrix by rows; ``a`` is any vector of the dimension."""

first_row = by_dimension(
    lambda m, a: (m[0],),
    lambda m, a: (m[0], m[1]),
    lambda m, a: (m[0], m[1], m[2]),
)
"""(m, a) → the first row of a matrix; ``a`` is any vector of the dimension."""

trace = by_dimension(
    lambda m, a: m[0],
    lambda m, a: m[0] + m[2],
    lambda m, a: m[0] + m[3] + m[5],
)
"""(m, a) → the trace of a symmetric matrix; ``a`` is any vector of the dimension."""
