"""An exact solution is of one fluid: others are refused where it depends on what they differ by."""

import pytest
from drafts import CHANNEL
from scene.test_checks import refused

from psph.theory.solutions.catalogue import asked_of_fluid
from psph.theory.solutions.channel import Poiseuille
from psph.theory.solutions.setting import Surroundings
from psph.theory.solutions.still import Hydrostatic
from psph.theory.solutions.vortices import TaylorGreen

LAYERS = """
time.end = 0.1
physics.gravity = [0.0, -9.81]
space = { dimensions = 2, spacing = 0.1 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
pressure = "hydrostatic"
[fluids.oil]
shape.box = { lower = [0.0, 0.5], upper = [1.0, 1.0] }
pressure = "hydrostatic"
[exact.hydrostatic]
surface = 1.0
"""


def test_what_solutions_ask_of_a_fluid():
    setting = Surroundings(
        dimensions=2,
        density=1000.0,
        viscosity=0.1,
        gravity=(0.1, -9.81),
        lower=(0.0, 0.0),
        upper=(1.0, 1.0),
        periods=(1.0, None),
    )
    assert asked_of_fluid(Hydrostatic(1.0), setting) == ("density",)
    assert asked_of_fluid(Poiseuille(0.0, 1.0), setting) == ("viscosity",)
    assert asked_of_fluid(TaylorGreen(1.0, 1.0), setting) == ("density", "viscosity")


def test_layers_of_two_densities_are_refused(tmp_path):
    [line] = refused(tmp_path, LAYERS, "fluids.oil.density=500.0")
    assert line == (
        "case.toml: exact.hydrostatic: is of one fluid, but fluids.water.density is 1000 and "
        "fluids.oil.density is 500; give both the same, or remove exact"
    )


@pytest.mark.parametrize(
    "sets, says",
    (
        (
            ("fluids.b.viscosity=0.3",),
            "of one fluid, but fluids.water.viscosity is 0.1 and fluids.b.viscosity is 0.3",
        ),
        (
            ("fluids.b.rheology.bingham={yield_stress=1.0, plastic_viscosity=0.1}",),
            "of a constant viscosity; remove fluids.b.rheology, or remove exact",
        ),
    ),
)
def test_layers_of_two_viscosities_are_refused_beside_a_flow_that_depends_on_it(tmp_path, sets, says):
    other = "\n[fluids.b]\nshape.box = { lower = [0.0, 0.5], upper = [1.0, 1.0] }\n"
    flow = "\n[exact.poiseuille]\nlower = 0.0\nupper = 1.0\n"
    found = refused(tmp_path, CHANNEL + other + flow, "fluids.water.viscosity=0.1", *sets)
    assert any(says in line for line in found), found


def test_still_water_may_have_two_viscosities(tmp_path):
    from scene.test_checks import checked

    assert not any("exact" in line for line in checked(tmp_path, LAYERS, "fluids.oil.viscosity=1e-3"))
