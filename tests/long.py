"""Tests that `run/tests` leaves out and `run/tests --long` runs: the rest of a table, slow proofs.

What they did stands in a file, and from there in docs/reliability.md: see :func:`tell`.
"""

import json
import os
import sys

import pytest

LONG = pytest.mark.long

TOLD = "PSPH_TOLD"
"""The variable that names the file of what was told, a line of JSON each; without it none."""


def long_but_for(short, values, name=str, core=()):
    """``values`` for a parametrisation; those whose ``name`` is not in ``short`` are long, and those in ``core``
    stay in `run/tests` however long they take."""
    marks = {name(v): [pytest.mark.core] if name(v) in core else [] for v in values}
    return [pytest.param(v, marks=marks[name(v)] if name(v) in short else LONG) for v in values]


def tell(what, number=1):
    """Add ``number`` to what the suite has done of ``what`` ("kills survived"); rank 0 counts."""
    _write({"what": what, "number": number, "fold": "sum"})


def tell_most(what, number):
    """Say that ``what`` ("longest time from a kill to the end of the job, s") was so much at most."""
    _write({"what": what, "number": number, "fold": "most"})


def _write(line):
    mpi = sys.modules.get("mpi4py.MPI")
    if TOLD not in os.environ or (mpi and mpi.COMM_WORLD.rank > 0):
        return
    with open(os.environ[TOLD], "a", encoding="utf-8") as file:
        file.write(json.dumps(line) + "\n")  # one write: tests in other processes tell too
