"""Bodies on joints among particles of several sizes: they move as with the finer spacing all over."""

import math

import numpy as np
import pytest
from cases.test_refined import together
from drafts import draft
from gauging import start as begun
from mpi4py import MPI
from parallel.test_simulation import state
from runs.resuming import go_on_alike, keep, steps, taken_up

from psph.simulation import levels

SPRUNG = """
time.end = 0.5
[space]
dimensions = 2
spacing = SPACING
REFINED
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [2.4, 0.56] }
shape.difference.minus = [{ box = { lower = [1.0, 0.48], upper = [1.4, 0.72] } }]
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.16, -0.16], upper = [2.56, 0.96] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.4, 0.96] } }]
[bodies.box]
shape.box = { lower = [1.0, 0.48], upper = [1.4, 0.72] }
density = 500.0
START
[joints.mast]
of = ["box"]
JOINT
"""
"""A box that floats too high, on a mast with a spring."""

REFINED = "refine = [{ shape.box = { lower = [0.72, -0.16], upper = [1.68, 0.96] } }]"

SLIDER = "slider = { along = [0.0, 1.0], stiffness = 2000.0 }"

HINGE = "hinge = { at = [1.2, 0.6], stiffness = 60.0, rest = 15.0 }"

TIMES = np.linspace(0.05, 0.5, 10)


def sprung(folder, joint, spacing=0.04, refined="", start=""):
    """The case of a box on a ``joint``."""
    text = SPRUNG.replace("SPACING", f"{spacing:g}").replace("REFINED", refined)
    return draft(folder, text.replace("JOINT", joint).replace("START", start))


def way(case):
    """How high the box is, m, and how far it has turned, rad, at some times (times, 2)."""
    simulation, found = begun(case), []
    bodies = simulation.engine.of("bodies").bodies
    for time in TIMES:
        while simulation.time < time:
            simulation.step(time)
        turn = bodies.turn[0]
        found.append((bodies.place[0, 1], math.atan2(turn[1, 0], turn[0, 0])))
    return np.array(found)


@pytest.mark.parametrize("joint, free", [(SLIDER, 0), (HINGE, 1)], ids=["slider", "hinge"])
def test_a_body_on_a_joint_goes_as_with_the_finer_spacing(joint, free, tmp_path):
    """What it does there is within 1 % of its way; with the coarse spacing, the control, 4 % and more off."""
    fine = way(sprung(tmp_path, joint, spacing=0.02))
    mixed, coarse = (way(sprung(tmp_path, joint, refined=told)) for told in (REFINED, ""))
    size = np.ptp(fine[:, free])
    assert size > (0.02, 0.1)[free]
    assert abs(mixed - fine)[:, free].max() < 0.01 * size
    assert abs(coarse - fine)[:, free].max() > 0.04 * size
    assert np.ptp(mixed[:, 1 - free]) < 1e-9  # what the joint holds


def joined(folder):
    """A box that spins on its hinge and stirs the water at the border of a region, which ends below it."""
    narrow = REFINED.replace("1.68", "1.36").replace("0.72", "0.8")
    return sprung(folder, HINGE, refined=narrow, start="spin = 8.0")


@pytest.mark.mpi(min_size=2)
def test_same_bits_with_a_joint(mpi_tmp_path):
    case = together(mpi_tmp_path, joined)
    many, single = (steps(case, comm, 160) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    assert single.engine.of("refine").counts[1, levels.GONE] > 0
    (rows, *_), (alone, *_) = state(many), state(single)
    assert np.array_equal(rows, alone)
    assert many.engine.of("bodies").state() == single.engine.of("bodies").state()


@pytest.mark.mpi(min_size=2)
def test_a_joint_goes_on_on_one_rank(mpi_tmp_path):
    case = together(mpi_tmp_path, joined)
    simulation = steps(case, MPI.COMM_WORLD, 45)
    written = keep(simulation, case, mpi_tmp_path)
    MPI.COMM_WORLD.Barrier()
    go_on_alike(simulation, taken_up(case, written, MPI.COMM_SELF), 60)
