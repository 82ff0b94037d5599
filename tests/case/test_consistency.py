"""Rules between keys."""

import pytest
from drafts import WATER, draft, refusal

from psph.case import CaseError, load

BALL = "{ center = [0.0, 0.0, 0.0], radius = 1.0 }"
BOX = "{ lower = [0.0, 0.0], upper = [1.0, 0.5] }"
PERIODIC = 'spacing = 0.1\nperiodic = ["x"]\n'
CENTRAL = "[physics]\ncentral_friction = {}"
CARRIED = f'use = ["stress_points.py", "transport.py"]\n{WATER}'
WALL = f"\n[walls.floor]\nshape.box = {BOX}\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            WATER.replace("[0.0, -9.8]", "[-9.8]"),
            "physics.gravity: [-9.8]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            WATER.replace("lower = [0.0, 0.0]", "lower = [0.0, 0.0, 0.0]"),
            "fluids.water.shape.box.lower: [0.0, 0.0, 0.0]: 3 numbers in a case with "
            "space.dimensions = 2; give 2",
        ),
        (
            WATER + "velocity = [1.0]",
            "fluids.water.velocity: [1.0]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            WATER.replace("spacing = 0.1", "spacing = 0.1\norigin = [0.0]"),
            "space.origin: [0.0]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            WATER + "[probes.P1]\nposition = [0.0]",
            "probes.P1.position: [0.0]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            WATER + "[[perturbations]]\nposition = [0.0, 0.0]\nvelocity = [0.0]",
            "perturbations[0].velocity: [0.0]: 1 number in a case with space.dimensions = 2; give",
        ),
        (
            WATER.replace(f"box = {BOX}", f"ball = {BALL}"),
            "fluids.water.shape.ball: a ball needs space.dimensions = 3, here it is 2; use another",
        ),
        (
            WATER.replace(
                "spacing = 0.1", 'spacing = 0.1\nperiodic = ["z"]\nlower = [0.0, 0.0]\nupper = [1.0, 1.0]'
            ),
            'space.periodic[0]: "z": no axis in 2D; give one of x, y',
        ),
        (WATER + '[parallel]\naxis = "z"', 'parallel.axis: "z": no axis in 2D; give one of x, y'),
        (
            WATER.replace("spacing = 0.1", PERIODIC),
            'space.periodic: ["x"]: a periodic axis needs the corners of the domain; give '
            "space.lower and space.upper",
        ),
        (
            WATER.replace("spacing = 0.1", PERIODIC + "lower = [0.0, 0.0]"),
            'space.periodic: ["x"]: a periodic axis needs the corners of the domain; give space.upper',
        ),
        (
            WATER.replace("spacing = 0.1", "spacing = 0.1\nlower = [0.0, 0.0]\nupper = [1.0, 0.0]"),
            "space.upper: [1.0, 0.0]: not above space.lower on every axis; let every number exceed",
        ),
        (
            WATER.replace("gravity = [0.0, -9.8]", "") + 'pressure = "hydrostatic"',
            'fluids.water.pressure: "hydrostatic": there is no gravity; give physics.gravity, or',
        ),
        (
            WATER.replace("[physics]", '[physics]\npressure_gradient = "minimum"\ngradient_correction = 0.5'),
            'physics.gradient_correction: does not work with physics.pressure_gradient = "minimum"; use',
        ),
        (
            WATER.replace("[physics]", "[physics]\nparticle_shifting = 0.1\nposition_shift = 0.1"),
            "physics.particle_shifting: physics.position_shift shifts particles too; set it to",
        ),
        (
            CARRIED.replace("[physics]", "[physics]\nxsph = 0.5\ntransport_velocity = 1.0"),
            'physics.xsph: physics.transport_velocity moves particles too; set it to "off", or remove',
        ),
        (
            WATER.replace("[physics]", '[physics]\npressure_gradient = "minimum"\nartificial_stress = 0.2'),
            'physics.artificial_stress: works only with physics.pressure_gradient = "symmetric", and',
        ),
        (
            CARRIED.replace("[physics]", '[physics]\npressure_gradient = "stress_points"\nxsph = 0.5'),
            'physics.xsph: physics.pressure_gradient = "stress_points" moves half of the particles too; choose',
        ),
        (
            WATER.replace(
                "[physics]",
                '[physics]\npressure_gradient = "tensile_control"\ngradient_correction = 0.5',
            ),
            'physics.gradient_correction: does not work with physics.pressure_gradient = "tensile_contr',
        ),
        (
            WATER + WALL + 'continues = "watre"',
            "walls.floor.continues: \"watre\": no fluid has this name; did you mean 'water'?",
        ),
        (
            WATER + WALL + "no_slip = true",
            "walls.floor.no_slip: true: no fluid has a viscosity; set fluids.NAME.viscosity or .rheology, or remove no_slip",
        ),
        (
            WATER.replace("[physics]", CENTRAL),
            "physics.central_friction: no fluid has a viscosity; set fluids.NAME.viscosity or .rheology, or remove this key",
        ),
        (
            WATER.replace("[physics]", CENTRAL) + "viscosity = 1e-3" + WALL + "no_slip = true",
            "walls.floor.no_slip: true: does not work with physics.central_friction; remove one of the two",
        ),
        (
            WATER.replace("[physics]", CENTRAL + "\nlaplacian_friction = {}") + "viscosity = 1e-3",
            "physics.central_friction: physics.laplacian_friction takes the place of the viscous stress too; set",
        ),
        (
            WATER.replace("[physics]", "[physics]\nlaplacian_friction = {}")
            + "rheology.bingham = { yield_stress = 1.0, plastic_viscosity = 1.0 }",
            "physics.laplacian_friction: is for constant viscosities; remove it, or fluids.water.rheology",
        ),
        (
            WATER + "viscosity = 1e-3" + WALL + 'no_slip = true\ncondition = "penalty"',
            'walls.floor.no_slip: true: does nothing where condition = "penalty"; take "dynamic" or',
        ),
        (
            WATER + "viscosity = 1e-3" + WALL + 'no_slip = true\ncondition = "repulsive"',
            'walls.floor.no_slip: true: does nothing where condition = "repulsive"; take "dynamic" or',
        ),
        (
            WATER.replace("-9.8]", "-9,81]"),
            "physics.gravity: [0.0, -9.0, 81.0]: 3 numbers in a case with space.dimensions = 2; give 2; "
            "a decimal comma? [0, -9.81]",
        ),
        (
            WATER + "velocity = [0,5, 1,25]",
            "fluids.water.velocity: [0.0, 5.0, 1.0, 25.0]: 4 numbers in a case with space.dimensions = 2; "
            "give 2; a decimal comma? [0.5, 1.25]",
        ),
        (
            WATER + WALL.replace("floor", "water"),
            "walls.water: a fluid has this name too; give the wall another",
        ),
        (
            WATER.replace("end = 2.0", "end = 2.0\nstep = 1e-12"),
            "time.step: 1e-12: too short for 2 s: more than 9e+09 steps, lost in the rounding of the time; "
            "give at least 2.4e-10",
        ),
        (
            WATER + "[output]\nframes = 1e-12",
            "output.frames: 1e-12: gives more than 1e+09 outputs until 2 s; give at least 2.2e-09",
        ),
    ],
)
def test_a_contradiction_is_one_line(tmp_path, text, says):
    [line] = refusal(tmp_path, text)
    assert line.startswith(f"case.toml: {says}")


