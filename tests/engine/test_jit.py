"""The compile cache: it cannot go stale, and nothing foreign gets into it."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from jobs import clean_environment
from long import LONG

from psph.engine import jit
from psph.engine.cache import IN_USE, KEPT, Cache
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


def script(folder, *arguments, cache="cache"):
    """What the script prints, with its compiled loops in ``folder``."""
    path = folder / "script.py"
    path.write_text(SCRIPT)
    job = subprocess.run(
        [sys.executable, path, *arguments],
        capture_output=True,
        text=True,
        env=clean_environment() | {"PSPH_CACHE": str(folder / cache)},
    )
    assert job.returncode == 0, job.stderr
    return job.stdout.splitlines()


def test_a_second_process_compiles_nothing(tmp_path):
    assert script(tmp_path) == ["1.0", "0 from the cache"]
    assert script(tmp_path) == ["1.0", "1 from the cache"]


def test_an_effect_of_a_script_leaves_the_cache_as_it_is(tmp_path):
    assert script(tmp_path, "foreign") == ["1.0", "14.0", "0 from the cache"]
    assert script(tmp_path) == ["1.0", "1 from the cache"]
    assert script(tmp_path, "foreign")[:2] == ["1.0", "14.0"]


def test_the_cache_follows_the_sources(tmp_path, monkeypatch):
    """An edit in any file gives another folder, and so compiles anew."""
    package = tmp_path / "psph"
    (package / "physics").mkdir(parents=True)
    (package / "jit.py").write_text("a = 1\n")
    effect = package / "physics" / "effect.py"
    effect.write_text("b = 1\n")
    monkeypatch.setattr(jit, "__file__", str(package / "jit.py"))
    before = jit.source_digest()
    assert jit.source_digest() == before
    effect.write_text("b = 2\n")
    assert jit.source_digest() != before
    effect.write_text("b = 1\n")
    assert jit.source_digest() == before
    effect.rename(Path(effect).with_name("other.py"))
    assert jit.source_digest() != before


def test_without_a_writable_cache_loops_are_compiled_for_this_process(tmp_path):
    (tmp_path / "file").touch()
    assert script(tmp_path, cache="file/cache") == ["1.0", "0 from the cache"]
    trouble = jit.Cache(tmp_path / "file/cache" / jit.SOURCES).trouble
    assert "PSPH_CACHE" in trouble and str(tmp_path / "file/cache") in trouble and "\n" not in trouble


HOLD = """
import sys
from pathlib import Path
from psph.engine.cache import Cache
cache = Cache(Path(sys.argv[1]))
print("held", flush=True)
sys.stdin.read()
"""


def test_older_folders_are_removed_unless_in_use(tmp_path):
    names = [f"{n:016x}" for n in range(KEPT + 5)]
    for age, name in enumerate(reversed(names)):
        Cache(tmp_path / name).close()
        (tmp_path / name / "loop.nbc").touch()
        os.utime(tmp_path / name / IN_USE, (1e9 - age, 1e9 - age))
    (tmp_path / "mine").mkdir()
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path / names[0]],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=clean_environment(),
    )
    with holder:
        assert holder.stdout.readline() == "held\n"
        os.utime(tmp_path / names[0] / IN_USE, (1e8, 1e8))  # the oldest, but in use
        own = Cache(tmp_path / ("f" * 16))
        own.prune()
        left = {path.name for path in tmp_path.iterdir()}
        assert left == {"mine", "f" * 16, names[0], *names[-KEPT:]}
        assert (tmp_path / names[0] / "loop.nbc").exists()
        holder.stdin.close()
    own.prune()
    assert not (tmp_path / names[0]).exists()
    own.close()


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
