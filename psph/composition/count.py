"""Operations of a pair: its formulas are written down in a trial call, and counted.

What compiled code does once a particle is not counted: only operations on something of the
neighbour.  The same operation on the same numbers counts once, and what no sum uses not at all.
"""

import operator
from collections.abc import Iterable, Mapping
from typing import Any

from psph.composition import terms
from psph.composition.pair import geometry
from psph.composition.terms import added, pushed
from psph.fields import Field, view_of
from psph.vectors import subtract

TOWARDS = {"velocity": -1.0}
"""Factor of an entry's components, else 1: so the pair of the trial approaches."""

APART = 0.5
"""Distance of the pair over h: inside every piece of every kernel."""


def flops_per_pair(
    effects: tuple,
    reductions: tuple,
    kernel,
    seen: Iterable[Field],
    shared: Iterable[str],
    periods: tuple,
    gives: tuple = ("acceleration", "density_rate"),
) -> int:
    """Additions, multiplications, divisions, roots and exponentials of an ordered pair.

    ``effects`` and ``reductions`` as the pair loop has them; ``seen`` are the fields that formulas
    read, ``shared`` names those that all particles have in common; ``periods`` has one entry for each
    dimension; a pass ``gives`` an acceleration and a rate of density, or None in the place of one.
    Comparisons, minima and a change of sign count nothing, nor does the search for the nearest image.
    """
    trace = _Trace()
    known = {name: trace.leaf(1.0, False) for name in shared}
    apart = APART / kernel.inverse_h / len(periods) ** 0.5
    i = _view(trace, seen, len(periods), known, apart, varies=False)
    j = _view(trace, seen, len(periods), known, 0.0, varies=True)
    kernel, effects, reductions = (trace.parameters(x) for x in (kernel, effects, reductions))
    x_ij = subtract(i.position, j.position)
    pair = geometry(kernel, x_ij, trace.leaf(0.0, False), i, j)
    running = trace.running((0.0, (0.0,) * len(periods), terms.start(reductions, i)))
    rate, a, totals = running
    rate = rate + terms.density_rate(effects, i, j, pair)
    a = pushed(a, pair.x_ij, terms.radial(effects, i, j, pair))
    a = pushed(a, pair.u_ij, terms.shear(effects, i, j, pair))
    a = added(a, terms.push(effects, i, j, pair))
    totals = terms.gather_each(reductions, totals, i, j, pair)
    return trace.operations((*(one for one, told in zip((a, rate), gives) if told), totals))


def flops_of(formula, kernel, fields: Mapping[str, tuple[float, ...]], shared: Mapping[str, float]) -> int:
    """Operations of ``formula(kernel, i, j)`` on something of the neighbour j, and of the sum that takes it.

    ``fields`` are what is read of a particle, with the components that i has beyond j; ``shared`` what all
    have.
    """
    trace = _Trace()
    known = {name: trace.leaf(value, False) for name, value in shared.items()}
    i, j = (
        view_of((*fields, *known))(
            *(tuple(trace.leaf(x * share, varies) for x in values) for values in fields.values()),
            *known.values(),
        )
        for share, varies in ((1.0, False), (0.0, True))
    )
    found = formula(trace.parameters(kernel), i, j)
    sums = trace.running((0.0,) * len(found))
    return trace.operations(tuple(a + b for a, b in zip(sums, found)))


def _view(trace: "_Trace", seen, dimensions: int, known: dict, apart: float, varies: bool):
    """The view of one particle of the pair; positions lie ``apart`` m from zero on every axis."""

    def entry(field: Field):
        if field.name in known:
            return known[field.name]
        if field.composed:
            value = TOWARDS.get(field.name, 1.0) * apart
            return tuple(trace.leaf(value, varies) for _ in range(field.width(dimensions)))
        return trace.leaf(0.5 if varies else 1.0, varies)

    return view_of(tuple(field.name for field in seen))(*map(entry, seen))


