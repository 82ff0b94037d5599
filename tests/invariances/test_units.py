"""A scene in units that are powers of two of others gives the same bits; lengths are multiplied by powers of four,
since some constants are roots of a length."""

import copy

import numpy as np
import pytest
from invariances.running import after, matched
from invariances.scenes import SCENES
from invariances.transforms import Units
from long import LONG, long_but_for

SHORT = ("tank",)
"""The rest is long."""

OTHER = Units(length=16.0, mass=2.0**-5, time=4.0)


@pytest.mark.parametrize("name", long_but_for(SHORT, SCENES))
def test_other_units_change_no_bit(tmp_path, name):
    one, other = (after(tables, tmp_path, 30) for tables in (SCENES[name], OTHER.of(SCENES[name])))
    rows = matched(one, other, OTHER.length * one.start)
    told = {"position": "m", "velocity": "m/s", "pressure": "Pa", "density": "kg/m3"}
    for what, unit in told.items():
        assert np.array_equal(getattr(one, what) * OTHER.factor(unit), getattr(other, what)[rows]), what
    assert one.time * OTHER.time == other.time


def test_a_length_in_another_unit_alone_is_seen(tmp_path):
    """The control: of a number that is forgotten."""
    tables = OTHER.of(SCENES["drop"])
    tables["fluids"]["water"]["density"] *= 2.0
    one, other = after(SCENES["drop"], tmp_path, 3), after(tables, tmp_path, 3)
    assert not np.array_equal(one.pressure * OTHER.factor("Pa"), other.pressure)


@LONG
@pytest.mark.parametrize("potential", ("on", "off"))
def test_roots_of_lengths_stand_in_the_local_potential_alone(tmp_path, potential):
    """Lengths twice as large: the height of the potential's core is √(dx …), so that its rounding changes."""
    tables = copy.deepcopy(SCENES["tank"])
    if potential == "off":
        tables.setdefault("physics", {})["local_potential"] = "off"
    unit = Units(length=2.0, mass=1.0, time=1.0)
    one, other = (after(of, tmp_path, 30) for of in (tables, unit.of(tables)))
    rows = matched(one, other, unit.length * one.start)
    same = np.array_equal(one.velocity * unit.factor("m/s"), other.velocity[rows])
    assert same == (potential == "off")
