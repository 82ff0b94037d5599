"""What the tests of memory share: how a program of theirs starts."""

START = """
import json, sys
from pathlib import Path

from mpi4py import MPI

from psph.case import load
from psph.output.ledger import Ledger
from psph.scene import Scene
from psph.runs.footprint import bytes_per_particle
from psph.simulation.plan import make_plan
from psph.runs.record import Record
from psph.runs.setup import compile_ahead, create_particles
from psph.simulation.step import Simulation


def memory(what):
    [line] = [line for line in open("/proc/self/status") if line.startswith(what)]
    return 1024 * int(line.split()[1])


path, comm = Path(sys.argv[1]), MPI.COMM_WORLD
scene = Scene(load(path))
plan, particles = make_plan(scene), int(scene.census.counts.sum())
import h5py  # what a frame needs, apart from its bytes
compile_ahead(scene, plan, comm)
open("/proc/self/clear_refs", "w").write("5")  # forget the peak so far
before = memory("VmRSS")
simulation = Simulation(scene, plan, create_particles(scene, plan, comm), comm, Ledger())
record = Record(scene, simulation, path.parent)
"""
"""Of a case, the first argument: the ``simulation`` at its start, its ``record``, and the memory
``before`` them, bytes."""
