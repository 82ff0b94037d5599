"""Loops hold no calls of formulas: these would round differently where a loop comes from the cache."""

import gc
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from contacts import BLOCKS
from drafts import draft
from jobs import clean_environment
from long import LONG, long_but_for

CASES = Path(__file__).parents[2] / "run" / "cases"

CLASH = "physics.contact.friction=0.5", "physics.contact.damping=0.2", "solids.left.damping=10.0"

SAND = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, -9.8]
[soils.sand]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
density = 1800.0
young = 2e6
poisson = 0.3
friction_angle = 30.0
[walls.floor]
shape.box = { lower = [-0.5, -0.5], upper = [1.5, 0.0] }
no_slip = true
[walls.side]
shape.box = { lower = [1.0, 0.0], upper = [1.5, 1.0] }
"""


def drawn_out(text: str, depth: float) -> str:
    """A scene drawn out along z, where it repeats."""
    text = re.sub(
        r"(lower|upper) = \[([^\]]*)\]", lambda m: f"{m[1]} = [{m[2]}, {depth * (m[1] == 'upper')}]", text
    )
    text = re.sub(r"(velocity|gravity) = \[([^\]]*)\]", r"\1 = [\2, 0.0]", text)
    ends = f"periodic = ['z'], lower = [-0.5, -0.5, 0.0], upper = [2.5, 1.5, {depth}]"
    return text.replace("dimensions = 2", f"dimensions = 3, {ends}")


BESIDE = re.compile(r'call [^@\n]*@"?_ZN((?!\d+numba)[^"(]*)')
"""A call of a compiled function of psph, in the code that LLVM reads."""


HELD = re.compile(r"call [^\n]*@NRT_incref")
"""A holder more of an array, counted in a loop: with 68 of them at each particle a kick took 700 ns, not 5."""


ONE_PASS, TWO_PASSES = {"kick_drift_predict"}, {"kick_to_middle", "drift_to_end"}
EACH_STEP = {"kick", "state_of", "sum_over_neighbours", *ONE_PASS, *TWO_PASSES}
"""Loops over all particles in each step."""


def loops_of(path, *sets):
    """All loops of a case, in a process without any in its cache."""
    from gauging import started
    from numba.core.dispatcher import Dispatcher

    from psph.case import load

    started(load(path, sets), 2)
    return [one for one in gc.get_objects() if isinstance(one, Dispatcher) and one.signatures]


def left(path, *sets) -> dict[str, list[str]]:
    """Of the loops that sum over pairs what is left as calls."""
    found = {}
    for loop in loops_of(path, *sets):
        if loop.__module__ in ("psph.simulation.pairs", "psph.simulation.solid_pairs"):
            for signature in loop.signatures:
                names = set(BESIDE.findall(loop.inspect_llvm(signature)))
                found[loop.__name__] = sorted(n for n in names if not re.search(rf"\d{loop.__name__}B\d", n))
    return found


def held(path, *sets) -> dict[str, int]:
    """How many holders of arrays the loops over columns and pairs count."""
    found = {}
    for loop in loops_of(path, *sets):
        if (loop.__module__ or "").startswith("psph.simulation."):
            texts = map(loop.inspect_llvm, loop.signatures)
            found[loop.__name__] = max(len(HELD.findall(text)) for text in texts)
    return found


def asked(what: str, case, cache, *sets) -> dict:
    """What one of these functions says in a process of its own."""
    folders = os.pathsep.join([os.path.dirname(os.path.dirname(__file__)), *sys.path])
    environment = clean_environment() | {"PSPH_CACHE": str(cache), "PYTHONPATH": folders}
    code = f"import json, sys; from engine.test_left_calls import {what}; print(json.dumps({what}(*sys.argv[1:])))"
    words = [sys.executable, "-c", code, str(case), *sets]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize(
    "name",
    long_but_for(
        ["moving_square"],
        [
            "moving_square",
            "machines/gear_pump",
            "floating_box",
            "coast/overtopping",
            "refined/block_in_waves",
        ],
    ),
)
def test_no_loop_counts_who_holds_its_arrays(name, tmp_path):
    found = asked("held", CASES / f"{name}.toml", tmp_path / "cache")
    each = EACH_STEP & set(found)
    assert each >= {"kick", "sum_over_neighbours"} and (each >= ONE_PASS or each >= TWO_PASSES)
    assert not any(found.get(loop, 0) for loop in EACH_STEP), found


@LONG
@pytest.mark.parametrize("dimensions", (2, 3))
@pytest.mark.parametrize(("text", "sets"), ((BLOCKS, CLASH), (SAND, ())), ids=("clash", "sand"))
def test_no_formula_is_left_as_a_call(text, sets, dimensions, tmp_path):
    """Solids that met with friction had other bits in a run that compiled their loop than in one after it."""
    case = draft(tmp_path, text if dimensions == 2 else drawn_out(text, 1.0), *sets)
    found = asked("left", case.file, tmp_path / "cache", *sets)
    assert "sum_over_neighbours" in found
    assert not any(found.values()), found
