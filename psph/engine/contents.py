"""What a compiled loop is made of: the key of its file in the compile cache.

A loop is compiled from its own code, from every function and constant that this code names, from what stands
in for a function while numba compiles (psph.engine.jit.overload), and from the methods of the classes in its
arguments' types.  The digest of all these changes when the loop would, and with nothing else: a message, a
docstring or a picture compiles nothing, and an effect only the loops that hold it.
"""

import dis
import functools
import hashlib
import os
import pickle
import sys
import types
from collections import deque
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core.extending import _Intrinsic
from numba.core.typing.templates import builtin_registry

OUTSIDE, PYTHON = {"llvmlite", "numba", "numpy"}, Path(os.__file__).parent
"""Packages that a digest has by name alone, as it has Python's own in this folder: their versions stand in
that of the build."""

UNSEEN = {"__import__", "environ", "eval", "getenv", "globals", "import_module", "modules", "open", "vars"}
"""Names of what brings into code things that the code does not name."""

USUAL = {"OPT": 3, "LOOP_VECTORIZE": 1, "SLP_VECTORIZE": 0, "BOUNDSCHECK": None, "DEBUGINFO_DEFAULT": 0}
"""How numba compiles unless its environment variables say another way: settings of ``numba.config``."""

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
    digest = hashlib.sha256(f"{kinds!r}{_unusual()}".encode())
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
                    one = named.pop(name)
                    if _first.setdefault((cls, name), one) is not one:
                        raise UnknownContent(f"{cls.__qualname__}.{name} was another")
                    digest.update(f"{number(cls)}.{name} {number(one)}\n".encode())
                    for default in _defaults([one]):
                        number(default)
    return digest.hexdigest()[:32]


def _unusual() -> str:
    """How numba compiles in this process, as far as that is another way than usual."""
    told = {name: getattr(numba.config, name) for name in USUAL}
    return "".join(f" {name} {value}" for name, value in told.items() if value != USUAL[name])


class _Seen(NamedTuple):
    """A ``value`` that was looked at, its ``part`` in a loop, the ``places`` of what it refers to, and the
    ``state`` of that."""

    value: Any
    part: _Part
    places: tuple[tuple[Any, str], ...]
    state: tuple[Any, ...]


_seen: dict[int, _Seen] = {}
"""What was looked at so far, by identity; each is held, so that no other takes its place."""

_first: dict[tuple[type, str], Any] = {}
"""What an attribute of a class was when it was looked at first."""


def part_of(value) -> _Part:
    """One thing that a loop refers to; raises UnknownContent.

    So it does where that has been replaced in this process: some of numba's code is of what was there before,
    and some would be of what is there now.
    """
    seen = _seen.get(id(value))
    if seen is None:
        places = tuple(_places(value).values()) if _is_inside(value) else ()
        seen = _seen[id(value)] = _Seen(value, _look(value), places, _state(value, places))
    elif not _same(seen.state, _state(value, seen.places)):
        raise UnknownContent(f"{value!r} was another")
    return seen.part


def _is_inside(value) -> bool:
    return isinstance(value, types.FunctionType) and not _is_outside(value)


def _state(value, places) -> tuple[Any, ...]:
    """What may be replaced in something while Python runs."""
    if _is_inside(value):
        fixed = (value.__code__, value.__defaults__, value.__kwdefaults__, len(STAND_INS.get(value, ())))
        return (*fixed, *map(_there, places), *map(_cell, value.__closure__ or ()))
    if isinstance(value, (list, set)):
        return tuple(value)
    if isinstance(value, dict):
        return (*value, *value.values())
    return (hashlib.sha256(value.tobytes()).digest(),) if isinstance(value, np.ndarray) else ()