def test_all_contradictions_are_found_at_once(tmp_path):
    text = WATER + "velocity = [1.0]" + WALL + 'continues = "oil"'
    keys = [line.split(": ")[1] for line in refusal(tmp_path, text)]
    assert keys == ["fluids.water.velocity", "walls.floor.continues"]


@pytest.mark.parametrize("gravity", ["[0.0]", "[0.0, 0.0, -9.8]", "[]"])
def test_gravity_of_another_length_is_named_once(gravity):
    """Waves and hydrostatic pressure read it too."""
    with pytest.raises(CaseError) as caught:
        load("run/cases/piston_wave.toml", [f"physics.gravity={gravity}"])
    [line] = str(caught.value).splitlines()
    assert f"physics.gravity: {gravity}" in line and "give 2" in line or gravity == "[]"


def test_an_empty_velocity_is_named_once(tmp_path):
    [line] = refusal(tmp_path, WATER + "velocity = []")
    assert "fluids.water.velocity: []: not a velocity; give one number per dimension" in line


def test_the_proposals_are_accepted(tmp_path):
    text = WATER.replace("end = 2.0", "end = 2.0\nstep = 2.4e-10")
    assert draft(tmp_path, text + "[output]\nframes = 2.2e-9").output.frames == 2.2e-9
    for key in ("probes", "log"):
        [line] = refusal(tmp_path, WATER + f"[output]\n{key} = 1e-300")
        assert f"output.{key}" in line


