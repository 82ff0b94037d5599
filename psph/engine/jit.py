"""How psph compiles: numba's flags, dispatch by type, and a cache that cannot go stale.

An *effect*, a smoothing kernel or an equation of state is a ``NamedTuple``: its fields are its
parameters, its methods are its formula.  numba sees the class in the value's type, so a call by
type selects the formula at compile time and inlines it; a new parameter value recompiles nothing,
a scene without an effect holds none of its code.
"""

import gc
import hashlib
import os
import sys
from contextlib import contextmanager
from pathlib import Path

import llvmlite
import llvmlite.binding as llvm
import numba
import numpy as np
from numba import extending
from numba.core.sigutils import normalize_signature

from psph.engine import lean
from psph.engine.cache import READY, Cache, LoopCache
from psph.engine.contents import HOW, STAND_INS, UnknownContent, contents

FAST = {"contract", "reassoc", "arcp", "nsz", "afn"}
"""Freedom to reorder sums, which vectors need.  NaN and infinity keep their meaning (no ``nnan``,
no ``ninf``): a run that blows up must be seen to do so."""


PACKAGE = Path(__file__).parents[1]


def source_digest(*patterns: str) -> str:
    """Fingerprint of psph's own sources, all or those that fit ``patterns``: who wrote a checkpoint."""
    found = {path for pattern in patterns or ("**/*.py",) for path in PACKAGE.glob(pattern)}
    digest = hashlib.sha256()
    for path in sorted(found):
        digest.update(str(path.relative_to(PACKAGE)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


SOURCES = source_digest()
"""That of the sources which this process has read, whatever is written into them meanwhile."""


GENERATOR = ("--regalloc=pbqp", "--pre-RA-sched=list-ilp", "--misched-prera-direction=topdown")
"""How LLVM hands out registers and in which order it computes: its own choice copies a third of the pair
loop's numbers from one register to another, or keeps more of them waiting than there are registers.  They
change no result."""


def _configure() -> None:
    lean.use()
    for option in GENERATOR:
        llvm.set_option("psph", option)
    numba.config.CPU_NAME = numba.config.CPU_NAME or llvm.get_host_cpu_name()
    if not numba.config.CPU_FEATURES:
        # 512-bit vectors where the processor has them: LLVM would prefer 256.
        features = llvm.get_host_cpu_features().flatten()
        numba.config.CPU_FEATURES = features + ",-prefer-256-bit"


_configure()


COMPILER = ("engine/jit.py", "engine/lean.py", "engine/simd/*.py")
"""Sources that say how loops are compiled, whatever these are."""


def cache_folder() -> Path:
    """Folder of the compiled loops: ``$PSPH_CACHE`` or the user's cache folder, one per way of compiling."""
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    root = Path(os.environ.get("PSPH_CACHE") or Path(home) / "psph")
    processor = (numba.config.CPU_NAME, numba.config.CPU_FEATURES)
    versions = (sys.version, numba.__version__, np.__version__, llvmlite.__version__)
    build = f"{source_digest(*COMPILER)} {processor} {versions}"
    return root / hashlib.sha256(build.encode()).hexdigest()[:16]


CACHE = Cache(cache_folder())
"""This process's compiled loops on disk."""


def processor() -> str:
    """The processor that loops are compiled for: bits may differ between two of them."""
    return numba.config.CPU_NAME


def register_bits() -> int:
    """Bits of the processor's vector registers."""
    return 512 if "+avx512f" in numba.config.CPU_FEATURES.split(",") else 256


def marker(loops: str, *examples) -> Path | None:
    """The file that says: these ``loops``, for the types of these ``examples``, are in the cache.

    Whoever has compiled them all touches it.  Where it is wrong, loops are compiled once more.
    None without a cache.
    """
    if CACHE.folder is None:
        return None
    selected = (SOURCES, numba.config.DISABLE_JIT, loops, *map(numba.typeof, examples))
    return CACHE.folder / f"{hashlib.sha256(str(selected).encode()).hexdigest()[:16]}{READY}"


@contextmanager
def many_loops():
    """Where many loops are compiled: numba's objects are not searched for rings meanwhile.

    It makes some hundreds of thousands and keeps most of them; the searches take a tenth of the time.
    """
    used = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if used:
            gc.enable()


def compiled(function):
    """Decorator of a compiled loop: a module-level function, kept in the cache.

    LLVM may reorder and contract its arithmetic: for the pair loop and what works with lanes, whose
    order is written out, and for what has no arithmetic in floating point.
    """
    return _kept(numba.njit(fastmath=FAST, **OPTIONS)(function))


def uncounted(function):
    """Decorator of a compiled loop that makes no array: as :func:`compiled`; who holds one is not counted.

    numba does so at each call of a part of the loop that takes arrays: fifty times a particle, in turns with
    all other processors, in the time of a hundred neighbours.
    """
    return _kept(numba.njit(fastmath=FAST, _nrt=False, **OPTIONS)(function))


def elementwise(function):
    """Decorator of a compiled loop over columns: as :func:`compiled`, with strict arithmetic.

    Every operation is rounded by itself, in the order written.  Which columns the vector body takes and
    which the remainder depends on the rank's slab; strict, both give a particle the same bits.
    """
    return _kept(numba.njit(**OPTIONS)(function))


def _kept(loop):
    """The loop, in the cache where there is one."""

    def name(signature) -> str | None:
        arguments, _ = normalize_signature(signature)
        try:
            return f"{loop.__name__}-{contents(loop, arguments)}"
        except UnknownContent:  # of a class in a user's file
            return None

    if CACHE.folder is not None and not numba.config.DISABLE_JIT:
        loop._cache = LoopCache(CACHE, name)
    return loop


INNER = {"no_cfunc_wrapper": True}
"""Functions that only compiled code calls need no entry for C: to build it takes an eighth of the
time that they take to compile."""

OPTIONS = {"error_model": "numpy", "nogil": True, **INNER}
"""Of every loop: division by zero gives infinity, and threads run side by side."""


INSIDE = {**INNER, "forceinline": True}
"""Of functions that LLVM writes into their caller, however long they are.  A call that is left hands on
a hundred arrays, counts the holders of each, and takes a hundred times as long as the rest of a loop over
columns.  And it goes to the function as it was compiled by itself in a process that compiles, to a copy of
it in a process that loads the loop from the cache: the two may round differently."""


def overload(function, jit_options=INNER, **options):
    """Decorator: what compiled code has in the place of ``function`` (numba.extending.overload)."""

    def stand_in(gives):
        STAND_INS.setdefault(function, []).append((gives, tuple(jit_options)))
        return extending.overload(function, jit_options=jit_options, **options)(gives)

    return stand_in


def register_jitable(function):
    """Let compiled code call a plain function (numba.extending.register_jitable)."""
    setattr(function, HOW, "register_jitable")
    return extending.register_jitable(**INNER)(function)


def inside(function):
    """The same, for a part of a loop that takes all of the loop's arrays: see INSIDE."""
    setattr(function, HOW, "inside")
    return extending.register_jitable(**INSIDE)(function)


def overload_inside(function):
    """As :func:`overload`, for such a part of a loop."""
    return overload(function, jit_options=INSIDE)


def overload_walker(function):
    """As :func:`overload`, for what works through the effects that are its first argument: such a part of a
    loop where one of them is ``written_in``."""

    def stand_in(gives):
        def usual(*args):
            return None if _is_written_in(args[0]) else gives(*args)

        def written(*args):
            return gives(*args) if _is_written_in(args[0]) else None

        overload(function, strict=False)(usual)
        overload(function, jit_options=INSIDE, strict=False)(written)
        return gives

    return stand_in


def _is_written_in(kinds) -> bool:
    """Whether any of the types of some effects asks for it."""
    return any(getattr(getattr(one, "instance_class", None), "written_in", False) for one in kinds)


def call_by_type(name: str, otherwise=None):
    """A function ``(value, *args) -> value.name(*args)`` for compiled code and plain Python.

    The formula is found by the value's class and inlined; a class without it has the formula ``otherwise``.
    """

    def call(value, *args):
        return getattr(type(value), name, otherwise)(value, *args)

    @overload_inside(call)
    def typed(value, *args):
        formula = inside(formula_of(value, name) or otherwise)
        return lambda value, *args: formula(value, *args)

    return call


def call_by_number(name: str, otherwise=None):
    """A function ``(values, number, *args) -> values[number].name(*args)`` of values of several classes.

    All formulas give the same type; a class without it has the formula ``otherwise``.  Where there is one
    value, its number is not looked at.
    """

    def call(values, number, *args):
        value = values[int(number)]
        return getattr(type(value), name, otherwise)(value, *args)

    @overload_inside(call)
    def typed(values, number, *args):
        formulas = (inside(formula_of(kind, name) or otherwise) for kind in values)
        formulas = {f"formula_{n}": formula for n, formula in enumerate(formulas)}
        lines = ["found = formula_0(values[0], *args)"]
        for n in range(1, len(values)):
            lines += [f"if number == {n}:", f"    found = formula_{n}(values[{n}], *args)"]
        return unrolled("values, number, *args", *lines, "return found", **formulas)

    return call


def unrolled(arguments: str, *lines: str, **names):
    """The function of these arguments with these lines, for numba to compile in one piece.

    A tuple's length is known when a function is compiled for it.  To work through its entries by
    recursion over its type costs the compiler as much at each level as a formula of physics does;
    written out it costs but once.  ``names`` are what the lines refer to.
    """
    exec("\n    ".join([f"def written_out({arguments}):", *lines]), names)
    return names["written_out"]


def tuple_of(parts) -> str:
    """The text of a tuple with these parts."""
    return f"({''.join(f'{part}, ' for part in parts)})"


def method_of(named_type, name: str):
    """The compiled form of method ``name`` of a NamedTuple's class, or None if it has none.

    Where the class says ``written_in``, LLVM writes it into its caller however long it is: see INSIDE.
    """
    formula = formula_of(named_type, name)
    kept = inside if getattr(named_type.instance_class, "written_in", False) else register_jitable
    return formula and kept(formula)


def formula_of(named_type, name: str):
    """Method ``name`` of a NamedTuple's class, or None if it has none."""
    return getattr(named_type.instance_class, name, None)