def _same(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    """Whether two states hold the same things."""
    return len(one) == len(other) and all(a is b or type(a) is bytes and a == b for a, b in zip(one, other))


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
    if hasattr(value, "__wrapped__") and not isinstance(value, types.FunctionType):  # of functools.cache
        return _Part("wrapped", below=(value.__wrapped__,))
    if _is_outside(value):
        return _Part(f"{getattr(value, '__module__', '')}.{_name_outside(value)}")
    if isinstance(value, types.ModuleType):
        return _Part(f"module {value.__name__}")
    if isinstance(value, types.FunctionType):
        return _function(value)
    raise UnknownContent(f"{value!r} of {type(value)} stands in a compiled loop")


def _is_outside(value) -> bool:
    name = value.__name__ if isinstance(value, types.ModuleType) else getattr(value, "__module__", None)
    if name is None:
        return isinstance(value, (types.BuiltinFunctionType, np.ufunc))
    return _comes_from_outside(name.partition(".")[0])


@functools.cache
def _comes_from_outside(package: str) -> bool:
    """Whether a package is none that somebody edits: a file of theirs may be called as one of Python's."""
    if package in OUTSIDE or package not in sys.stdlib_module_names or package == "__main__":
        return package in OUTSIDE
    file = getattr(sys.modules.get(package), "__file__", None)
    return file is None or PYTHON in Path(file).parents and "site-packages" not in Path(file).parts


def _name_outside(value) -> str:
    """A function, class or module by its name, not by its place; anything else by all that it holds."""
    if isinstance(value, types.ModuleType):
        return value.__name__
    if isinstance(value, np.ufunc):
        return repr(value)
    if hasattr(value, "__qualname__"):
        return value.__qualname__
    try:
        return pickle.dumps(value).hex()
    except Exception:  # whatever it is
        raise UnknownContent(f"{value!r} of {type(value)} stands in a compiled loop") from None


def _function(function) -> _Part:
    """A function by its code, what its names refer to, its defaults and what stands in for it."""
    codes = list(_codes(function.__code__))
    used = {name for code in codes for name in code.co_names}
    if unseen := used & UNSEEN:
        raise UnknownContent(f"{function!r} calls {', '.join(sorted(unseen))}")
    named = {words: _there(place) for words, place in _places(function).items()}
    cells = [_cell(cell) for cell in function.__closure__ or ()]
    docs = function.__doc__
    texts = [_text(code, docs if code is function.__code__ else None) for code in codes]
    below = (*named.values(), *cells, function.__defaults__, function.__kwdefaults__)
    own = {name: one for name, one in vars(function).items() if name != HOW}
    return _Part(
        f"{getattr(function, HOW, '')} {texts} {list(named)}",
        frozenset(used) | _words(one for code in codes for one in code.co_consts) | _words(cells),
        (*below, *_stand_ins(function), *([own] if own else []), *_defaults([*named.values(), *cells])),
    )


@functools.cache
def _places(function) -> dict[str, tuple[Any, str]]:
    """To what a function's code may refer: {words: (the table or module that has it, its name there)}."""
    codes = list(_codes(function.__code__))
    used = sorted({name for code in codes for name in code.co_names})
    table = function.__globals__
    named: dict[str, tuple[Any, str]] = {name: (table, name) for name in used if name in table}
    modules = [one for one in map(table.get, used) if isinstance(one, types.ModuleType)]
    modules += [one for code in codes for one in _imported(code, table.get("__package__"))]
    for module in modules:  # and theirs: a.b.c
        if not _is_outside(module):
            has = [name for name in used if hasattr(module, name)]
            named |= {f"{module.__name__}.{name}": (module, name) for name in has}
            inner = [getattr(module, name) for name in has]
            modules += [one for one in inner if isinstance(one, types.ModuleType) and one not in modules]
    return named


def _there(place: tuple[Any, str]) -> Any:
    """What stands at such a place."""
    has, name = place
    return has.get(name) if isinstance(has, dict) else getattr(has, name, None)


def _imported(code: types.CodeType, package: str | None) -> list[types.ModuleType]:
    """The modules that a function imports when it is called."""
    if dis.opmap["IMPORT_NAME"] not in code.co_code[::2]:
        return []
    names = [name for one in code.co_names for name in (one, f"{package}.{one}")]
    modules = [sys.modules[name] for name in names if name in sys.modules]
    if not modules:
        raise UnknownContent(f"{code!r} imports what is not there yet")
    return modules


def _defaults(values: Iterable[Any]) -> list[dict[str, Any]]:
    """What those of some values fill in that are named tuples, and that code may call."""
    given = [getattr(one, "_field_defaults", None) for one in values if isinstance(one, type)]
    return [one for one in given if one]


@functools.cache
def _templates(count: int) -> dict[int, list[Any]]:
    """Numba's templates for functions, by identity; there are ``count`` of them."""
    stand_ins: dict[int, list[Any]] = {}
    for value, kind in builtin_registry.globals[:count]:
        stand_ins.setdefault(id(value), []).append(kind)
    return stand_ins


def _stand_ins(function) -> list[Any]:
    """What compiled code has in a function's place, by psph.engine.jit or by numba itself."""
    if function in STAND_INS or hasattr(function, HOW):
        return STAND_INS.get(function, [])
    stand_ins = _templates(len(builtin_registry.globals)).get(id(function), [])
    parts = [part for kind in stand_ins for part in getattr(kind, "templates", [kind])]
    if not all(hasattr(part, "_overload_func") for part in parts):
        raise UnknownContent(f"{function!r} is what numba's templates say")
    return [part._overload_func for part in parts]


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
    """Code without what changes nothing: lines, files, and its ``docs``, unless it uses that constant too."""
    pairs = zip(code.co_code[::2], code.co_code[1::2])
    takes = bool(docs) and any(operation in dis.hasconst and place == 0 for operation, place in pairs)
    constants = [
        sorted(one, key=repr) if isinstance(one, frozenset) else one
        for one in code.co_consts
        if not isinstance(one, types.CodeType) and (takes or one != docs)
    ]
    names = (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars)
    flags = (code.co_argcount, code.co_kwonlyargcount, code.co_flags)
    return f"{code.co_code.hex()} {constants!r} {names} {flags}"


def _words(values: Iterable[Any]) -> frozenset[str]:
    """The words that might name a method, among some values and in tuples of them."""
    words: set[str] = set()
    for value in values:
        if isinstance(value, str) and value.isidentifier():
            words.add(value)
        elif isinstance(value, (tuple, frozenset)):
            words |= _words(value)
    return frozenset(words)


def _attributes(cls: type) -> dict[str, Any]:
    """What may be named of a class: methods and constants, also of the classes that it extends."""
    members: dict[str, Any] = {}
    for one in reversed(cls.__mro__):
        if not _comes_from_outside(one.__module__.partition(".")[0]):
            members |= vars(one)
    places = set(getattr(cls, "_fields", ()))
    return {name: value for name, value in members.items() if name not in places}


def _classes(kinds: Iterable[Any]) -> Iterator[type]:
    """The classes of named tuples in some numba types, and in the types that these are made of."""
    for kind in kinds:
        if cls := getattr(kind, "instance_class", None):
            yield cls
        yield from _classes(getattr(kind, "types", ()))
        for part in (getattr(kind, name, None) for name in ("dtype", "type", "key")):
            if isinstance(part, numba.types.Type) and part is not kind:
                yield from _classes([part])
