"""A fluid's problem in LAMMPS's own words: style sph/taitwater."""

import math

import numpy as np

from psph.fields import FLUID, WALL
from psph.lab.bench.lammps_space import balancing, box, by_id
from psph.physics.fluid.viscosity import ArtificialViscosity

STYLE, CHECKED = "sph/taitwater", ("rho",)

STEP = 0.5
"""Its time step over psph's: with psph's own a falling dam blows up in its integrator."""

BROKEN = 0.2
"""Relative error of the density above which the run counts as blown up."""


def support(scene, simulation) -> float:
    """Of its kernel, m: that of psph's."""
    return scene.support


def commands(scene, simulation) -> tuple[list[str], list[str]]:
    """The scene, before its particles are made, and after.

    A group holds the atoms that are there when it is named.
    """
    reach, d = support(scene, simulation), scene.dimensions
    [friction] = (e for e in simulation.plan.effects if isinstance(e, ArtificialViscosity))
    alpha = friction.alpha * scene.smoothing_length / reach  # its μ has the support for h
    water, *tank = scene.species
    pull = math.hypot(*scene.gravity)
    flat = [0.0] * (3 - d)
    down = " ".join(f"{g / pull!r}" for g in (*scene.gravity, *flat)) if pull else ""
    space = [
        "units si",
        "atom_style sph",
        "newton on",
        *box(scene, 2),
        f"mass * {water.mass!r}",
        f"pair_style {STYLE}",
        f"pair_coeff * * {water.density!r} {scene.sound_speed!r} {alpha!r} {reach!r}",
        "neigh_modify every 1 delay 0 check yes",
        "thermo 1000000",
        f"timestep {STEP * simulation.dt!r}",
    ]
    motion = [
        f"group water type {FLUID + 1}",
        "fix move water sph",
        *([f"group tank type {WALL + 1}", "fix stay tank sph/stationary"] if tank else []),
        *([f"fix fall water gravity {pull!r} vector {down}"] if pull else []),
        *(["fix flat all enforce2d"] if d == 2 else []),
        *(balancing(d) if simulation.comm.size > 1 else []),
    ]
    return space, motion


def gathered(simulation) -> dict | None:
    """All particles in the order of their ids, as LAMMPS wants them; None on the other ranks."""
    found = by_id(simulation, "kind", "density")
    if found is None:
        return None
    made, (kind, density) = found
    return made | {"type": (kind.astype(np.int32) + 1).tobytes(), "rho": density.tobytes()}


def blown_up(scene, states: list[dict]) -> str:
    """What is wrong with the densities, in words; empty where they are those of water."""
    rest = scene.species[0].density
    rho = np.concatenate([np.frombuffer(state["rho"]) for state in states]) / rest
    if 1.0 - BROKEN < rho.min() <= rho.max() < 1.0 + BROKEN:
        return ""
    return f"densities of {rho.min():.3g} to {rho.max():.3g} of the rest density"
