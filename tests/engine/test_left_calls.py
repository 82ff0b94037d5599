"""Loops hold no calls of formulas: these would round differently where a loop comes from the cache."""

import gc
import json
import os
import re
import subprocess
import sys

import pytest
from contacts import BLOCKS
from drafts import draft
from jobs import clean_environment
from long import LONG

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


def left(path, *sets) -> dict[str, list[str]]:
    """Of the loops that sum over pairs, in a process without any in its cache, what is left as calls."""
    from gauging import started
    from numba.core.dispatcher import Dispatcher

    from psph.case import load

    started(load(path, sets), 2)
    found = {}
    for loop in (one for one in gc.get_objects() if isinstance(one, Dispatcher)):
        if loop.__module__ in ("psph.simulation.pairs", "psph.simulation.solid_pairs"):
            for signature in loop.signatures:
                names = set(BESIDE.findall(loop.inspect_llvm(signature)))
                found[loop.__name__] = sorted(n for n in names if not re.search(rf"\d{loop.__name__}B\d", n))
    return found


@LONG
@pytest.mark.parametrize("dimensions", (2, 3))
@pytest.mark.parametrize(("text", "sets"), ((BLOCKS, CLASH), (SAND, ())), ids=("clash", "sand"))
def test_no_formula_is_left_as_a_call(text, sets, dimensions, tmp_path):
    """Solids that met with friction had other bits in a run that compiled their loop than in one after it."""
    case = draft(tmp_path, text if dimensions == 2 else drawn_out(text, 1.0), *sets)
    folders = os.pathsep.join([os.path.dirname(os.path.dirname(__file__)), *sys.path])
    environment = clean_environment() | {"PSPH_CACHE": str(tmp_path / "cache"), "PYTHONPATH": folders}
    code = "import json, sys; from engine.test_left_calls import left; print(json.dumps(left(*sys.argv[1:])))"
    asked = [sys.executable, "-c", code, str(case.file), *sets]
    done = subprocess.run(asked, env=environment, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout.splitlines()[-1])
    assert "sum_over_neighbours" in found
    assert not any(found.values()), found
