"""The viscous stress at the start of small scenes, by the solver itself: what turns as a whole, two fluids that
shear each other, what a fluid slips on.  In plain Python, which compiling for each scene would outlast."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from jobs import clean_environment

DRUM = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.1 }
physics.sound_speed = 10.0
[fluids.oil]
shape.disc = { center = [0.0, 0.0], radius = 0.4 }
viscosity = 0.5
velocity_gradient = [[0.0, -2.0], [2.0, 0.0]]
[walls.drum]
no_slip = true
motion = { rotation = { speed = 2.0, center = [0.0, 0.0] } }
shape.difference.from.disc = { center = [0.0, 0.0], radius = 0.65 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 0.4 } }]
[bodies.core]
shape.disc = { center = [0.0, 0.0], radius = 0.17 }
density = 1000.0
no_slip = true
spin = 2.0
"""
SHEARED = ["fluids.oil.velocity_gradient=[[0.0, 2.0], [2.0, 0.0]]"]
SLIPPING = ["walls.drum.no_slip=false", "bodies.core.no_slip=false"]
MUDDY = [
    "fluids.oil.viscosity=0.0",
    "fluids.oil.rheology.bingham={yield_stress=5.0, plastic_viscosity=500.0}",
]
PLAIN = ['scheme="sph"']

LAYERS = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, -0.3], upper = [1.0, 1.3] }
physics.sound_speed = 10.0
[fluids.a]
density = 1000.0
viscosity = %(nu_a)r
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
velocity_gradient = [[0.0, %(slope_a)r], [0.0, 0.0]]
[fluids.b]
density = %(rho_b)r
viscosity = %(nu_b)r
shape.box = { lower = [0.0, 0.5], upper = [1.0, 1.0] }
velocity_gradient = [[0.0, %(slope_b)r], [0.0, 0.0]]
velocity_center = [0.0, 1.0]
velocity = [1.0, 0.0]
[walls.low]
no_slip = true
continues = "%(low)s"
shape.box = { lower = [0.0, -0.3], upper = [1.0, 0.0] }
[walls.high]
no_slip = true
continues = "%(high)s"
velocity = [1.0, 0.0]
shape.box = { lower = [0.0, 1.0], upper = [1.0, 1.3] }
"""


def layers(nu_a, rho_b, nu_b, low="a", high="b"):
    """Couette flow of two layers, half a metre each, between plates at 0 and 1 m/s; and its stress, Pa."""
    stress = 1.0 / (0.5 / (1000.0 * nu_a) + 0.5 / (rho_b * nu_b))
    slopes = {"slope_a": stress / (1000.0 * nu_a), "slope_b": stress / (rho_b * nu_b)}
    return LAYERS % ({"nu_a": nu_a, "rho_b": rho_b, "nu_b": nu_b, "low": low, "high": high} | slopes), stress


OVER = """
scheme = "sph"
time.end = 1.0
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, -0.4], upper = [1.0, 0.5] }
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.4] }
velocity = [1.0, 0.0]
viscosity = 0.1
"""
BELOW = "shape.box = { lower = [0.0, -0.4], upper = [1.0, 0.0] }\n"
SOLID = OVER + "[solids.floor]\n" + BELOW + "density = 1000.0\nyoung = 1e6\npoisson = 0.3\n"
SOIL = (
    OVER + "[soils.floor]\n" + BELOW + "density = 1500.0\nyoung = 1e5\npoisson = 0.3\nfriction_angle = 30.0\n"
)
INVISCID = OVER + "[fluids.floor]\n" + BELOW
WALL = OVER + "[walls.floor]\n" + BELOW
MUD = [
    "fluids.water.viscosity=0.0",
    "fluids.water.rheology.bingham={yield_stress=5.0, plastic_viscosity=100.0}",
]

TWO = layers(0.02, 1000.0, 0.2)
LIGHT = layers(0.1, 250.0, 0.4)
SWAPPED = layers(0.02, 500.0, 0.8, low="b", high="a")

SCENES = {
    "turning": (DRUM, []),
    "sheared": (DRUM, SHEARED),
    "turning, slipping": (DRUM, SLIPPING),
    "turning mud": (DRUM, MUDDY),
    "turning, plain": (DRUM, PLAIN),
    "two viscosities": (TWO[0], []),
    "two densities": (LIGHT[0], []),
    "walls of the other fluid": (SWAPPED[0], []),
    "on a solid": (SOLID, []),
    "mud on a solid": (SOLID, MUD),
    "on a soil": (SOIL, []),
    "on a fluid without viscosity": (INVISCID, []),
    "on a wall": (WALL, []),
}

IN_PLAIN_PYTHON = """
import json, sys
from pathlib import Path
from simulation.test_viscous_stress import at_the_start

