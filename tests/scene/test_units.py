"""Slips in units and signs that `check` warns of; the shipped cases have none."""

import pytest
from drafts import CHANNEL, TANK, WATER, draft

from psph.case import CaseError
from psph.scene import Scene, check


def checked(folder, text, *overrides):
    """The warnings on a text, without its folder."""
    return [w.replace(f"{folder}/case.toml: ", "") for w in check(Scene(draft(folder, text, *overrides)))]


@pytest.mark.parametrize("density, than", [(1e-3, "lighter than any gas"), (1e6, "heavier than any metal")])
def test_a_density_of_no_substance_is_warned_of(tmp_path, density, than):
    [line] = checked(tmp_path, TANK, f"fluids.water.density={density}")
    assert line == (
        f"fluids.water.density: {density:g} kg/m³ is {than}; densities are in kg/m³: water has 1000, air 1.2"
    )
    assert checked(tmp_path, TANK, "fluids.water.density=700") == []


def test_a_gas_with_a_free_surface_is_warned_of_on_earth(tmp_path):
    [line] = checked(tmp_path, TANK, "fluids.water.density=1.0")
    assert line == (
        "fluids.water.density: 1 kg/m³ is that of a gas, which has no free surface; densities are in kg/m³: "
        "water has 1000"
    )
    assert checked(tmp_path, TANK, "fluids.water.density=1.0", "physics.gravity=[0.0, -1.0]") == []
    assert checked(tmp_path, CHANNEL, "fluids.water.density=1.2", "physics.gravity=[9.81, 0.0]") == []


def test_a_viscosity_of_no_liquid_is_warned_of_on_earth(tmp_path):
    [line] = checked(tmp_path, TANK, "fluids.water.viscosity=1e-9")
    assert line.startswith("fluids.water.viscosity: 1e-09 m²/s is thinner than any liquid; ")
    assert checked(tmp_path, TANK, "fluids.water.viscosity=1.1e-7") == []
    assert checked(tmp_path, TANK, "fluids.water.viscosity=1e-9", "physics.gravity=[0.0, -1.0]") == []


def in_millimetres(text: str) -> str:
    """A tank of a metre with the millimetres of its lengths taken for metres."""
    for one, thousand in (
        ("spacing = 0.1", "spacing = 100.0"),
        ("[1.0, 0.5]", "[1000.0, 500.0]"),
        ("[-0.3, -0.3]", "[-300.0, -300.0]"),
        ("[1.3, 0.7]", "[1300.0, 700.0]"),
        ("[1.0, 0.7]", "[1000.0, 700.0]"),
    ):
        text = text.replace(one, thousand)
    return text


def test_millimetres_taken_for_metres_are_warned_of(tmp_path):
    [line] = checked(tmp_path, in_millimetres(TANK))
    assert line == (
        "walls.tank.shape: 1600 m long, and no wave flume is longer than 300 m; lengths are in m: if "
        "they were meant in mm, divide all of them by 1000"
    )
    weightless = (
        in_millimetres(TANK)
        .replace("gravity = [0.0, -9.8]", "sound_speed = 10.0")
        .replace('pressure = "hydrostatic"', "")
    )
    assert checked(tmp_path, weightless) == []  # lengths may be in any unit


@pytest.mark.parametrize("axis", ["x", "y"])
def test_gravity_that_pulls_the_fluid_out_is_warned_of(tmp_path, axis):
    """Planes of sites across either axis; only the pull towards the open top is warned of."""
    slab = f"parallel.axis={axis}"
    still = TANK.replace('pressure = "hydrostatic"', "pressure = 0.0")
    [line] = checked(tmp_path, still, slab, "physics.gravity=[0.0, 9.8]")
    assert line == (
        "physics.gravity: [0.0, 9.8] m/s² pulls towards +y, where no wall holds 100% of the fluid: it "
        "falls for ever; turn gravity round, or give a wall there"
    )
    for gravity in ("[0.0, -9.8]", "[9.8, 0.0]", "[-9.8, 0.0]"):
        assert checked(tmp_path, still, slab, f"physics.gravity={gravity}") == []
    lid = "\n[walls.lid]\nshape.box = { lower = [-0.3, 0.7], upper = [1.3, 1.0] }"
    assert checked(tmp_path, still + lid, slab, "physics.gravity=[0.0, 9.8]") == []
    half = lid.replace("1.3, 1.0", "0.4, 1.0")  # holds four of ten columns
    [line] = checked(tmp_path, still + half, slab, "physics.gravity=[0.0, 9.8]")
    assert "no wall holds 60% of the fluid" in line


