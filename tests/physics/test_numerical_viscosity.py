"""The viscosity that explain says of numerical friction is the one that a shear flow feels."""

import math

import pytest
from drafts import draft
from mpi4py import MPI

from psph.output.reader import Run
from psph.runs.explain import explain
from psph.runs.start import run
from psph.scene import Scene

VORTICES = """
scheme = "sph"
[space]
dimensions = 2
spacing = 0.02
kernel = "wendland-c2"
smoothing = 1.6
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.0, 1.0]
[time]
end = 0.1
[physics]
sound_speed = 10.0
pressure_gradient = "difference"
gradient_correction = 0.5
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
velocity = "exact"
pressure = "exact"
[exact.taylor_green]
speed = 1.0
length = 1.0
"""
"""Taylor-Green vortices without any viscosity: those of ν lose their energy at the rate 4 ν k²."""


def felt(folder, keys, comm=MPI.COMM_SELF):
    """The viscosity by which the vortices lose their energy, m²/s, and the lines of explain."""
    case = draft(folder, VORTICES, *keys)
    run(case, folder / "run", comm, say=lambda *line: None)
    log = Run(folder / "run").log()
    energy, time = log["kinetic_energy"], log["time"]
    rate = -math.log(energy[-1] / energy[0]) / (time[-1] - time[0])
    return rate / (4.0 * (2.0 * math.pi) ** 2), [*explain(Scene(case), 1)]


@pytest.mark.parametrize(
    ("effect", "alpha", "told"),
    [("pair_damping", 0.1, "0.004"), ("pair_damping", 0.3, "0.012"), ("artificial_viscosity", 0.3, "0.006")],
)
def test_numerical_friction_acts_as_explain_says(tmp_path, effect, alpha, told):
    found, lines = felt(tmp_path, [f"physics.{effect}={alpha}"])
    name = effect.replace("_", " ")
    [line] = [line for line in lines if line.lstrip().startswith(f"{name}  ") and "m²/s" in line]
    assert line.split()[2:] == [told, "m²/s"]
    # Along the rows of a square lattice it is a tenth more than the mean over all directions.
    assert found == pytest.approx(float(told), rel=0.2)


def test_without_it_the_vortices_keep_their_energy(tmp_path):
    found, lines = felt(tmp_path, [])
    assert abs(found) < 2e-4 and not any("m²/s" in line for line in lines)
