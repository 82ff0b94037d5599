"""Which runs a study makes."""

import pytest

from psph.lab.errors import StudyError
from psph.lab.study.ladder import groups, name_of, overrides, rows, wanted


def test_what_varies_comes_from_the_case_or_the_command_line():
    assert wanted({"space.spacing": (0.2, 0.1)}, []) == {"space.spacing": [0.2, 0.1]}
    given = ["space.spacing=0.02,0.01", "space.kernel=cubic, wendland-c2", "a.b=true,off"]
    assert wanted({"time.cfl": (0.1, 0.2)}, given) == {
        "space.spacing": [0.02, 0.01],
        "space.kernel": ["cubic", "wendland-c2"],
        "a.b": [True, "off"],
    }


@pytest.mark.parametrize(
    ("table", "given", "says"),
    [
        ({}, [], "nothing varies"),
        ({"space.spacing": (0.1,)}, [], "one value only, 0.1"),
        ({}, ["space.spacing=0.1,0.1"], "one value only"),
        ({}, ["space.spacing=0.1,0.2,0.1"], "appears twice"),
        ({}, ["space.refine[0].factor=1,2", "space.refine.0.factor=2,4"], "given twice"),
        ({}, ["space.spacing"], "write it as key=value,value"),
        ({}, ["=1,2"], "write it as key=value,value"),
    ],
)
def test_no_ladder(table, given, says):
    with pytest.raises(StudyError, match=says):
        wanted(table, given)


def test_one_at_a_time_or_all_together():
    vary = {"space.spacing": [0.01, 0.04, 0.02], "space.kernel": ["cubic", "quintic"]}
    one = rows(vary, grid=False)
    assert [r["space.spacing"] for r in one] == [0.04, 0.02, 0.01, 0.02, 0.02]
    assert [r.get("space.kernel") for r in one] == [None, None, None, "cubic", "quintic"]
    assert len(rows(vary, grid=True)) == 6 and rows(vary, grid=True)[0]["space.spacing"] == 0.04
    assert rows({"time.cfl": [0.1, 0.2]}, grid=False) == [{}, {"time.cfl": 0.1}, {"time.cfl": 0.2}]


def test_off_alone_is_with_and_without():
    """And no key of what is off is said."""
    assert rows(wanted({"space.refine": ("off",)}, []), grid=False) == [{}, {"space.refine": "off"}]
    given = wanted({}, ["space.refine=off", "space.refine[0].factor=2,4", "space.refined=1,2"])
    found = [overrides(row) for row in rows(given, grid=True)]
    for factor in ("2", "4"):
        assert [f"space.refine[0].factor={factor}", "space.refined=1"] in found
    assert found.count(["space.refine=off", "space.refined=1"]) == 1 and len(found) == 6


def test_a_name_tells_a_key_from_others_that_end_alike():
    keys = ["space.refine[0].factor", "space.refine[1].factor", "space.spacing", "a.time_scale"]
    assert name_of({keys[0]: 2, keys[1]: 4}, keys) == "refine[0].factor 2, refine[1].factor 4"
    assert name_of({keys[1]: 4}, keys[1:]) == "factor 4" and name_of({keys[3]: 1}, keys) == "time scale 1"


def test_settings_are_told_apart_and_together():
    settings = {"space.spacing": 0.01, "physics.artificial_viscosity": "off", "a": True}
    assert overrides(settings) == ["space.spacing=0.01", "physics.artificial_viscosity=off", "a=true"]
    assert name_of(settings) == "spacing 0.01, artificial viscosity off, a true"
    every = rows({"space.spacing": [0.2, 0.1], "k": [1, 2]}, grid=True)
    assert [(shared, len(places)) for shared, places in groups(every)] == [({"k": 1}, 2), ({"k": 2}, 2)]
