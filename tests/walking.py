"""Steps cases in plain Python: lines of JSON on standard input, ``{"path": ..., "sets": [...]}``.

``python tests/walking.py`` in an environment with ``NUMBA_DISABLE_JIT=1``.  Answers each with a digest of the
particles of each group after some steps, or with ``{"trouble": ...}``.
"""

import hashlib
import json
import sys
import traceback
import warnings

import numpy as np
from gauging import started

from psph.case import load

STEPS = 3


def walked(path: str, sets: list[str]) -> dict[str, str]:
    """A digest for each group of a case, by its name, after ``STEPS`` steps."""
    simulation, scene = started(load(path, sets))
    for _ in range(STEPS):
        simulation.step()
    store = simulation.store
    order = np.argsort(store.shown("id"))
    group = store.shown("group")[order]
    found = {}
    for number, one in enumerate(scene.species):
        digest = hashlib.sha256()
        for name in ("position", "velocity", "density"):
            digest.update(np.ascontiguousarray(store.shown(name)[order][group == number]).tobytes())
        found[one.name] = digest.hexdigest()[:16]
    return found


def main() -> None:
    """Answer until there are no more lines."""
    warnings.simplefilter("ignore", RuntimeWarning)
    for line in sys.stdin:
        asked = json.loads(line)
        try:
            answer = walked(asked["path"], asked["sets"])
        except Exception:
            answer = {"trouble": traceback.format_exc()}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
