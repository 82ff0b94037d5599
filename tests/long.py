"""Tests that `run/tests` leaves out and `run/tests --long` runs: the rest of a table, slow proofs."""

import pytest

LONG = pytest.mark.long


def long_but_for(short, values, name=str):
    """``values`` for a parametrisation; those whose ``name`` is not in ``short`` are long."""
    return [v if name(v) in short else pytest.param(v, marks=LONG) for v in values]
