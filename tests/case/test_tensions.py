"""Tensions of a case: which fluids have one, and what is refused."""

import pytest
from drafts import draft, refusal

from psph.case.tensions import tensions_in

DROP = """
space = { dimensions = 2, spacing = 0.1, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [3.0, 3.0] }
time.end = 1.0
physics.sound_speed = 10.0
[fluids.water]
shape.disc = { center = [1.0, 1.0], radius = 0.5 }
[fluids.oil]
shape.disc = { center = [2.0, 2.0], radius = 0.5 }
"""
AIR = "fluids.air={shape={disc={center=[1.0,2.0],radius=0.3}}}"
WALL = "walls.side={shape={box={lower=[0.0,0.0],upper=[3.0,0.3]}}}"
MIRROR = "walls.side={shape={box={lower=[0.0,0.0],upper=[3.0,0.3]}},condition='mirror'}"
MEMORY = "walls.side.contact_angle={advancing=110.0,receding=70.0}"
BETWEEN = "fluids.water.interfacial_tension={oil=0.03}"


def test_each_fluid_knows_its_own_and_those_of_its_pairs(tmp_path):
    case = draft(
        tmp_path,
        DROP,
        AIR,
        "fluids.water.surface_tension=0.07",
        "fluids.water.interfacial_tension={oil=0.03,air=0.072}",
        "fluids.air.interfacial_tension={oil=0.02}",
    )
    assert tensions_in(case) == {
        "water": (0.07, 0.0, 0.03, 0.072),
        "oil": (0.0, 0.03, 0.0, 0.02),
        "air": (0.0, 0.072, 0.02, 0.0),
    }
    assert set(tensions_in(draft(tmp_path, DROP)).values()) == {()}


@pytest.mark.parametrize(
    "keys, says",
    [
        (("fluids.water.surface_tension=-1.0",), "fluids.water.surface_tension: -1.0"),
        (("fluids.water.interfacial_tension={oil=-1.0}",), "fluids.water.interfacial_tension.oil: -1.0"),
        (
            ("fluids.water.surface_tension=0.07",),
            "fluids.water.surface_tension: no tension between water and oil, while others are told; give "
            "fluids.water.interfacial_tension.oil in N/m, 0 for none",
        ),
        (
            (AIR, BETWEEN, "fluids.air.interfacial_tension={water=0.07}"),
            "fluids.water.interfacial_tension: no tension between oil and air, while others are told; give "
            "fluids.oil.interfacial_tension.air in N/m, 0 for none",
        ),
        (
            (BETWEEN, "fluids.oil.interfacial_tension={water=0.04}"),
            "fluids.water.interfacial_tension.oil: 0.03: fluids.oil.interfacial_tension.water is 0.04; remove "
            "one of the two",
        ),
        (
            ("fluids.water.interfacial_tension={oli=0.03,oil=0.03}",),
            "fluids.water.interfacial_tension.oli: 0.03: no fluid has this name; did you mean 'oil'?",
        ),
        (
            ("fluids.water.interfacial_tension={water=0.03,oil=0.03}",),
            "fluids.water.interfacial_tension.water: 0.03: the fluid itself; give its tension at a free "
            "surface as surface_tension",
        ),
        (
            (
                BETWEEN,
                "soils.mud={shape={disc={center=[2.0,1.0],radius=0.3}},density=1900.0,young=1e6,poisson=0.3,"
                "friction_angle=30.0,geostatic=false}",
            ),
            "fluids.water.interfacial_tension: surface tension knows no soil",
        ),
        (
            (WALL, "walls.side.contact_angle=60.0"),
            "walls.side.contact_angle: 60.0: no fluid has a tension; give fluids.NAME.surface_tension, or remove "
            "this key",
        ),
        (
            (BETWEEN, WALL, "walls.side.contact_angle=180.0"),
            "walls.side.contact_angle: 180.0 is out of range",
        ),
        (
            (BETWEEN, WALL, "walls.side.contact_angle={advancing=60.0,receding=70.0}"),
            "walls.side.contact_angle: receding is above advancing",
        ),
        (
            (BETWEEN, WALL, "walls.side.contact_angle={advancing=60.0}"),
            "walls.side.contact_angle.receding: missing",
        ),
        (
            (BETWEEN, "fluids.oil.surface_tension=0.1", WALL, MEMORY),
            "walls.side.contact_angle: walls remember the lines of the heaviest fluid alone; give one angle, or",
        ),
        (
            (BETWEEN, MIRROR, MEMORY),
            "walls.side.contact_angle: surfaces meet a mirror at 90 degrees; take another condition, or",
        ),
        (
            (BETWEEN, MIRROR, "walls.side.contact_angle=60.0"),
            "walls.side.contact_angle: 60.0: surfaces meet a mirror at 90 degrees; take another condition, or "
            "remove this key",
        ),
    ],
)
def test_what_cannot_be_is_refused_with_key_value_and_cure(tmp_path, keys, says):
    lines = refusal(tmp_path, DROP, *keys)
    assert any(says in line for line in lines), lines
    assert all(line.startswith("case.toml with --set ") for line in lines)
