"""Work for the compile cache in a copy of the process."""

import subprocess
import sys

import pytest
from jobs import clean_environment

BOTH = """
import os, sys, threading
from pathlib import Path
from psph.engine.beside import beside

os.sched_getaffinity = lambda _: {0, 1}
folder = Path(sys.argv[1])

def work():
    (folder / "of").write_text(str(os.getpid()))
    print("work says something")

with beside(work) as shared:
    assert shared
assert int((folder / "of").read_text()) != os.getpid()

def fail():
    raise OSError("a full disk")

with beside(fail) as shared:
    assert shared

try:
    with beside(lambda: threading.Event().wait()):
        raise KeyboardInterrupt
except KeyboardInterrupt:
    pass
try:
    os.waitpid(-1, os.WNOHANG)
except ChildProcessError:
    print("none is left")

(folder / "of").unlink()
over = threading.Event()
threading.Thread(target=over.wait).start()
with beside(work) as shared:
    assert not shared
over.set()
os.sched_getaffinity = lambda _: {0}
with beside(work) as shared:
    assert not shared
assert not (folder / "of").exists()
"""


def test_work_is_done_in_a_copy_where_a_core_is_free_and_nothing_of_it_is_left(tmp_path):
    done = subprocess.run([sys.executable, "-c", BOTH, tmp_path], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "none is left\n", "")


COMPILED = """
import os, sys
from mpi4py import MPI
from psph.case import load
from psph.engine.cache import Cache
from psph.runs import setup
from psph.scene import Scene
from psph.simulation.plan import make_plan

os.sched_getaffinity = lambda _: set(range(int(sys.argv[1])))
with open(sys.argv[2], "w") as file:
    file.write(sys.argv[3])
saved, save = [], Cache.save
Cache.save = lambda self, name, kept: (saved.append(name), save(self, name, kept))
scene = Scene(load(sys.argv[2]))
setup.compile_ahead(scene, make_plan(scene), MPI.COMM_SELF)
folder = setup.CACHE.folder
print(len(saved), len(list(folder.glob("*.loop"))), len(list(folder.glob("*.ready"))))
"""


COLUMN = """
scheme = "sph"
space = { dimensions = 1, spacing = 0.1 }
time.end = 1.0
physics.sound_speed = 20.0
fluids.water.shape.box = { lower = [0.0], upper = [1.0] }
"""


@pytest.mark.parametrize("cores", [1, 2])
def test_one_rank_lets_a_copy_compile_the_loops_over_pairs(cores, tmp_path):
    """The control has a single core: it compiles all itself."""
    environment = clean_environment() | {
        "PSPH_CACHE": str(tmp_path / "cache"),
        "PYTHONPATH": ":".join(sys.path),
    }
    done = subprocess.run(
        [sys.executable, "-c", COMPILED, str(cores), tmp_path / "column.toml", COLUMN],
        capture_output=True,
        text=True,
        timeout=200,
        env=environment,
    )
    assert (done.returncode, done.stderr) == (0, "")
    saved, kept, ready = map(int, done.stdout.split())
    assert ready == 1 and kept > 5
    assert (saved < kept) == (cores == 2)
