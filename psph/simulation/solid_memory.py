"""The stress of a particle of a solid, with what it remembers where any solid of the scene yields.

``memory`` is None where none does: then these are the laws of elasticity, and nothing else is compiled.
"""

from typing import Any, NamedTuple

from numba.core import types

from psph.engine.jit import call_by_number, inside, overload_inside
from psph.physics.solid.compression import Heat
from psph.physics.solid.plastic import History
from psph.vectors import at, dot, put

law_stress = call_by_number("stress")
"""(laws, number, F, [History,] a) → P, Pa."""
law_across = call_by_number("across")
"""(laws, number, F, [History,] a) → P along z in plane strain, Pa."""
law_energy = call_by_number("energy")
"""(laws, number, F, [History,] a) → ψ, J per reference volume."""
law_flow = call_by_number("flow")
"""(laws, number, F, History, Δt, a) → P and the new History."""


class Memory(NamedTuple):
    """Where a row's history is: its ``columns`` (rows,) in the arrays ``metric``, ``strain`` and ``work``
    (psph.physics.solid.plastic), and in those of its ``heat``, None where there is none
    (psph.physics.solid.compression); and the time ``dt`` since they were written, s."""

    columns: Any
    metric: Any
    strain: Any
    work: Any
    heat: Any
    dt: float


@inside
def recalled(memory, k):
    """The History of row ``k``."""
    column = memory.columns[k]
    heat = warmth(memory.heat, column)
    return History(at(memory.metric, column), memory.strain[column], memory.work[column], heat)


def warmth(heat, column):
    """The Heat of a particle; None where there is none."""
    return None if heat is None else Heat(heat.energy[column], heat.swelling[column])


@overload_inside(warmth)
def _typed_warmth(heat, column):
    if isinstance(heat, types.NoneType):
        return lambda heat, column: None
    return lambda heat, column: Heat(heat.energy[column], heat.swelling[column])


def keep_warm(heat, column, now):
    """Write the Heat of a particle, where there is any."""
    if heat is not None:
        heat.energy[column], heat.swelling[column] = now


@overload_inside(keep_warm)
def _typed_keep_warm(heat, column, now):
    if isinstance(heat, types.NoneType):
        return lambda heat, column, now: None

    def write(heat, column, now):
        heat.energy[column] = now.energy
        heat.swelling[column] = now.swelling

    return write


@inside
def _flow_on(laws, number, memory, k, f, a):
    if dot(f, f) == 0.0:  # its neighbours do not span space
        return f
    p, now = law_flow(laws, number, f, recalled(memory, k), memory.dt, a)
    column = memory.columns[k]
    put(memory.metric, column, now.metric)
    memory.strain[column] = now.strain
    memory.work[column] = now.work
    keep_warm(memory.heat, column, now.heat)
    return p


def advanced(laws, number, memory, k, f, a):
    """P of row ``k`` after this step, Pa; what it remembers is that of after the step then."""
    return law_stress(laws, number, f, a) if memory is None else _flow_on(laws, number, memory, k, f, a)


@overload_inside(advanced)
def _typed_advanced(laws, number, memory, k, f, a):
    if isinstance(memory, types.NoneType):
        return lambda laws, number, memory, k, f, a: law_stress(laws, number, f, a)
    return lambda laws, number, memory, k, f, a: _flow_on(laws, number, memory, k, f, a)


def _of_state(law_value):
    """(laws, number, memory, k, f, a) → what a law gives for the state of row ``k``."""

    def value(laws, number, memory, k, f, a):
        if memory is None:
            return law_value(laws, number, f, a)
        return law_value(laws, number, f, recalled(memory, k), a)

    @overload_inside(value)
    def typed(laws, number, memory, k, f, a):
        if isinstance(memory, types.NoneType):
            return lambda laws, number, memory, k, f, a: law_value(laws, number, f, a)
        return lambda laws, number, memory, k, f, a: law_value(laws, number, f, recalled(memory, k), a)

    return value


stress, across, energy = map(_of_state, (law_stress, law_across, law_energy))
