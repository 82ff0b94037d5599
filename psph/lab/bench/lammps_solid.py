"""A solid's problem in LAMMPS's own words: style smd/tlsph of its package MACHDYN."""

import numpy as np

from psph.lab.bench.lammps_space import balancing, box, by_id
from psph.physics.solid.deformation import support_of
from psph.simulation.solid_plan import solid_plan

STYLE, CHECKED = "smd/tlsph", ("x",)

STEP = 0.5
"""Its time step over psph's: its manual advises short ones."""

VISCOSITY, HOURGLASS = (0.06, 0.0), 10.0
"""Its linear and quadratic artificial viscosity and the strength of its hourglass control, as in the examples
of its manual."""

FAR = 2.0
"""Half a diagonal of the block, times this, from its centre: a particle beyond has flown off."""


def support(scene, simulation) -> float:
    """Of its kernel, m: that of psph's."""
    return support_of(solid_plan(simulation.plan).smoothing_length)


def commands(scene, simulation) -> tuple[list[str], list[str]]:
    """The scene, before its particles are made, and after."""
    [solid] = scene.case.solids.values()
    d, dx = scene.dimensions, scene.spacing
    reach = support(scene, simulation)
    elastic = (solid.density, solid.young, solid.poisson)
    common = " ".join(map(repr, (*elastic, *VISCOSITY, HOURGLASS, 1.0)))  # the last is a heat capacity
    space = [
        "units si",
        "atom_style smd",
        "atom_modify map array",
        "newton off",
        *box(scene, 1),
        f"pair_style {STYLE}",
        f"pair_coeff 1 1 *COMMON {common} *STRENGTH_LINEAR *EOS_LINEAR *END",
        "neigh_modify every 1 delay 0 check yes",
        "thermo 1000000",
        f"timestep {STEP * simulation.dt!r}",
    ]
    motion = [
        "group tlsph type 1",
        f"set group all volume {dx**d!r}",
        f"set group all smd/mass/density {solid.density!r}",
        f"set group all diameter {reach!r}",
        f"set group all smd/contact/radius {0.5 * dx!r}",
        "fix move tlsph smd/integrate_tlsph",
        *(["fix flat all enforce2d"] if d == 2 else []),
        *(balancing(d) if simulation.comm.size > 1 else []),
    ]
    return space, motion


def gathered(simulation) -> dict | None:
    """All particles in the order of their ids, as LAMMPS wants them; None on the other ranks."""
    found = by_id(simulation)
    if found is None:
        return None
    made, _ = found
    return made | {"type": np.ones(len(made["id"]) // 4, np.int32).tobytes()}


def blown_up(scene, states: list[dict]) -> str:
    """What is wrong with the places, in words; empty where the block is still together."""
    x = np.concatenate([np.frombuffer(state["x"]).reshape(-1, 3) for state in states])[:, : scene.dimensions]
    lower, upper = map(np.array, (scene.layout.lower, scene.layout.upper))
    off = np.linalg.norm(x - 0.5 * (lower + upper), axis=1).max() / (0.5 * np.linalg.norm(upper - lower))
    return "" if off < FAR else f"a particle is at {off:.3g} times the half diagonal"
