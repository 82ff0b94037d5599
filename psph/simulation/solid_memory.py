"""The stress of a particle of a solid, with what it remembers where any solid of the scene yields or relaxes.

``memory`` is None where none does: then these are the laws of elasticity, and nothing else is compiled.
"""

from typing import Any, NamedTuple

from numba.core import types

from psph.engine.jit import call_by_number, inside, overload_inside
from psph.physics.solid.compression import OF_HEAT, Heat
from psph.physics.solid.history import History, read, write
from psph.physics.solid.material import remembers
from psph.physics.solid.plane import even
from psph.physics.solid.plastic import OF_PLASTIC
from psph.physics.solid.viscous import RELAXED
from psph.vectors import dot

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
    (psph.physics.solid.plastic), in those of its ``heat`` (psph.physics.solid.compression) and of its
    ``branches`` (psph.physics.solid.viscous), each None where no solid has it; and the time ``dt`` since they
    were written, s."""

    columns: Any
    metric: Any
    strain: Any
    work: Any
    heat: Any
    branches: Any
    dt: float


def memory_of(solids, store, columns, dt: float) -> Memory | None:
    """What the particles at some ``columns`` of a ``store`` remember, ``dt`` s after they last yielded or
    relaxed; None where none of the ``solids`` (psph.physics.solid.material) does."""
    if not remembers(solids):
        return None
    plastic = [store[field.name] if field.name in store else None for field in OF_PLASTIC]
    warm = all(field.name in store for field in OF_HEAT)
    heat = Heat(*(store[field.name] for field in OF_HEAT)) if warm else None
    branches = tuple(store[field.name] for field in RELAXED if field.name in store)
    return Memory(columns, *plastic, heat, branches or None, dt)


@inside
def recalled(memory, k):
    """The History of row ``k``."""
    column = memory.columns[k]
    metric, strain = read(memory.metric, column), read(memory.strain, column)
    heat, branches = read(memory.heat, column), read(memory.branches, column)
    return History(metric, strain, read(memory.work, column), heat, branches)


@inside
def _flow_on(laws, number, memory, k, f, a):
    if dot(f, f) == 0.0:  # its neighbours do not span space
        return f
    p, now = law_flow(laws, number, f, recalled(memory, k), memory.dt, a)
    column = memory.columns[k]
    write(memory.metric, column, now.metric)
    write(memory.strain, column, now.strain)
    write(memory.work, column, now.work)
    write(memory.heat, column, now.heat)
    write(memory.branches, column, now.branches)
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

thinned = call_by_number("thinned", even)
"""(laws, number, F, a) → the thickness of a sheet in plane stress over that at the start; else 1."""
