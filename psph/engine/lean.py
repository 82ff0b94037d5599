"""Machine code for loops alone, not for the functions that they are made of; with an aligned stack.

numba makes machine code of each function that a loop calls, as if somebody might call it from Python, though
the loop takes it in as LLVM's text and is optimised as a whole.  That costs a fifth of the time that a scene
takes to compile.  Besides, a call that LLVM did not write into the loop would go to that code in a process
that compiles, and to the loop's own copy in a process that loads it.

Each function begins its stack at a cache line.  LLVM finds out too late that registers go to the stack, and
leaves it as the caller has it, at a multiple of 16 bytes: three of four times each register of 512 bits that
goes there and back then crosses two lines, and the pair loop of the default scheme takes 1.4 times as long.
"""

from numba.core import codegen

FROM_PYTHON = "_ZN7cpython"
"""How numba begins the name of a function that Python calls."""

CACHE_LINE = 64
"""Bytes, as many as the widest register has."""

RECURSIVE = ".numba.unresolved$"
"""How it begins that of a function that is not there yet, since it calls itself."""


class Library(codegen.JITCodeLibrary):
    """A function's code: LLVM's text, and machine code where Python calls it."""

    _waiting: dict = {}
    """Environments of functions without machine code, by the name of the place in a loop that takes each."""

    def add_ir_module(self, ir_module):
        for function in ir_module.functions:
            if not function.is_declaration:
                function.attributes.add("nounwind")  # without any, llvmlite writes no alignment either
                function.attributes.alignstack = CACHE_LINE
        super().add_ir_module(ir_module)

    def _finalize_final_module(self):
        if not self._is_called():
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            self._finalized = True
            return
        super()._finalize_final_module()
        for place in self._final_module.global_variables:
            if place.name in self._waiting:
                self._codegen.set_env(place.name, self._waiting[place.name])

    def _is_called(self) -> bool:
        if self._object_caching_enabled and self._compiled_object is not None:  # it comes from the cache
            return True
        module = self._final_module
        entries = (one.name.startswith(FROM_PYTHON) and not one.is_declaration for one in module.functions)
        return any(entries) or any(one.name.startswith(RECURSIVE) for one in module.global_variables)


class Codegen(codegen.JITCPUCodegen):
    """Makes such libraries."""

    _library_class = Library

    def set_env(self, env_name, env):
        """Keep the environment of a function where there is no machine code of it yet."""
        if self._engine.get_global_value_address(env_name):
            super().set_env(env_name, env)
        else:
            Library._waiting[env_name] = env


def use() -> None:
    """Let numba compile so in this process; where it has compiled something already, all stays as it is."""
    codegen.JITCPUCodegen = Codegen
