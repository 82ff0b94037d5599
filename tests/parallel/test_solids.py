"""Solids on several ranks: the same bits, through forced sorting and migration, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from long import LONG
from mpi4py import MPI
from runs.resuming import go_on_elsewhere

from psph.case import load
from psph.parallel.partner_halo import LostPartner, PartnerHalo, follow, owners
from psph.particles.partners import ReferenceRows
from psph.simulation.solid_plan import solid_plan

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

BEAMS = """
time.end = 1.0
neighbours.skin = 0.1
physics.gravity = [0.3, -9.8]
parallel.axis = "x"
physics.contact = { damping = 0.1, friction = 0.3 }
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.1 }
[solids.beam]
shape.box = { lower = [-0.8, 0.0], upper = [3.0, 0.4] }
clamped.box = { lower = [-0.8, 0.0], upper = [-0.4, 0.4] }
clamps.grip.shape.box = { lower = [-0.4, 0.0], upper = [0.0, 0.4] }
clamps.grip.motion = [{ rotation = { speed = 2.0, center = [-0.4, 0.2] } }, { translation = [0.2, 0.1], ramp = 0.02 }]
density = 1100.0
young = 3.0e5
poisson = 0.35
damping = 40.0
relaxation = [{ shear = 5.0e4, time = 0.01 }, { shear = 3.0e4, time = 0.1 }]
jitter = 0.1
loads.end = { shape = { box = { lower = [2.5, 0.0], upper = [3.0, 0.4] } }, force = [0.0, -900.0] }
loads.top = { shape = { box = { lower = [0.5, 0.2], upper = [2.5, 0.4] } }, pressure = 2000.0, facing = [0.0, 1.0] }
load_rise = 0.1
[solids.plate]
shape.box = { lower = [0.5, 1.0], upper = [2.0, 2.0] }
density = 900.0
hyperelastic.ogden = { shear = [1.5e6, -1.0e5], exponents = [0.7, -2.0], bulk = 6.6e6 }
plane = "stress"
critical_stretch = 0.01
flaws = 3.0
velocity_gradient = [[0.0, -9.0], [9.0, 0.0]]
velocity_center = [1.25, 1.5]
[solids.lead]
shape.box = { lower = [3.2, 0.2], upper = [4.0, 1.0] }
velocity = [-1.0, -9.0]
density = 1300.0
young = 1.0e6
poisson = 0.3
johnson_cook = { yield_stress = 2e4, hardening = 3e4, exponent = 0.4, rate = 0.05, heat_capacity = 130.0 }
mie_gruneisen = { slope = 1.5, gruneisen = 2.0 }
[walls.step]
shape.box = { lower = [4.1, -0.6], upper = [4.6, 1.4] }
[anvils.floor]
at = [3.2, 0.0]
normal = [-0.2, 1.0]
[gauges.tip.displacement]
of = "beam"
at = [3.0, 0.2]
"""
"""A beam across all slabs, whose stress relaxes, that bends under a load and by a clamp that moves, a sheet of rubber,
with flaws, that spins above it and falls on it, and a block of metal that is pressed flat on a slope, between the beam and a wall."""

CHIPS = """
time.end = 1.0
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 3, spacing = 0.1 }
[solids.block]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.6, 0.4, 0.5] }
clamped.box = { lower = [0.0, 0.0, 0.0], upper = [0.3, 0.4, 0.5] }
density = 1000.0
young = 1.0e6
poisson = 0.3
critical_stretch = 0.01
flaws = 3.0
velocity_gradient = [[3.0, 1.0, 0.0], [0.0, 0.0, 4.0], [0.0, -4.0, 0.0]]
"""


def beams(folder):
    if COMM.rank == 0:
        (folder / "beams.toml").write_text(BEAMS, encoding="utf-8")
    COMM.Barrier()
    return load(folder / "beams.toml")


def rows(simulation):
    """All that moves, by id, and the stored energy."""
    energy = simulation.engine.stored_energy()
    store = simulation.store
    names = (
        "position",
        "velocity",
        "acceleration",
        "cut",
        "stress",
        "von_mises",
        "damage",
        "plastic_strain",
        "work",
        "relaxed_metric_1",
        "drawn",
    )
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])], energy


def met(simulation):
    """How many particles are in contact."""
    return np.count_nonzero(simulation.store.shown("contact_energy"))


@pytest.mark.core
def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(mpi_tmp_path):
    case = beams(mpi_tmp_path)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    begun, _ = rows(single)
    assert len(together.engine.of("solids").halo.ids) > 0  # the beam goes on behind the slab's end
    for step in range(90):
        single.step()
        together.step()
        if step % 10 == 9:  # at the same steps: contacts are summed in the order of the lists
            single.rebuild()
            together.rebuild()
    (one, energy), (many, energy_of_many) = rows(single), rows(together)
    assert np.isfinite(one).all() and np.abs(one - begun).max() > 0.1
    assert met(single) > 5  # solids meet each other and the wall
    assert 0.0 < single.store.shown("damage").mean() < 0.2  # weak bonds are cut
    strain, work, relaxed = one[:, -7], one[:, -6], one[:, -5:-2]
    assert strain.max() > 0.02 and (strain > 0.0).sum() > 5  # the metal yields
    assert np.abs(work).max() > 0.0  # the clamp that moves does work
    assert np.abs(relaxed).max() > 1e-3  # the beam relaxes
    assert np.ptp(one[one[:, -1] < -10.0, -2]) > 0.05  # pressed faces have turned
    assert np.array_equal(one, many) and energy == energy_of_many > 0.0
    assert together.domain.rebuilds == single.domain.rebuilds > 6


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1), (2, 2)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(beams(mpi_tmp_path), before, after, mpi_tmp_path)


def chips(folder):
    """A block in 3D, clamped at one end, that is torn by a stream through it, whose slabs cut it."""
    if COMM.rank == 0:
        (folder / "chips.toml").write_text(CHIPS, encoding="utf-8")
    COMM.Barrier()
    return load(folder / "chips.toml")


def test_shares_in_3d_are_those_of_the_whole_on_any_number_of_ranks(mpi_tmp_path):
    case = chips(mpi_tmp_path)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    for simulation in (single, together):
        for _ in range(10):
            simulation.step()
        simulation.rebuild()
        simulation.step()
    assert 0 < np.count_nonzero(single.store.shown("cut").any(axis=1)) < single.store.owned
    found = []
    for simulation in (single, together):
        store = simulation.store
        own = np.column_stack([store.owned_rows(name) for name in ("id", "share", "cut", "position")])
        every = np.concatenate(simulation.comm.allgather(own))
        found.append(every[np.argsort(every[:, 0])])
    assert np.array_equal(*found) and np.ptp(found[0][:, 1]) > 1.0


@LONG
def test_shares_in_3d_do_not_see_what_has_cracked_where_a_run_goes_on(mpi_tmp_path):
    go_on_elsewhere(chips(mpi_tmp_path), 1, 2, mpi_tmp_path)


def test_rows_follow_their_particles_to_other_ranks():
    ids = np.arange(10) + 10 * COMM.rank
    made = ReferenceRows.of(ids[::-1], np.arange(10) % 3, np.arange(9) + 100 * COMM.rank)
    everyone = COMM.allgather(made)
    wanted = np.arange(COMM.rank, 10 * COMM.size, COMM.size)
    found = follow(COMM, made, wanted[::-1])
    assert np.array_equal(found.ids, wanted)
    for one in wanted:
        was = everyone[one // 10]
        assert np.array_equal(found.chosen(np.array([one]))[1], was.chosen(np.array([one]))[1])


def test_partners_come_by_id_wherever_they_are():
    ids = np.arange(COMM.rank, 40, COMM.size)[::-1].copy()
    wanted = np.setdiff1d(np.arange(7, 23), ids)
    halo = PartnerHalo(COMM, ids, wanted)
    table = np.zeros((len(ids) + len(wanted), 4))
    table[: len(ids), 1:3] = np.column_stack([ids, -ids])
    channel = halo.channel(table, 1, 3)
    for request in channel:
        request.Start()
    for request in channel:
        request.Wait()
    assert sorted(halo.ids) == sorted(wanted)
    assert np.array_equal(
        table[len(ids) :], np.column_stack([0 * halo.ids, halo.ids, -halo.ids, 0 * halo.ids])
    )
    halo.free()


def test_a_lost_partner_is_an_error_on_every_rank():
    with pytest.raises(LostPartner, match="particle 99 of a solid is lost"):
        owners(COMM, np.arange(5) + 5 * COMM.rank, np.array([99] if COMM.rank == 0 else [0], np.int64))


def test_a_scene_without_solids_carries_nothing_for_them():
    from parallel.test_simulation import box

    simulation = start(box(2, False, 0), COMM)
    assert simulation.engine.of("solids") is None and not solid_plan(simulation.plan).solids
    names = set(simulation.store.fields)
    assert names.isdisjoint(
        {"reference", "moment", "stress", "von_mises", "stored_energy", "drawn", "plastic_metric"}
    )
