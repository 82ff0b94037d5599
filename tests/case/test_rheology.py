"""Rheologies of a case: what is filled in, and what is refused."""

import pytest
from drafts import TANK, draft

from psph.case import CaseError
from psph.physics.fluid.rheology import Cross, Granular, HerschelBulkley

BINGHAM = "fluids.water.rheology.bingham={yield_stress=10.0, plastic_viscosity=0.5}"


def law(folder, *overrides):
    """The law of the water in a tank."""
    return draft(folder, TANK, *overrides).fluids["water"].rheology.law


def refused(folder, *overrides):
    """What is said of a tank with these keys, without its folder."""
    with pytest.raises(CaseError) as error:
        draft(folder, TANK, *overrides)
    return [line.replace(f"{folder}/case.toml: ", "") for line in error.value.lines]


def test_a_cap_and_a_regularisation_follow_from_each_other(tmp_path):
    """η at twice the yield stress is 2K for Bingham's law."""
    assert law(tmp_path, BINGHAM) == HerschelBulkley(10.0, 0.5, 1.0, 30.0, 300.0)
    capped = law(tmp_path, BINGHAM, "fluids.water.rheology.bingham.largest_viscosity=50.0")
    assert capped == HerschelBulkley(10.0, 0.5, 1.0, 5.0, 50.0)
    smooth = law(tmp_path, BINGHAM, "fluids.water.rheology.bingham.regularisation=3.0")
    assert smooth == HerschelBulkley(10.0, 0.5, 1.0, 3.0, 30.5)
    assert smooth.viscosity(0.0, 0.0, 0.0) == pytest.approx(smooth.largest)


def test_the_other_laws(tmp_path):
    table = "fluids.water.rheology"
    paste = law(tmp_path, f"{table}.herschel_bulkley={{yield_stress=8.0, consistency=2.0, exponent=0.5}}")
    assert paste == HerschelBulkley(8.0, 2.0, 0.5, 300.0 / 8.0, 300.0)  # 4² /s at twice the yield: 16/16 Pa s
    power = law(tmp_path, f"{table}.power_law={{consistency=2.0, exponent=0.5, largest_viscosity=9.0}}")
    assert power == HerschelBulkley(0.0, 2.0, 0.5, 0.0, 9.0)
    cross = law(tmp_path, f"{table}.cross={{viscosity_at_rest=2.0, viscosity_in_shear=0.1, time=0.5}}")
    assert cross == Cross(2.0, 0.1, 0.5, 1.0)
    grains = law(tmp_path, GRAINS % (0.64, 2500.0))
    assert grains == Granular(0.38, 0.64, 0.28, 1e-3, 2500.0, 1e-3, 10.0)


GRAINS = (
    "fluids.water.rheology.granular={friction=0.38, fast_friction=%r, inertial_number=0.28, diameter=1e-3, "
    "grain_density=%r, largest_viscosity=10.0}"
)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (
            [BINGHAM, "fluids.water.viscosity=1e-3"],
            "fluids.water.viscosity: 0.001: the fluid also has a rheology, which gives its viscosity; remove one "
            "of the two",
        ),
        (
            [
                BINGHAM,
                "fluids.water.rheology.cross={viscosity_at_rest=2.0, viscosity_in_shear=1.0, time=1.0}",
            ],
            "fluids.water.rheology: bingham and cross in one fluid; give one of bingham, herschel_bulkley, "
            "power_law, cross, granular",
        ),
        (
            ["fluids.water.rheology={}"],
            "fluids.water.rheology: does not say its law; give one of bingham, herschel_bulkley, power_law, "
            "cross, granular",
        ),
        (
            [GRAINS % (0.3, 2500.0)],
            "fluids.water.rheology.granular: has a fast_friction below its friction; let it be no less",
        ),
        (
            [GRAINS % (0.64, 900.0)],
            "fluids.water.rheology.granular.grain_density: 900.0: grains with room between them weigh 1000 kg/m³ "
            "(fluids.water.density), and a grain itself less; give a larger grain_density",
        ),
        (
            [BINGHAM, "fluids.water.rheology.bingham.largest_viscosity=0.4"],
            "fluids.water.rheology.bingham: has a cap no larger than its plastic_viscosity; give a larger "
            "largest_viscosity",
        ),
        (
            ["fluids.water.rheology.bingham={yield_stress=-1.0, plastic_viscosity=0.5}"],
            "fluids.water.rheology.bingham.yield_stress: -1.0 is out of range; it must be above 0",
        ),
        (
            ["fluids.water.rheology.power_law={consistency=1.0, exponent=0.5}"],
            "fluids.water.rheology.power_law.largest_viscosity: missing; add largest_viscosity = ... (cap of the "
            "viscosity: it sets the time step, Pa s)",
        ),
        (
            ["fluids.water.rheology.bingham={yield_stres=1.0, plastic_viscosity=0.5}"],
            "fluids.water.rheology.bingham.yield_stres: unknown key; did you mean 'yield_stress'?",
        ),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path, overrides, says):
    [line] = [line for line in refused(tmp_path, *overrides) if line.endswith(f": {says}")]


def test_no_slip_is_content_with_a_rheology(tmp_path):
    draft(tmp_path, TANK, BINGHAM, "walls.tank.no_slip=true")
    [line] = refused(tmp_path, "walls.tank.no_slip=true")
    assert "set fluids.NAME.viscosity or .rheology, or remove no_slip" in line


@pytest.mark.parametrize("exponent", (1e-3, 0.1, 3.0))
@pytest.mark.parametrize("consistency", (1e-30, 1e30))
def test_sizes_without_a_viscosity_are_refused_or_taken_in_one_line(tmp_path, consistency, exponent):
    paste = f"{{yield_stress=1.0, consistency={consistency}, exponent={exponent}}}"
    key = f"fluids.water.rheology.herschel_bulkley={paste}"
    try:
        found = law(tmp_path, key)
    except CaseError as error:
        [line] = error.lines
        assert line.endswith("no number that can be computed; give largest_viscosity")
    else:
        assert 0.0 < found.largest < float("inf")
