"""A formula of a user's file that does not compile is one line: file, line, what to write instead."""

import re

import pytest
from drafts import TANK, draft
from jobs import mpirun
from mpi4py import MPI

from psph.runs.setup import compile_ahead
from psph.runs.uncompiled import Uncompiled, in_one_line
from psph.scene import Scene
from psph.simulation.plan import make_plan

HEAD = '''
from typing import NamedTuple

import numpy as np

from psph.physics.catalogue import Catalogue, Entry
from psph.vectors import scale


class Mine(NamedTuple):
    """Something."""

    rate: float = 1.0

'''
TAIL = '\n\nCATALOGUE = Catalogue(effects=(Entry("physics.mine", Mine),))\n'

BRANCHES = '''    def radial(self, i, j, pair):
        """Coefficient."""
        if pair.r > 0.01:
            return self.rate * j.mass
        return 0.0
'''
OTHERS = '''    def body(self, i):
        """Acceleration."""
        return scale(i.velocity, -self.rate * np.linalg.norm(i.velocity))
'''


@pytest.mark.parametrize(
    "formula, says",
    [
        (BRANCHES, "mine.py: line 17: `if pair.r > 0.01:` cannot be compiled: .* use where"),
        (
            OTHERS,
            r"mine.py: line 17: `return scale\(i.velocity, .*` cannot be compiled: use numbers and tuples",
        ),
    ],
    ids=["a branch", "a function"],
)
def test_it_names_the_line_and_the_cure(tmp_path, formula, says):
    (tmp_path / "mine.py").write_text(HEAD + formula + TAIL)
    scene = Scene(draft(tmp_path, 'use = ["mine.py"]\n' + TANK, "physics.mine={}"))
    with pytest.raises(Uncompiled, match=says) as refused:
        compile_ahead(scene, make_plan(scene), MPI.COMM_SELF)
    assert "\n" not in str(refused.value) and refused.value.exit_code == 2


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        ("self.rate * np.sin(pair.r)", r"mine.py: line 17: `return .*` cannot be computed: use numbers"),
        ("self.rate * pair.r**0.5", "mine.py: line 17: .* whole powers"),
        ("self.rate * factor", "mine.py: line 17: .* name 'factor' is not defined"),
        ("None", "Mine.radial gives nothing; let it give a number"),
        ("'a'", "Mine.radial gives a str; let it give a number"),
    ],
    ids=("a sine", "a root", "a name", "nothing", "a word"),
)
def test_what_fails_before_it_is_compiled_is_a_line_too(tmp_path, formula, says):
    text = f'    def radial(self, i, j, pair):\n        """Coefficient."""\n        return {formula}\n'
    (tmp_path / "mine.py").write_text(HEAD + text + TAIL)
    (tmp_path / "case.toml").write_text('use = ["mine.py"]\n' + TANK + "[physics.mine]\n")
    job = mpirun(1, ["-m", "psph", "run", tmp_path / "case.toml", "--out", tmp_path / "out"])
    assert job.returncode == 2 and "Traceback" not in job.stderr
    assert re.search(says, job.stderr)


def test_faults_of_psph_itself_keep_their_traceback():
    from numba.core.errors import TypingError

    from psph.vectors import dot

    def fault():
        raise TypingError(f"no such thing; at {dot.__code__.co_filename} (12)")

    with pytest.raises(TypingError), in_one_line():
        fault()
