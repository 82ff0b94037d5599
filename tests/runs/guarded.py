"""What the tests of the guards share: a closed box of water at rest, and how it is run."""

from pathlib import Path

from psph.case import load
from psph.output.errors import together
from psph.runs.start import run
from psph.simulation.step import BlowUp

BOX = """
scheme = "sph"
title = "A box"
time.end = 0.3
output = { frames = 0.1, probes = 0.1, log = 0.05 }
parallel.axis = "x"
space = { dimensions = 2, spacing = 0.1 }
physics.sound_speed = 10.0
physics.artificial_viscosity = 0.1
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.2, 0.8] }
[walls.frame]
shape.difference.from.box = { lower = [-0.3, -0.3], upper = [1.5, 1.1] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.2, 0.8] } }]
"""
"""252 particles, 128 steps."""

SLOWLY = Path(__file__).with_name("slowly.py")
"""psph as a program whose steps last longer."""

THROWN = ["perturbations=[{ position = [0.65, 0.45], velocity = [100.0, 0.0] }]"]
"""A particle is thrown at the wall at ten speeds of sound."""


def boxed(folder, comm, *sets):
    """The box as a case, with keys set as on the command line; collective."""
    path = folder / "box.toml"
    with together(comm, path):
        if comm.rank == 0:
            path.write_text(BOX, encoding="utf-8")
    return load(path, sets)


def started(case, folder, comm):
    """(What the run raised or None, the lines that it said)."""
    said, trouble = [], None
    try:
        run(case, folder, comm, overwrite=True, say=lambda line, where=None: said.append(line))
    except BlowUp as error:
        trouble = error
    return trouble, said
