"""The compile cache: it cannot go stale, and keeps what nothing has changed."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from jobs import clean_environment
from long import LONG

from psph.engine import cache
from psph.engine.cache import LOOP, Cache
from psph.output.reader import Run

SCRIPT = """
import sys
from typing import NamedTuple
from psph.engine.jit import call_by_type, compiled
from psph.simulation.integrator import state_of
from psph.simulation.rules import Columns, Rules
from psph.fields import view_of
from psph.physics.fluid.state import Linear
import numpy as np

class Foreign(NamedTuple):
    def pressure(self, density, rest_density, sound_speed):
        return 7.0 * density

View = view_of(("position", "rest_density", "sound_speed"))
view = View((np.zeros(3),), 1.0, 1.0)
for state in (Linear(), Foreign()) if "foreign" in sys.argv else (Linear(),):
    pressure = np.zeros(3)
    first = np.zeros(3, np.uint8)
    rules = Rules((), (state,), first, first > 0, np.uint8(1), (), first, None, None, None, (None,))
    columns = dict.fromkeys(Columns._fields) | {
        "group": first, "density": np.full(3, 2.0), "specific_volume": np.zeros(3), "pressure": pressure
    }
    state_of(0, 3, rules, view, Columns(**columns))
    print(pressure[0])
print(sum(state_of.stats.cache_hits.values()), "from the cache")
"""


def script(folder, *arguments, cache="cache", edit=("", "")):
    """What the script prints, with its compiled loops in ``folder``; ``edit``: words, and others for them."""
    path = folder / "script.py"
    path.write_text(SCRIPT.replace(*edit) if edit[0] else SCRIPT)
    job = subprocess.run(
        [sys.executable, path, *arguments],
        capture_output=True,
        text=True,
        env=clean_environment() | {"PSPH_CACHE": str(folder / cache)},
    )
    assert job.returncode == 0, job.stderr
    return job.stdout.splitlines()


def test_a_second_process_compiles_nothing_and_loads_no_compiler(tmp_path):
    """The implementations of all that could be compiled take longer to load than all loops."""
    edit = ('"from the cache"', '"from the cache", "numba.np.npyimpl" in sys.modules')
    assert script(tmp_path, edit=edit) == ["1.0", "0 from the cache True"]
    assert script(tmp_path, edit=edit) == ["1.0", "1 from the cache False"]


def test_an_effect_of_a_script_is_compiled_once(tmp_path):
    assert script(tmp_path, "foreign") == ["1.0", "14.0", "0 from the cache"]
    assert script(tmp_path, "foreign") == ["1.0", "14.0", "2 from the cache"]
    assert script(tmp_path) == ["1.0", "1 from the cache"]


def test_an_effect_with_something_unknown_in_it_is_compiled_each_time(tmp_path):
    """``density`` is a word of the loop too."""
    edit = ("    def pressure", "    density = object()\n\n    def pressure")
    for _ in range(2):
        assert script(tmp_path, "foreign", edit=edit)[:2] == ["1.0", "14.0"]
    assert script(tmp_path) == ["1.0", "1 from the cache"]


def test_an_edited_effect_of_a_script_is_compiled_anew(tmp_path):
    assert script(tmp_path, "foreign")[1] == "14.0"
    assert script(tmp_path, "foreign", edit=("7.0", "9.0")) == ["1.0", "18.0", "1 from the cache"]


@pytest.mark.parametrize("spoil", [lambda of: of[:-100], lambda of: of[:3000] + bytes(3000) + of[6000:]])
def test_a_loop_that_cannot_be_read_is_compiled_anew(tmp_path, spoil):
    """The second is a page that was never written: it would be run as code."""
    script(tmp_path)
    for kept in (tmp_path / "cache").rglob(f"*{LOOP}"):
        kept.write_bytes(spoil(kept.read_bytes()))
    assert script(tmp_path) == ["1.0", "0 from the cache"]
    assert script(tmp_path) == ["1.0", "1 from the cache"]


def test_without_a_writable_cache_loops_are_compiled_for_this_process(tmp_path):
    (tmp_path / "file").touch()
    assert script(tmp_path, cache="file/cache") == ["1.0", "0 from the cache"]
    trouble = Cache(tmp_path / "file/cache/build").trouble
    assert "PSPH_CACHE" in trouble and str(tmp_path / "file/cache") in trouble and "\n" not in trouble


def test_what_was_used_longest_ago_makes_room(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "MOST_BYTES", 300)
    own, other = Cache(tmp_path / "own"), Cache(tmp_path / "other")
    for age, (where, name) in enumerate(((other, "oldest"), (own, "used"), (own, "newer"))):
        where.save(name, b"x" * 80)
        os.utime(where.folder / f"{name}{LOOP}", (1e9 + age, 1e9 + age))
    assert own.load("used") == b"x" * 80
    (tmp_path / "mine.txt").touch()
    own.prune()
    left = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*")}
    assert left == {"mine.txt", f"own/used{LOOP}", f"own/newer{LOOP}"}


@LONG
def test_who_compiles_gets_the_bits_of_who_loads(tmp_path):
    """A metal has the longest formulas: they were once called, not written into the loop."""
    case = Path(__file__).parents[2] / "run/cases/solids/plate_impact.toml"
    frames = []
    for name in ("compiling", "loading"):
        words = ["-m", "psph", str(case), "--out", str(tmp_path / name), "--set", "time.end=4e-7"]
        job = subprocess.run(
            [sys.executable, *words],
            env=clean_environment() | {"PSPH_CACHE": str(tmp_path / "cache")},
            capture_output=True,
            text=True,
            timeout=150,
        )
        assert job.returncode == 0, job.stderr
        frames.append(Run(tmp_path / name).frame(-1))
    assert frames[0]["plastic_strain"].max() > 0.0
    for name, values in frames[0].items():
        assert np.array_equal(values, frames[1][name]), name
