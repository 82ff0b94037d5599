"""Advice and the way keys are written."""

import pytest

from psph.case.errors import CaseError, advise, dotted


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("viscocity", "did you mean 'viscosity'?"),
        ("VISCOSITY", "did you mean 'viscosity'?"),
        ("p1", "did you mean 'P1'?"),
        ("nothing", "known here: viscosity, density, P1"),
    ],
)
def test_the_nearest_word_or_all(word, says):
    assert advise(word, ["viscosity", "density", "P1"]) == says


def test_keys_and_places():
    assert dotted(("a", "b", 0, "c")) == "a.b[0].c"


def test_the_error_is_its_lines():
    error = CaseError(iter(["one", "two"]))
    assert error.lines == ["one", "two"]
    assert str(error) == "one\ntwo"
    assert isinstance(error, ValueError)
