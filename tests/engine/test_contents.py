"""What a compiled loop is keyed by: all that it is made of, and nothing else."""

import importlib.util
import subprocess
import sys
import types
from pathlib import Path

import numba
import numpy as np
import pytest
from jobs import clean_environment
from long import LONG

from psph.engine import contents as contents_module
from psph.engine.contents import UnknownContent, contents

MODULE = '''
"""A module with a loop and an effect."""
from typing import NamedTuple
import numpy as np
from psph.engine.jit import call_by_type, compiled, elementwise, inside, overload, register_jitable

STRENGTH = 2.0
TABLE = {"b": np.array([1.0, 2.0])}
pull = call_by_type("pull")

class Effect(NamedTuple):
    """Pulls."""
    strength: float

    SCALE = 3.0

    def pull(self, x):
        """How it pulls."""
        return self.strength * half(x)

    def why_absent(self, scene):
        return "no use for it"

@register_jitable
def half(x):
    """Half of it."""
    return 0.5 * x

def picked(x):
    return x

@overload(picked)
def _picked(x):
    return lambda x: STRENGTH * x

def unused(x):
    return 7.0 * x

@compiled
def loop(effect, x):
    return pull(effect, x) + picked(x) + table(x)

def table(x):
    return TABLE["b"][0] * x
'''


@pytest.fixture
def digest(tmp_path):
    """The digest of the loop of the module, after an edit: some words for others."""
    count = iter(range(100))

    def of(old="", new=""):
        assert old in MODULE
        path = tmp_path / f"edited_{next(count)}.py"
        path.write_text(MODULE.replace(old, new))
        spec = importlib.util.spec_from_file_location("edited", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        effect = module.Effect(1.0)
        return contents(module.loop, (numba.typeof(effect), numba.float64))

    return of


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("return 0.5 * x", "return 0.25 * x"),
        ("STRENGTH = 2.0", "STRENGTH = 4.0"),
        ("[1.0, 2.0]", "[1.0, 3.0]"),
        ("self.strength * half(x)", "self.strength + half(x)"),
        ("lambda x: STRENGTH * x", "lambda x: STRENGTH + x"),
        ("pull(effect, x) + picked(x)", "picked(x) + pull(effect, x)"),
        ("    strength: float\n", "    strength: float\n    more: float = 0.0\n"),
        ("@compiled\ndef loop", "@elementwise\ndef loop"),
        ("@register_jitable\ndef half", "@inside\ndef half"),
    ],
)
def test_what_changes_the_loop_changes_its_key(digest, old, new):
    assert digest() != digest(old, new)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"no use for it"', '"nothing here calls for it"'),
        ('"""How it pulls."""', '"""The way it pulls."""'),
        ('"""Half of it."""', '"""One half of it."""\n    # and a comment'),
        ("return 7.0 * x", "return 8.0 * x"),
        ("SCALE = 3.0", "SCALE = 4.0"),
        ("STRENGTH = 2.0\n", "\n\nSTRENGTH = 2.0\n"),
    ],
)
def test_what_does_not_change_the_loop_leaves_its_key(digest, old, new):
    assert digest() == digest(old, new)


BEGIN = """
import functools, operator, sys, types
import numba, numpy as np
from typing import NamedTuple
from psph.engine.jit import compiled, overload, register_jitable

def scaled(x):
    return x

@compiled
def loop(x):
    return scaled(x)
"""
CALLED = "def factor():\n    return 2.0\n\n"
STANDS = "\n@overload(scaled)\ndef _scaled(x):\n    by = {}\n    return lambda x: by * x\n"
HIDDEN = {
    "a constant of a module in a module": ("import pkg.inner", STANDS.format("pkg.inner.FACTOR")),
    "a default": ("class Given(NamedTuple):\n    by: float = 2.0\n", STANDS.format("Given().by")),
    "what a function has": (f"{CALLED}factor.by = 2.0", STANDS.format("factor.by")),
    "what prints short": ("OF = np.poly1d([2.00000000001])", STANDS.format("float(OF.c[0])")),
    "what is found by its name": ("FACTOR = 2.0", STANDS.format("globals()['FACTOR']")),
    "what is imported when it is called": ("", STANDS.format("FACTOR").replace("    by", "    from pkg.inner import FACTOR\n    by")),
    "what numba was told": ("", "\n@numba.extending.overload(scaled)\ndef _scaled(x):\n    return lambda x: 2.0 * x\n"),
    "a function of C": (f"@numba.cfunc('f8()')\n{CALLED}", STANDS.format("factor.__wrapped__()")),
}  # fmt: skip
"""Ways in which 2 gets into a loop, as the begin and the end of a module."""