for line in sys.stdin:
    print(json.dumps(at_the_start(Path(sys.argv[1]), *json.loads(line))), flush=True)
"""


def at_the_start(folder, text, sets):
    """Of the fluids at the start: group, mass, acceleration, all as lists."""
    from drafts import draft
    from mpi4py import MPI

    from psph.output.ledger import Ledger
    from psph.runs.setup import create_particles
    from psph.scene import Scene
    from psph.simulation.plan import make_plan
    from psph.simulation.step import Simulation

    scene = Scene(draft(folder, text, *sets))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())
    fluid = store.owned_rows("kind") == 0
    mass = store.view().mass  # an array, or one number for all
    mass = store.owned_rows("mass")[fluid] if np.ndim(mass) else np.full(fluid.sum(), mass)
    rows = (store.owned_rows("group")[fluid], mass, store.owned_rows("acceleration")[fluid])
    return [row.tolist() for row in rows]


@pytest.fixture(scope="module")
def starts(tmp_path_factory):
    """Group, mass and acceleration of the fluids of each scene."""
    job = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", IN_PLAIN_PYTHON, tmp_path_factory.mktemp("starts")],
        capture_output=True,
        text=True,
        input="\n".join(map(json.dumps, SCENES.values())),
        env=clean_environment() | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert job.returncode == 0, job.stderr
    lines = map(json.loads, job.stdout.splitlines())
    return {name: tuple(map(np.array, line)) for name, line in zip(SCENES, lines, strict=True)}


@pytest.mark.timeout(300)
@pytest.mark.parametrize("name", [name for name in SCENES if name.startswith("turning")])
def test_what_turns_as_a_whole_rubs_nowhere(starts, name):
    """Fluid, drum and body, whether the fluid sticks to them or not; a shear of as much is felt."""
    acceleration = starts[name][2]
    assert np.abs(acceleration).max() < 1e-9
    assert np.abs(starts["sheared"][2]).max() > 1.0


@pytest.mark.parametrize(
    "name, stress",
    (("two viscosities", TWO[1]), ("two densities", LIGHT[1]), ("walls of the other fluid", SWAPPED[1])),
)
def test_the_stress_between_two_layers_is_that_at_the_plates(starts, name, stress):
    """Exact Couette flow: each layer gains as much at the interface as it loses at its plate."""
    group, mass, acceleration = starts[name]
    for layer in (0, 1):
        of = group == layer
        assert abs(mass[of] @ acceleration[of, 0]) < 0.02 * stress


def test_a_viscous_fluid_slips_on_solids_soils_and_what_has_no_viscosity(starts):
    """A wall that does not say otherwise drags it: the control."""
    for name in ("on a solid", "mud on a solid", "on a soil", "on a fluid without viscosity"):
        group, mass, acceleration = starts[name]
        assert abs(mass[group == 0] @ acceleration[group == 0, 0]) < 1e-6, name
    group, mass, acceleration = starts["on a wall"]
    assert mass @ acceleration[:, 0] < -100.0