def test_gravity_without_anything_below_is_warned_of(tmp_path):
    """A wall, a plane of symmetry or a period below end the fall."""
    still = WATER + "pressure = 0.0\n"
    [line] = checked(tmp_path, still, "physics.gravity=[0.0, 9.8]")
    assert "pulls towards +y, where no wall holds 100% of the fluid: it falls for ever; turn" in line
    corners = ("space.lower=[0.0, 0.0]", "space.upper=[1.0, 1.0]")
    assert len(checked(tmp_path, still, *corners, 'space.periodic=["x"]')) == 1
    assert checked(tmp_path, still, *corners, 'space.periodic=["y"]', "time.end=0.01") == []
    floor = "\n[walls.floor]\ncondition = 'mirror'\nshape.box = { lower = [0.0, -0.3], upper = [1.0, 0.0] }"
    assert checked(tmp_path, still + floor) == []


@pytest.mark.parametrize(
    ("wall", "sets", "says"),
    [
        (
            "lower = [-200.0, -200.0], upper = [1200.0, 0.0]",
            ("space.lower=[-0.2, -0.2]", "space.upper=[1.2, 1.0]"),
            "outside the domain",
        ),
        ("lower = [-200.0, -200.0], upper = [1200.0, 500.0]", (), "overlaps fluids.water"),
        ("lower = [-200.0, -200.0], upper = [1200.0, 500.0]", ("space.spacing=1e-4",), "sites"),
    ],
)
def test_a_shape_in_millimetres_beside_others_in_metres_is_asked_about(tmp_path, wall, sets, says):
    text = WATER + f"\n[walls.w]\nshape.box = {{ {wall} }}"
    with pytest.raises(CaseError) as caught:
        checked(tmp_path, text, *sets)
    assert all(says in line for line in caught.value.lines)
    assert all(line.endswith("; is walls.w given in mm? Lengths are in m") for line in caught.value.lines)
    near = text.replace("1200.0", "1.0").replace("-200.0", "-2.0").replace("500.0", "0.3")
    with pytest.raises(CaseError) as caught:
        checked(tmp_path, near, *(sets or ("space.spacing=0.1",)))
    assert not any("mm?" in line for line in caught.value.lines)


def test_a_viscosity_that_shortens_the_time_steps_far_below_those_of_sound_is_warned_of(tmp_path):
    """The dynamic one in mPa s, or that of another unit: honey has 7e-3 m²/s."""
    found = [checked(tmp_path, WATER + f"viscosity = {nu}") for nu in (7e-3, 700.0)]
    assert not any("viscosity" in line for line in found[0])
    [told] = [line for line in found[1] if "fluids.water.viscosity" in line]
    assert "times shorter than sound does; it is the kinematic viscosity" in told


@pytest.mark.parametrize(
    ("right", "slip", "says"),
    [
        (
            "rotation = { speed = 6.28, center = [0.0, 0.0] }",
            "rotation = { speed = 360.0, center = [0.0, 0.0] }",
            "rotation.speed: 360 rad/s is 57.3 turns a second; it is in rad/s: 360 degrees/s are 6.28, 360 turns a "
            "minute 37.7",
        ),
        (
            "sinusoid = { angle = 0.35, period = 1.5, center = [0.0, 0.0] }",
            "sinusoid = { angle = -20.0, period = 1.5, center = [0.0, 0.0] }",
            "sinusoid.angle: -20 rad is -1146 degrees to each side; it is in rad: -20 degrees are -0.349",
        ),
        (
            "series = { file = 'roll.csv', angle = 'roll', angle_unit = 'degrees', center = [0.0, 0.0] }",
            "series = { file = 'roll.csv', angle = 'roll', center = [0.0, 0.0] }",
            "series.angle: swings by 10 rad, 573 degrees, and back; for a column in degrees give angle_unit = "
            '"degrees"',
        ),
        (
            "series = { file = 'roll.csv', angle = 'wheel', center = [0.0, 0.0] }",
            "series = { file = 'roll.csv', angle = 'back', center = [0.0, 0.0] }",
            "series.angle: swings by 9 rad, 515.7 degrees, and back; for a column in degrees give angle_unit = "
            '"degrees"',
        ),
    ],
)
def test_degrees_taken_for_radians_are_warned_of(tmp_path, right, slip, says):
    """A wheel that turns on and on may turn far; a swing that ends in the last row counts."""
    (tmp_path / "roll.csv").write_text(
        "time,roll,wheel,back\n0,0,0,0\n1,10,7,9\n2,-5,20,8\n", encoding="utf-8"
    )
    for motion, told in ((right, []), (slip, [f"walls.tank.motion.{says}"])):
        found = checked(tmp_path, TANK, f"walls.tank.motion={{{motion}}}", "physics.sound_speed=1e6")
        assert [line for line in found if "rad" in line] == told
        framed = checked(tmp_path, TANK, f"frame.motion={{{motion}}}", "physics.sound_speed=1e6")
        assert [line for line in framed if "rad" in line] == [
            f"frame.motion.{line}" for line in [says] if told
        ]
