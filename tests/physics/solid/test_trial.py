"""Laws of elasticity whose parts do not fit each other are found out."""

import pytest
from physics.solid.test_laws import RUBBERS

from psph.physics.solid.rubber import MooneyRivlin
from psph.physics.solid.trial import misfit


@pytest.mark.parametrize("law", RUBBERS, ids=lambda law: type(law).__name__)
def test_laws_that_fit(law):
    assert misfit(law) is None


def test_a_law_without_an_energy():
    class Lacking(MooneyRivlin):
        energy = None

    assert misfit(Lacking(3e5, 1e5, 4e6)) == "has no energy()"


def changed(name, how):
    """A law one of whose answers is changed."""
    return type(
        "Changed", (MooneyRivlin,), {name: lambda self, *a: how(getattr(MooneyRivlin, name)(self, *a))}
    )(3e5, 1e5, 4e6)


@pytest.mark.parametrize(
    "name, how, says",
    (
        ("moduli", lambda told: (2.0 * told[0], told[1]), "has moduli() of"),
        ("stress", lambda told: tuple(x + 1e5 for x in told), "has a stress of 1e+05 Pa at rest in 2D"),
        ("stress", lambda told: (float("nan"), *told[1:]), "has a stress of nan Pa at rest in 2D"),
        ("energy", lambda told: 1.1 * told, "where its energy grows by"),
        ("across", lambda told: 0.5 * told, "its stress at rest in 2D grows by"),
        ("stress", lambda told: told.shaer, "cannot be tried: 'tuple' object has no attribute 'shaer'"),
    ),
)
def test_a_law_that_contradicts_itself(name, how, says):
    assert says in misfit(changed(name, how))
