"""The loops of a step read the types of their arguments once, and these never change."""

from pathlib import Path
from typing import NamedTuple

import numba
import pytest
from gauging import start
from numba.core.dispatcher import Dispatcher

from psph.case import load
from psph.engine import settled

CASES = Path(__file__).parents[2] / "run" / "cases"
SCENES = {"taylor_green": ("hard/taylor_green.toml", 0.1), "dam_break": ("dam_break.toml", 0.05)}
STEPS = 30


class Span(NamedTuple):
    """What numba reads in Python."""

    lower: float


def simulation_of(scene, *changes):
    name, spacing = SCENES[scene]
    return start(load(CASES / name, [f"space.spacing={spacing}", *changes]))


@pytest.mark.parametrize("scene", SCENES)
def test_a_step_asks_numba_for_no_type_in_python(scene, monkeypatch):
    """What numba reads in Python, named tuples among others, takes as long as a hundred particles do."""
    simulation = simulation_of(scene)
    for _ in range(3):
        simulation.step()
    simulation.rebuild()
    asked = []
    read = Dispatcher.typeof_pyval
    monkeypatch.setattr(
        Dispatcher, "typeof_pyval", lambda self, value: (asked.append(value), read(self, value))[1]
    )
    numba.njit(lambda span: span.lower)(Span(1.0))
    assert Span(1.0) in asked  # such a reading is seen
    asked.clear()
    simulation.rebuild()
    for _ in range(STEPS):
        simulation.step()
    assert asked == []


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("precision", ("double", "mixed"))
def test_the_types_of_a_settled_loop_stay_as_they_were(scene, precision, monkeypatch):
    first, calls = {}, []

    class Watched(settled.Settled):
        def __call__(self, *args):
            kinds = tuple(map(numba.typeof, args))
            assert first.setdefault(self, kinds) == kinds
            calls.append(self)
            return super().__call__(*args)

    monkeypatch.setattr(settled, "Settled", Watched)
    simulation = simulation_of(scene, f"precision={precision}")
    for _ in range(STEPS):
        simulation.step()
    simulation.settle_pressure()
    assert len(first) >= 4 and len(calls) > 3 * STEPS
