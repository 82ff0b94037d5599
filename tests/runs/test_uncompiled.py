"""A formula of a user's file that does not compile is one line: file, line, what to write instead."""

import pytest
from drafts import TANK, draft
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


def test_faults_of_psph_itself_keep_their_traceback():
    from numba.core.errors import TypingError

    from psph.vectors import dot

    def fault():
        raise TypingError(f"no such thing; at {dot.__code__.co_filename} (12)")

    with pytest.raises(TypingError), in_one_line():
        fault()
