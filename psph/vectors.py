"""Small vectors and symmetric matrices as tuples of numbers, one source for 1D, 2D and 3D.

Every function works on plain tuples in Python and, by the length of the tuple's type, as
straight-line code when compiled: no loop over the axes, no memory.  A symmetric matrix is its rows
from the diagonal on: (xx), (xx, xy, yy), (xx, xy, xz, yy, yz, zz).
"""

from numba.core import types
from numba.extending import overload, register_jitable

Vector = tuple[float, ...]


def _elementwise(component):
    """Compile ``function(a, b)``, written for plain tuples, by recursion over the axes."""
    one = register_jitable(component)

    def attach(function):
        @overload(function)
        def typed(a, b):
            if len(a) == 0:
                return lambda a, b: ()
            if isinstance(b, types.BaseTuple):
                return lambda a, b: (one(a[0], b[0]),) + function(a[1:], b[1:])
            return lambda a, b: (one(a[0], b),) + function(a[1:], b)

        return function

    return attach


@_elementwise(lambda a, b: a + b)
def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return tuple(x + y for x, y in zip(a, b))


@_elementwise(lambda a, b: a - b)
def subtract(a: Vector, b: Vector) -> Vector:
    """a − b."""
    return tuple(x - y for x, y in zip(a, b))


@_elementwise(lambda a, b: a * b)
def scale(a: Vector, factor: float) -> Vector:
    """a · factor."""
    return tuple(x * factor for x in a)


@_elementwise(lambda a, b: a[b])
def at(arrays: tuple, k: int) -> Vector:
    """Component arrays → the vector of particle ``k``."""
    return tuple(array[k] for array in arrays)


def dot(a: Vector, b: Vector) -> float:
    """a · b."""
    return sum(x * y for x, y in zip(a, b))


@overload(dot)
def _dot(a, b):
    if len(a) == 1:
        return lambda a, b: a[0] * b[0]
    return lambda a, b: a[0] * b[0] + dot(a[1:], b[1:])


def zero_like(a: Vector) -> Vector:
    """The zero vector of the same dimension."""
    return tuple(0.0 for _ in a)


@overload(zero_like)
def _zero_like(a):
    if len(a) == 0:
        return lambda a: ()
    return lambda a: (0.0,) + zero_like(a[1:])


def put(arrays: tuple, k: int, a: Vector) -> None:
    """Write the vector ``a`` of particle ``k`` into its component arrays."""
    for array, component in zip(arrays, a):
        array[k] = component


@overload(put)
def _put(arrays, k, a):
    if len(arrays) == 0:
        return lambda arrays, k, a: None

    def write(arrays, k, a):
        arrays[0][k] = a[0]
        put(arrays[1:], k, a[1:])

    return write


def nearest_image(a: Vector, periods: tuple) -> Vector:
    """Difference of positions between nearest periodic images; ``None`` marks an open axis.

    One period at the most is added to x_i − x_j, so that a dummy at +1e30 m stays far.
    """
    return tuple(x if p is None else _wrapped(x, p) for x, p in zip(a, periods))


@register_jitable
def _wrapped(x, period):
    return x - period * round(max(x * (1.0 / period), -1.0))


@overload(nearest_image)
def _nearest_image(a, periods):
    if len(a) == 0:
        return lambda a, periods: ()
    if isinstance(periods[0], types.NoneType):
        return lambda a, periods: (a[0],) + nearest_image(a[1:], periods[1:])
    return lambda a, periods: (_wrapped(a[0], periods[0]),) + nearest_image(a[1:], periods[1:])


def outer(a: Vector) -> Vector:
    """The symmetric matrix a aᵀ."""
    return scale(a, a[0]) + outer(a[1:]) if a else ()


@overload(outer)
def _outer(a):
    if len(a) == 0:
        return lambda a: ()
    return lambda a: scale(a, a[0]) + outer(a[1:])


def _by_dimension(one, two, three):
    """A function of a matrix and more, the last argument a vector that tells the dimension."""

    def function(*args):
        return (one, two, three)[len(args[-1]) - 1](*args)

    @overload(function)
    def typed(*args):
        chosen = register_jitable((one, two, three)[len(args[-1]) - 1])
        return lambda *args: chosen(*args)

    return function


times = _by_dimension(
    lambda m, a: (m[0] * a[0],),
    lambda m, a: (m[0] * a[0] + m[1] * a[1], m[1] * a[0] + m[2] * a[1]),
    lambda m, a: (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[1] * a[0] + m[3] * a[1] + m[4] * a[2],
        m[2] * a[0] + m[4] * a[1] + m[5] * a[2],
    ),
)
"""(m, a) → the vector m a."""

adjugate = _by_dimension(
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

determinant = _by_dimension(
    lambda m, a: m[0],
    lambda m, a: m[0] * m[2] - m[1] * m[1],
    lambda m, a: (
        m[0] * (m[3] * m[5] - m[4] * m[4])
        + m[1] * (m[2] * m[4] - m[1] * m[5])
        + m[2] * (m[1] * m[4] - m[2] * m[3])
    ),
)
"""(m, a) → det(m); ``a`` is any vector of the dimension."""

less_diagonal = _by_dimension(
    lambda m, s, a: (m[0] - s,),
    lambda m, s, a: (m[0] - s, m[1], m[2] - s),
    lambda m, s, a: (m[0] - s, m[1], m[2], m[3] - s, m[4], m[5] - s),
)
"""(m, s, a) → m − s on the diagonal; ``a`` is any vector of the dimension."""
