"""The standard problems: as large and as dense as asked, and a dam that really falls."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.spatial.distance import pdist

from psph.fields import FLUID
from psph.lab.bench import falling
from psph.lab.bench.blast import COLD, HOT, RADIUS, Blast
from psph.lab.bench.box import FluidBox
from psph.lab.bench.command import one, standard
from psph.lab.bench.falling import COARSEST, Falling, fall
from psph.lab.bench.measure import go_on, work
from psph.lab.bench.tank import HEIGHT, Tank
from psph.lab.errors import BenchError
from psph.output.ledger import Ledger
from psph.parallel.reductions import alone
from psph.scene import Scene
from psph.scene.particles import ParticleSet
from psph.scene.walls import thinnest_walls
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation


@pytest.mark.parametrize("many", [20_000, 200_000, 1_000_000])
@pytest.mark.parametrize(("dim", "neighbours"), [(2, 20), (3, 57), (3, 110)])
def test_as_many_particles_as_asked(dim, neighbours, many):
    box = FluidBox.nearest(dim, neighbours, many)
    fallen = Falling.nearest(dim, neighbours, many)
    assert box.sides**dim == pytest.approx(many, rel=0.05)
    assert Tank.nearest(dim, neighbours, many).particles == pytest.approx(many, rel=0.05)
    assert fallen.coarse.refined(fallen.times).particles == pytest.approx(many, rel=0.1)
    assert fallen.coarse.across <= COARSEST[dim]


def test_a_block_counts_the_shortest_steps():
    """Where particles take steps of their own :meth:`Simulation.step` makes many."""

    class Fourfold:
        steps = 3

        def step(self):
            self.steps += 4

    simulation = Fourfold()
    assert go_on(simulation, 10) == 12 and simulation.steps == 15


@pytest.mark.parametrize(("dim", "neighbours"), [(2, 20), (3, 57)])
def test_a_tank_is_what_it_says(dim, neighbours):
    tank = Tank.nearest(dim, neighbours, 3000)
    scene = Scene(tank.case())
    assert scene.census.counts.sum() == tank.particles
    assert scene.census.sizes[0] == tank.across**dim
    assert not thinnest_walls(scene.layout)


def test_the_standard_set():
    asked = standard(None, None, None, None)
    assert {(a.problem, a.dimensions) for a in asked} == {
        (problem, dim) for problem in ("box", "dam", "falling") for dim in (2, 3)
    }
    assert {a.particles for a in asked} == {20_000, 200_000, 1_000_000}
    assert {a.neighbours for a in asked} == {20, 57, 110}
    assert len(set(asked)) == len(asked) == 10


def test_choices_that_make_no_sense():
    with pytest.raises(BenchError, match="leave the other choices out"):
        standard("box", None, None, None)
    with pytest.raises(BenchError, match="block: solids have their own kernel; leave --neighbours"):
        one("block", None, None, 20)
    with pytest.raises(BenchError, match="--neighbours 0: give at least 1"):
        one(None, None, None, 0)


def test_a_blast_has_the_neighbours_that_are_asked_for():
    """By the h that it has found, hot in the middle; of single precision gases know nothing."""
    blast = Blast.nearest(3, 64, 8000)
    assert blast.sides**3 == pytest.approx(8000, rel=0.1)
    scene = Scene(blast.case())
    plan = make_plan(scene)
    simulation = Simulation(scene, plan, blast.create(scene, plan, alone()), alone(), Ledger())
    count, pairs, entries = work(simulation, scene)
    assert pairs / count == pytest.approx(64, rel=0.03) and entries > 1.5 * pairs
    heat = simulation.store.shown("thermal_energy")
    assert set(heat.tolist()) == {HOT, COLD}
    assert (heat == HOT).mean() == pytest.approx(4.0 / 3.0 * np.pi * RADIUS**3, rel=0.1)
    with pytest.raises(BenchError, match="gas: gases are computed in double precision"):
        one("gas", None, None, None, "mixed")


def half_fallen(dim, neighbours, many, comm):
    """(simulation of a falling dam at its first step, its layout)"""
    layout = Falling.nearest(dim, neighbours, many)
    scene = Scene(layout.case())
    plan = make_plan(scene)
    store = layout.create(scene, plan, comm)
    return Simulation(scene, plan, store, comm, Ledger()), layout


@pytest.mark.parametrize(("dim", "neighbours", "many"), [(2, 20, 6000), (3, 57, 5000)])
def test_a_falling_dam_goes_on_falling(dim, neighbours, many):
    simulation, layout = half_fallen(dim, neighbours, many, alone())
    store = simulation.store
    assert store.owned == layout.coarse.refined(layout.times).particles
    assert len(np.unique(store.owned_rows("id"))) == store.owned
    begun = simulation.domain.rebuilds
    before = water(store)
    for _ in range(80):
        simulation.step()
    after = water(store)
    assert before["position"][:, 0].max() > 1.5 * HEIGHT
    assert np.median(before["position"][:, -1]) < 0.45 * HEIGHT  # 0.5 as it stood
    assert after["position"][:, 0].max() > before["position"][:, 0].max()
    for state in (before, after):
        assert np.abs(state["density"] / 1000.0 - 1.0).max() < 0.05
        assert np.linalg.norm(state["velocity"], axis=1).max() < 3.0 * np.sqrt(9.81 * HEIGHT)
        assert np.quantile(state["position"], 0.01, axis=0).min() > 0.0  # nothing pours out
    assert np.linalg.norm(after["velocity"], axis=1).max() > 0.5 * np.sqrt(9.81 * HEIGHT)
    assert simulation.domain.rebuilds - begun > 4


def water(store):
    """Position, velocity and density of the fluid."""
    fluid = store.owned_rows("kind") == FLUID
    return {n: store.owned_rows(n)[fluid] for n in ("position", "velocity", "density")}


def test_split_particles_are_no_lattice():
    simulation, layout = half_fallen(2, 20, 6000, alone())
    x = water(simulation.store)["position"]
    dx = layout.coarse.spacing / layout.times
    around = np.linalg.norm(x[:, None] - x[None, :2000], axis=2)
    around[around == 0.0] = np.inf
    nearest = around.min(axis=0) / dx
    assert np.quantile(nearest, 0.05) > 0.3 and nearest.std() > 0.05
    assert len(np.unique(np.round(x[:, 0] / dx, 3))) > 0.5 * len(x)


def test_a_film_on_a_wall_is_split_beside_it():
    """Squeezed into the room between, its children would lie on each other, and burst."""
    layout = Falling.nearest(3, 57, 30_000)
    dx = layout.coarse.spacing
    film = ParticleSet(
        np.zeros(1, np.int64),
        np.full(1, FLUID, np.uint8),
        np.zeros(1, np.uint8),
        dx * np.array([[0.05, 10.0, 20.0]]),
        np.zeros((1, 3)),
        np.full(1, 1000.0),
        np.ones(1),
    )
    x = layout._split(film, 0, 0).position
    assert len(x) == layout.times**3 > 1 and x.min() > 0.0
    assert pdist(x).min() > 0.5 * dx / layout.times


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize(("dim", "neighbours", "many"), [(2, 20, 2000), (3, 57, 4000)])
def test_the_same_particles_on_any_number_of_ranks(dim, neighbours, many):
    comm = MPI.COMM_WORLD
    layout = Falling.nearest(dim, neighbours, many)
    scene = Scene(layout.case())
    plan = make_plan(scene)
    together = layout.create(scene, plan, comm)
    single = layout.create(scene, plan, alone())
    for name in ("id", "kind", "position", "velocity", "density"):
        parts = comm.allgather((together.owned_rows("id"), together.owned_rows(name)))
        ids, rows = map(np.concatenate, zip(*parts))
        expected = single.owned_rows(name)[np.argsort(single.owned_rows("id"))]
        assert rows[np.argsort(ids)].tobytes() == expected.tobytes()


@pytest.mark.mpi(min_size=2)
def test_ranks_that_the_coarse_tank_cannot_use_wait(monkeypatch):
    coarse = Scene(Tank(2, 20, 4, 5).case())
    together = fall(coarse, MPI.COMM_WORLD)
    monkeypatch.setattr(falling, "slab_planes", lambda scene: 1)
    single = fall(coarse, MPI.COMM_WORLD)
    assert len(single.id) == coarse.census.counts.sum()
    assert single.position.tobytes() == together.position.tobytes()
