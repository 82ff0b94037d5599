"""Soils of a case: what is refused, each by one line, and what is warned of."""

import pytest
from drafts import TANK, draft

from psph.case import CaseError
from psph.scene import Scene, check

SAND = (
    "soils.bank={shape={box={lower=[0.0,0.5],upper=[1.0,0.6]}}, density=1800.0, young=1e6, poisson=0.3, "
    "friction_angle=30.0}"
)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (("soils.bank.poisson=0.5",), "soils.bank.poisson"),
        (("soils.bank.poisson=-0.1",), "soils.bank.poisson"),
        (("soils.bank.young=-1e6",), "soils.bank.young"),
        (("soils.bank.density=0.0",), "soils.bank.density"),
        (("soils.bank.friction_angle=90.0",), "soils.bank.friction_angle"),
        (("soils.bank.friction_angle=-1.0",), "soils.bank.friction_angle"),
        (("soils.bank.cohesion=-1.0",), "soils.bank.cohesion"),
        (("soils.bank.dilatancy=31.0",), "soils.bank.dilatancy: 31.0: it cannot exceed friction_angle"),
        (("soils.bank.friction_angle=0.0",), "soils.bank.friction_angle: 0.0: without friction and cohesion"),
        (("soils.bank.water_level=1.0", "physics.gravity=off", "fluids.water.pressure=0.0"), "no gravity"),
        (("soils.bank.water_level=1.0", "soils.bank.water_density=1900.0"), "would float"),
        (("physics.pressure_gradient=minimum",), "the stress of soils is symmetric"),
        (
            ("precision=mixed",),
            'soils are computed in double precision, since strains are small; use "double"',
        ),
        (("frame.motion={translation=[0.2, 0.0]}",), "soils know of no frame that moves"),
        (("physics.central_friction={}",), "physics.central_friction: no fluid has a viscosity; set fluids."),
        (
            ("physics.laplacian_friction={}",),
            "physics.laplacian_friction: no fluid has a viscosity; set fluid",
        ),
    ],
)
def test_what_no_soil_can_be_is_refused_in_one_line(overrides, says, tmp_path):
    with pytest.raises(CaseError) as error:
        draft(tmp_path, TANK, SAND, *overrides)
    [line] = error.value.lines
    assert says in line


@pytest.mark.parametrize(
    ("override", "says"),
    [
        (
            "young=1.0",
            "soils.bank.young: 1 Pa, and the pressure at its lowest particle at the start is 546 Pa",
        ),
        ("young=1e-30", "give 2.1e+04 or more, or geostatic = false"),
        ("density=1e30", "soils.bank.density: 1e+30 kg/m³"),
        ("rest_coefficient=1e30", "soils.bank.rest_coefficient: 1e+30"),
        ("water_level=1e30", "soils.bank.water_level: 1e+30 m"),
    ],
)
def test_a_soil_pressed_beyond_its_law_is_refused_in_one_line(override, says, tmp_path):
    """By the density at its lowest particle, rho exp(p/K), which overflows; without its weight at the start it has none."""
    with pytest.raises(CaseError) as error:
        check(Scene(draft(tmp_path, TANK, SAND, f"soils.bank.{override}")))
    [line] = error.value.lines
    assert says in line
    check(Scene(draft(tmp_path, TANK, SAND, f"soils.bank.{override}", "soils.bank.geostatic=false")))


def test_a_soil_alone_has_its_own_waves(tmp_path):
    with pytest.raises(CaseError, match="soils have waves of their own"):
        draft(tmp_path, TANK.split("[fluids")[0], SAND, "physics.sound_speed=30.0")
    scene = Scene(draft(tmp_path, TANK.split("[fluids")[0], SAND))
    # (K + 4G/3)/rho = E(1 - nu)/((1 + nu)(1 - 2nu))/rho
    assert scene.sound_speed == pytest.approx((1e6 * 0.7 / (1.3 * 0.4) / 1800.0) ** 0.5, rel=1e-12)


def test_numbers_that_are_likely_a_slip_are_warned_of(tmp_path):
    def warned(*overrides):
        return [
            line for line in check(Scene(draft(tmp_path, TANK, SAND, *overrides))) if "soils.bank" in line
        ]

    assert not [line for line in warned() if "continues" not in line]
    assert any("in radians?" in line for line in warned("soils.bank.friction_angle=0.52"))
    assert any("presses it together" in line for line in warned("soils.bank.young=1e4"))
    assert any("kg/m³" in line for line in warned("soils.bank.density=1.8"))
