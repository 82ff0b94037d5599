"""What a compiled loop is made of: the key of its file in the compile cache.

A loop is compiled from its own code, from every function and constant that this code names, from what stands
in for a function while numba compiles (psph.engine.jit.overload), and from the methods of the classes in its
arguments' types.  The digest of all these changes when the loop would, and with nothing else: a message, a
docstring or a picture compiles nothing, and an effect only the loops that hold it.
"""

import functools
import hashlib
import sys
import types
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core.extending import _Intrinsic

OUTSIDE = {*sys.stdlib_module_names, "llvmlite", "numba", "numpy"} - {"__main__"}
"""Packages that a digest has by name alone: their versions stand in that of the build."""

PLAIN = (type(None), bool, int, float, complex, str, bytes, np.generic, np.dtype, type(...), range, slice)
"""Classes of values that are what they print."""

STAND_INS: dict[Any, list[Any]] = {}
"""Function → what gives compiled code in its place, for the types of its arguments."""


class UnknownContent(TypeError):
    """A loop refers to something of which nobody has said what it is made of."""


class _Part(NamedTuple):
    """One thing that a loop is made of: its ``own`` text, the ``words`` in it, and what it refers to."""

    own: str
    words: frozenset[str] = frozenset()
    below: tuple[Any, ...] = ()


def contents(loop, arguments: Iterable[Any]) -> str:
    """Digest, 32 hexadecimal digits, of a ``loop`` compiled for arguments of some numba types.

    Of a class that part counts which something in the loop names: an effect's formulas, not what it tells the
    plan.  Raises UnknownContent.
    """
    kinds = tuple(arguments)
    digest = hashlib.sha256(repr(kinds).encode())
    numbers: dict[int, int] = {}
    queue: deque[Any] = deque()

    def number(value) -> int:
        if id(value) not in numbers:
            numbers[id(value)] = len(numbers)
            queue.append(value)
        return numbers[id(value)]

    words: set[str] = set()
    attributes: list[tuple[type, dict[str, Any]]] = []
    for value in (loop, *_classes(kinds)):
        number(value)
    while queue:
        value = queue.popleft()
        part = part_of(value)
        words |= part.words
        if isinstance(value, type):
            attributes.append((value, _attributes(value)))
        digest.update(f"{part.own} {[number(one) for one in part.below]}\n".encode())
        if not queue:
            for cls, named in attributes:
                for name in [name for name in named if name in words]:
                    digest.update(f"{number(cls)}.{name} {number(named.pop(name))}\n".encode())
    return digest.hexdigest()[:32]


_seen: dict[int, tuple[Any, _Part]] = {}
"""What was looked at so far, by identity; each is held, so that no other takes its place."""


def part_of(value) -> _Part:
    """One thing that a loop refers to; raises UnknownContent."""
    if id(value) not in _seen:
        _seen[id(value)] = value, _look(value)
    return _seen[id(value)][1]


def _look(value) -> _Part:
    if isinstance(value, PLAIN):
        return _Part(f"{type(value).__name__} {value!r}", _words([value]))
    if isinstance(value, np.ndarray):
        return _Part(f"array {value.dtype} {value.shape} {value.tobytes().hex()}")
    if isinstance(value, type):
        return _Part(f"class {value.__module__}.{value.__qualname__} {getattr(value, '_fields', '')}")
    if isinstance(value, numba.types.Type):
        return _Part(f"type {value}", below=tuple(_classes([value])))
    if isinstance(value, (tuple, list, set, frozenset)):
        parts = sorted(value, key=repr) if isinstance(value, (set, frozenset)) else value
        return _Part("several", below=(type(value), *parts))
    if isinstance(value, dict):
        return _Part("table", below=tuple(one for pair in value.items() for one in pair))
    return _look_at_code(value)


