"""The theory of elastic lattices against psph's own loops: forces of waves, and how fast a lattice falls apart."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI

from psph.lab.maps.elastic import matter
from psph.output.ledger import Ledger
from psph.runs.setup import lattice_particles, store_of
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation
from psph.theory.stability.elastic import TotalLagrangian, UpdatedLagrangian

N = 10
STRETCH = 1.04

LATTICE = f"""
scheme = "solid"
time.end = 1.0
[space]
dimensions = 2
spacing = 1.0
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [{N}.0, {N}.0]
smoothing = {2.0**0.5!r}
[solids.block]
description = "updated"
shape.box = {{ lower = [0.0, 0.0], upper = [{N}.0, {N}.0] }}
density = 1.0
young = 0.4666666666666667
poisson = 0.4
"""
"""In units of c_l, ρ₀ and dx."""


def simulation_of(case, moved, **fields):
    """With particles at ``moved``(x) and these fields of theirs, (n, width)."""
    scene = Scene(case)
    plan = make_plan(scene)
    found = lattice_particles(scene, MPI.COMM_SELF)
    rest = found.position.copy()
    found.position[:] = moved(rest)
    store = store_of(scene, plan, found)
    for name, values in fields.items():
        for of, value in zip(
            store[name], (rest if values is None else np.broadcast_to(values, (len(rest), 3))).T
        ):
            of[store.inner] = value
    return Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())


@pytest.mark.parametrize("hourglass", (0.0, 1.5))
def test_a_wave_in_total_lagrangian_meets_the_force_of_the_loops(hourglass, tmp_path):
    case = draft(
        tmp_path,
        LATTICE,
        "scheme=stable",
        "solids.block.description=total",
        f"solids.block.hourglass={hourglass}",
    )
    wave, size = 2.0 * np.pi / N * np.array([3.0, 1.0]), np.array([1e-6, 2e-6])
    done = simulation_of(case, lambda x: x + np.cos(x @ wave)[:, None] * size, reference=None)
    rest, found = done.store.owned_rows("reference"), done.store.owned_rows("acceleration")
    [omega] = TotalLagrangian(hourglass).squares(matter(0.4), wave[None])
    expected = -np.cos(rest @ wave)[:, None] * (omega @ size)
    assert found == pytest.approx(expected, abs=1e-5 * abs(expected).max())


@pytest.mark.parametrize(("stress", "correction"), [(0.0, "off"), (0.3, 0.5)])
def test_a_lattice_under_tension_falls_apart_as_fast_as_the_theory_says(stress, correction, tmp_path):
    """Drawn along x and pressed along y by as much, so that its density stays."""
    drawn = np.array([STRETCH, 1.0 / STRETCH])
    ends = ", ".join(repr(float(N * s)) for s in drawn)
    case = draft(
        tmp_path,
        LATTICE.replace(f"upper = [{N}.0, {N}.0]\nsmoothing", f"upper = [{ends}]\nsmoothing"),
        f"physics.artificial_stress={stress}",
        f"physics.gradient_correction={correction}",
        "physics.artificial_viscosity=0",
        "time.step=0.1",
        "time.gather_every=1",
    )
    fitting = 2.0 * np.pi / N * np.array([*np.ndindex(N, N)])[1:] / drawn
    of = UpdatedLagrangian(stress, corrected=correction != "off")
    squares = of.squares(matter(0.4, stretches=tuple(drawn.tolist())), fitting)
    values, vectors = np.linalg.eig(squares)
    fastest = values.real.min(axis=1).argmin()
    wave, way = fitting[fastest], vectors[fastest][:, values[fastest].real.argmin()].real
    expected = np.sqrt(-values[fastest].real.min())
    shape = {}

    def kicked(x):
        shape["mode"] = np.cos((x - x[0]) * drawn @ wave)[:, None] * way
        return x * drawn + 1e-8 * shape["mode"]

    deviator = 2.0 * matter(0.4).shear * np.log(STRETCH) * np.array([1.0, 0.0, -1.0])
    run = simulation_of(case, kicked, deviator=deviator, predicted_deviator=deviator)
    steps, sizes = int(10.0 / expected / 0.1), []
    for _ in range(steps):
        run.step()
        order = np.argsort(run.store.owned_rows("id"))
        sizes.append(abs((run.store.owned_rows("velocity")[order] * shape["mode"]).sum()))
    late = np.arange(steps) > 0.6 * steps
    rate = np.polyfit(0.1 * np.arange(steps)[late], np.log(np.array(sizes)[late]), 1)[0]
    assert rate == pytest.approx(expected, rel=1e-3)
