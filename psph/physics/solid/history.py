"""What a particle of a solid remembers, and how it is read and written."""

from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import overload_inside, unrolled


class History(NamedTuple):
    """What a particle remembers: C_p⁻¹ − 1, the equivalent plastic ``strain``, the plastic ``work``, J/m³.

    ``heat`` is its psph.physics.solid.compression.Heat where a solid of the scene asks for it, and
    ``branches`` are what relaxes of it (psph.physics.solid.viscous); else None, as all is that no solid of
    the scene asks for.
    """

    metric: Any
    strain: Any
    work: Any
    heat: Any = None
    branches: Any = None


def read(kept, column):
    """What a particle has in some arrays: a number, or a tuple of what it has in each; None where there are
    none."""
    if kept is None or isinstance(kept, np.ndarray):
        return None if kept is None else kept[column]
    values = [read(one, column) for one in kept]
    return type(kept)(*values) if hasattr(kept, "_fields") else tuple(values)


@overload_inside(read)
def _typed_read(kept, column):
    if isinstance(kept, types.NoneType):
        return lambda kept, column: None
    if not isinstance(kept, types.BaseTuple):
        return lambda kept, column: kept[column]
    values = ", ".join(f"read(kept[{n}], column)" for n in range(len(kept)))
    if isinstance(kept, types.BaseNamedTuple):
        return unrolled("kept, column", f"return named({values})", read=read, named=kept.instance_class)
    return unrolled("kept, column", f"return ({values},)", read=read)


def write(kept, column, now):
    """Let a particle have this in the same arrays."""
    if isinstance(kept, np.ndarray):
        kept[column] = now
    elif kept is not None:
        for one, value in zip(kept, now):
            write(one, column, value)


@overload_inside(write)
def _typed_write(kept, column, now):
    if isinstance(kept, types.NoneType):
        return lambda kept, column, now: None
    if not isinstance(kept, types.BaseTuple):
        return _put_number
    lines = (f"write(kept[{n}], column, now[{n}])" for n in range(len(kept)))
    return unrolled("kept, column, now", *lines, write=write)


def _put_number(kept, column, now):
    kept[column] = now