def _look_at_code(value) -> _Part:
    if isinstance(value, numba.core.dispatcher.Dispatcher):
        return _Part("loop", below=(value.targetoptions, value.py_func))
    if isinstance(value, _Intrinsic):
        return _Part("intrinsic", below=(value._defn,))
    if isinstance(value, functools.partial):
        return _Part("partial", below=(value.func, value.args, value.keywords))
    if isinstance(value, (staticmethod, classmethod, types.MethodType)):
        return _Part(type(value).__name__, below=(value.__func__, getattr(value, "__self__", None)))
    if isinstance(value, property):
        return _Part("property", below=(value.fget,))
    if _is_outside(value):
        return _Part(f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', value)}")
    if isinstance(value, types.ModuleType):
        return _Part(f"module {value.__name__}")
    if isinstance(value, types.FunctionType):
        return _function(value)
    if hasattr(value, "__wrapped__"):  # of functools.cache
        return _Part("wrapped", below=(value.__wrapped__,))
    raise UnknownContent(f"{value!r} of {type(value)} stands in a compiled loop")


def _is_outside(value) -> bool:
    name = value.__name__ if isinstance(value, types.ModuleType) else getattr(value, "__module__", None)
    if name is None:
        return isinstance(value, (types.BuiltinFunctionType, np.ufunc))
    return name.partition(".")[0] in OUTSIDE


def _function(function) -> _Part:
    """A function by its code, what its names refer to, its defaults and what stands in for it."""
    codes = list(_codes(function.__code__))
    used = {name for code in codes for name in code.co_names}
    named = {name: function.__globals__[name] for name in sorted(used & function.__globals__.keys())}
    for module in [one for one in named.values() if isinstance(one, types.ModuleType)]:
        if not _is_outside(module):
            has = [name for name in sorted(used) if hasattr(module, name)]
            named |= {f"{module.__name__}.{name}": getattr(module, name) for name in has}
    cells = [_cell(cell) for cell in function.__closure__ or ()]
    docs = function.__doc__
    texts = [_text(code, docs if code is function.__code__ else None) for code in codes]
    below = (*named.values(), *cells, function.__defaults__, function.__kwdefaults__)
    return _Part(
        f"{getattr(function, HOW, '')} {texts} {list(named)}",
        frozenset(used) | _words(one for code in codes for one in code.co_consts) | _words(cells),
        (*below, *STAND_INS.get(function, ())),
    )


HOW = "_psph_compiled"
"""Attribute of a function: how its module asks for it to be compiled."""


def _cell(cell) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # not filled yet
        return None


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A function's code and that of the functions inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)


def _text(code: types.CodeType, docs: str | None) -> str:
    """Code without what changes nothing: lines, files, its ``docs``."""
    constants = [
        sorted(one, key=repr) if isinstance(one, frozenset) else one
        for one in code.co_consts
        if not isinstance(one, types.CodeType) and one != docs
    ]
    names = (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars)
    flags = (code.co_argcount, code.co_kwonlyargcount, code.co_flags)
    return f"{code.co_code.hex()} {constants!r} {names} {flags}"


def _words(values: Iterable[Any]) -> frozenset[str]:
    """The words that might name a method, among some values and in tuples of them."""
    found: set[str] = set()
    for value in values:
        if isinstance(value, str) and value.isidentifier():
            found.add(value)
        elif isinstance(value, (tuple, frozenset)):
            found |= _words(value)
    return frozenset(found)


def _attributes(cls: type) -> dict[str, Any]:
    """What may be named of a class: methods and constants, also of the classes that it extends."""
    found: dict[str, Any] = {}
    for one in reversed(cls.__mro__):
        if one.__module__.partition(".")[0] not in OUTSIDE:
            found |= vars(one)
    places = set(getattr(cls, "_fields", ()))
    return {name: value for name, value in found.items() if name not in places}


def _classes(kinds: Iterable[Any]) -> Iterator[type]:
    """The classes of named tuples in some numba types, and in the types that these are made of."""
    for kind in kinds:
        if cls := getattr(kind, "instance_class", None):
            yield cls
        yield from _classes(getattr(kind, "types", ()))
        for part in (getattr(kind, name, None) for name in ("dtype", "type", "key")):
            if isinstance(part, numba.types.Type) and part is not kind:
                yield from _classes([part])