def loaded(folder, text, name="edited"):
    """A module with this text."""
    path = folder / f"{name}.py"
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(autouse=True)
def read_anew(monkeypatch):
    """Python takes a file of the same second and length for one that it has translated."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)


@pytest.mark.parametrize("way", HIDDEN)
def test_what_gets_into_a_loop_by_a_detour_is_in_its_key(way, tmp_path, monkeypatch):
    """Or the loop has none, and is compiled each time."""
    keys = []
    for number in ("2.0", "3.0"):
        inner = types.SimpleNamespace(package=types.ModuleType("pkg"), module=types.ModuleType("pkg.inner"))
        inner.package.inner, inner.module.FACTOR = inner.module, float(number)
        monkeypatch.setitem(sys.modules, "pkg", inner.package)
        monkeypatch.setitem(sys.modules, "pkg.inner", inner.module)
        begin, end = (words.replace("2.0", number) for words in HIDDEN[way])
        module = loaded(tmp_path, f"{BEGIN}{begin}\n{end}")
        try:
            keys.append(contents(module.loop, (numba.float64,)))
        except UnknownContent:
            keys.append(number)
    assert keys[0] != keys[1]


def test_a_file_of_ones_own_may_be_called_as_one_of_python(tmp_path, monkeypatch):
    keys = []
    for number in (2, 3):
        wave = loaded(tmp_path, f"def factor(x):\n    return {number}.0 * x\n", "wave")
        monkeypatch.setitem(sys.modules, "wave", wave)
        contents_module._comes_from_outside.cache_clear()

        def loop(x, factor=wave.factor):
            return factor(x)

        keys.append(contents(loop, (numba.float64,)))
    assert keys[0] != keys[1]


def test_what_is_replaced_while_python_runs_has_no_key(tmp_path):
    """Some code was compiled with what was there before: it would be kept by the name of what is there now."""
    for replace in (
        lambda module: setattr(module, "STRENGTH", 3.0),
        lambda module: setattr(module.Effect, "pull", lambda self, x: x),
        lambda module: module.TABLE.update(b=np.array([1.0, 3.0])),
        lambda module: module.TABLE["b"].fill(3.0),
        lambda module: setattr(module.half, "__code__", (lambda x: 0.25 * x).__code__),
    ):
        module = loaded(tmp_path, MODULE)
        kinds = (numba.typeof(module.Effect(1.0)), numba.float64)
        assert contents(module.loop, kinds) == contents(module.loop, kinds)
        replace(module)
        with pytest.raises(UnknownContent, match="was another"):
            contents(module.loop, kinds)


def test_the_way_of_numba_is_in_the_key(digest, monkeypatch):
    usual = digest()
    monkeypatch.setattr(numba.config, "BOUNDSCHECK", 1)
    assert digest() != usual


def test_the_key_does_not_say_where_numpy_is_installed(monkeypatch):
    """Else each virtual environment would compile all loops anew."""
    part, shown = contents_module._look(np), repr(np)
    monkeypatch.setattr(np.__spec__, "origin", "/elsewhere/numpy/__init__.py")
    assert repr(np) != shown and contents_module._look(np) == part


def test_the_key_tells_types_apart(digest):
    from psph.particles.cells import number_cells

    kinds = [(numba.float64,), (numba.float32,), (numba.float64[::1],)]
    assert len({contents(number_cells, kind) for kind in kinds}) == 3


def test_what_nobody_knows_is_said():
    class Odd:
        pass

    odd = Odd()

    def loop():
        return odd

    with pytest.raises(UnknownContent, match="Odd"):
        contents(loop, ())


WATCH = """
import sys, types
from numba.core import bytecode
from numba.core.dispatcher import _FunctionCompiler
from psph.engine import contents
from psph.__main__ import main

ran, compile_it, identify = set(), _FunctionCompiler.compile, bytecode.FunctionIdentity.from_function.__func__

def is_ours(code):
    return "/psph/" in code.co_filename and "/psph/engine/" not in code.co_filename

def called(frame, event, argument):
    if event == "call" and is_ours(frame.f_code):
        ran.add(frame.f_code)

def watched(self, arguments, returns):
    before = sys.getprofile()
    sys.setprofile(called)
    try:
        return compile_it(self, arguments, returns)
    finally:
        sys.setprofile(before)

def identified(cls, function):
    if is_ours(function.__code__):
        ran.add(function.__code__)
    return identify(cls, function)

_FunctionCompiler.compile = watched
bytecode.FunctionIdentity.from_function = classmethod(identified)
main(sys.argv[1:])
known = [one.value for one in contents._seen.values() if isinstance(one.value, types.FunctionType)]
seen = {code for one in known for code in contents._codes(one.__code__)}
print(f"{len(ran)} parts;", *(f"{code.co_filename}:{code.co_firstlineno}" for code in ran - seen))
"""


@LONG
@pytest.mark.parametrize(
    "case",
    ["dam_break_3d", "floating_box", "solids/taylor_bar", "soils/column_collapse", "mud/grains_on_slope"],
)
def test_the_key_has_all_that_numba_compiles_or_asks(case, tmp_path):
    """Every line of psph that runs while numba compiles a scene's loops stands in some loop's contents."""
    path = Path(__file__).parents[2] / f"run/cases/{case}.toml"
    job = subprocess.run(
        [sys.executable, "-c", WATCH, path, "--out", tmp_path / "out", "--set", "time.end=1e-6"],
        env=clean_environment() | {"PSPH_CACHE": str(tmp_path / "cache")},
        capture_output=True,
        text=True,
        timeout=400,
    )
    assert job.returncode == 0, job.stderr
    parts, _, missing = job.stdout.splitlines()[-1].partition(" parts;")
    assert int(parts) > 60 and not missing.strip(), missing  # it has watched