class _Number:
    """A number that knows how it came about: ``made`` of (operation, operands), or a leaf."""

    def __init__(self, trace: "_Trace", made: tuple, value: float, varies: bool):
        self.trace, self.made, self.value, self.varies = trace, made, value, varies

    def __add__(self, other):
        return self if _is_zero(other) else self.trace.note(operator.add, self, other)

    def __sub__(self, other):
        return self if _is_zero(other) else self.trace.note(operator.sub, self, other)

    def __rsub__(self, other):
        return -self if _is_zero(other) else self.trace.note(operator.sub, other, self)

    def __mul__(self, other):
        return 0.0 if _is_zero(other) else self.trace.note(operator.mul, self, other)

    def __truediv__(self, other):
        return self.trace.note(operator.truediv, self, other)

    def __rtruediv__(self, other):
        return self.trace.note(operator.truediv, other, self)

    def __pow__(self, exponent: int):
        """A whole power, by repeated squares as the compiler does it."""
        power, square = None, self
        while exponent:
            if exponent & 1:
                power = square if power is None else power * square
            exponent >>= 1
            square = square * square if exponent else square
        return power

    def __neg__(self):
        return self.trace.note(operator.neg, self)

    def __abs__(self):
        return self.trace.note(operator.abs, self)

    def sqrt(self):
        """What ``np.sqrt`` asks of an object."""
        return self.trace.note(lambda x: x**0.5, self, name="sqrt")

    def exp(self):
        """What ``np.exp`` asks of an object."""
        return self.trace.note(lambda x: 2.718281828**x, self, name="exp")

    def __lt__(self, other):
        return self.value < _value(other)

    def __gt__(self, other):
        return self.value > _value(other)

    __radd__, __rmul__ = __add__, __mul__


FREE = {operator.neg, operator.abs}
"""Operations that a compiler folds into others."""


class _Trace:
    """Every operation of a trial call, each once."""

    def __init__(self):
        self._noted: dict[tuple, _Number] = {}

    def leaf(self, value: float, varies: bool) -> _Number:
        """A number that is given; ``varies``: from neighbour to neighbour."""
        return _Number(self, (), value, varies)

    def note(self, function, *operands, name: str = "") -> _Number:
        """The result of an operation; the same one where it was noted before."""
        keys = [id(x) if isinstance(x, _Number) else float(x) for x in operands]
        if function in (operator.add, operator.mul):
            keys.sort()
        key = (name or function, *keys)
        if key not in self._noted:
            value = function(*map(_value, operands))
            varies = any(x.varies for x in operands if isinstance(x, _Number))
            self._noted[key] = _Number(self, (name or function, operands), value, varies)
        return self._noted[key]

    def parameters(self, value: Any) -> Any:
        """Effects or a kernel with their parameters as numbers that do not vary, None as what it is."""
        if isinstance(value, tuple):
            inner = map(self.parameters, value)
            return type(value)(*inner) if hasattr(value, "_fields") else tuple(inner)
        return None if value is None else self.leaf(value, False)

    def running(self, total: Any) -> Any:
        """Sums as they stand somewhere on the way: every number varies."""
        if isinstance(total, tuple):
            return tuple(map(self.running, total))
        return self.leaf(_value(total), True)

    def operations(self, results: Any) -> int:
        """Counted operations that the results, in tuples, rest on."""
        counted, seen, open_ = 0, set(), [results]
        while open_:
            one = open_.pop()
            if isinstance(one, tuple):
                open_ += one
            elif isinstance(one, _Number) and one.made and one.varies and id(one) not in seen:
                seen.add(id(one))
                function, operands = one.made
                counted += function not in FREE
                open_.append(operands)
        return counted


def _value(x) -> float:
    return x.value if isinstance(x, _Number) else x


def _is_zero(x) -> bool:
    return not isinstance(x, _Number) and x == 0.0