@pytest.mark.parametrize("velocity", ["[1.5, 0.5, 2.0]", "[0.0, 5.0, -1.0, 0.0, 2.5]", "[1.0]"])
def test_numbers_that_no_comma_has_made_are_not_asked_about(tmp_path, velocity):
    [line] = refusal(tmp_path, WATER + f"velocity = {velocity}")
    assert "numbers in a case" in line.replace("number ", "numbers ") and "comma" not in line


def test_what_agrees_is_accepted(tmp_path):
    text = WATER.replace("spacing = 0.1", PERIODIC + "lower = [0.0, 0.0]\nupper = [1.0, 1.0]")
    assert draft(tmp_path, text + WALL).space.periodic == ("x",)


IN_SPACE = "solids.block = { shape.box = " + BOX + ", density = 1e3, young = 1e6, poisson = 0.3 }\n"


@pytest.mark.parametrize(
    ("key", "acts"),
    [
        ("physics.damping_zone = { begin = 0.0, end = 1.0 }", "fluids"),
        ("physics.pair_damping = 0.1", "fluids, soils and updated Lagrangian solids"),
    ],
)
def test_an_effect_without_matter_to_act_on_is_refused(tmp_path, key, acts):
    """Whatever schemes set stands for nothing that is asked; nor do body forces that pull solids."""
    space = "space = { dimensions = 2, spacing = 0.1 }\ntime.end = 1.0\n"
    says = refusal(tmp_path, f"{space}{key}\n{IN_SPACE}")
    assert len(says) == 1 and f"acts on {acts} alone, and the case has none; remove this key" in says[0]
    pull = "physics.central_force = { frequency = 1.0, center = [0.0, 0.0] }\n"
    assert draft(tmp_path, f"{space}{pull}{IN_SPACE}").physics.fourth_order_diffusion is not None


LISTS = {
    "limits in 3D": """
space = { dimensions = 3, spacing = 0.25 }
time.end = 1.0
physics.contact = {}
[solids.drop]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] }
density = 1e3
young = 1e5
poisson = 0.3
[bodies.flap]
shape.box = { lower = [2.0, 0.0, 0.0], upper = [3.0, 1.0, 1.0] }
density = 1e3
[joints.foot]
of = ["flap"]
hinge = { at = [2.5, 0.5, 0.0], axis = [0.0, 1.0, 0.0], limits = [-20.0, 10.0] }
""",
    "three powers in 2D": """
space = { dimensions = 2, spacing = 0.25 }
time.end = 1.0
[solids.rubber]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
density = 1e3
hyperelastic.ogden = { shear = [6e5, 1e3, -1e4], exponents = [1.3, 5.0, -2.0], bulk = 1e7 }
""",
}


@pytest.mark.parametrize("text", LISTS.values(), ids=LISTS)
def test_a_list_that_is_no_vector_has_a_length_of_its_own(tmp_path, text):
    assert draft(tmp_path, text)
