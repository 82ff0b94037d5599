"""Open ends beside particles of several sizes: flux and profile, who comes and goes, bits on ranks, checks."""

import numpy as np
import pytest
from cases.test_refined import leading, together
from drafts import draft
from gauging import start
from mpi4py import MPI
from parallel.test_simulation import state
from runs.resuming import go_on_alike, keep, steps, taken_up

from psph.scene import Scene, check
from psph.simulation import levels

PLATES = """
time.end = 8.0
physics.sound_speed = 15.0
[space]
dimensions = 2
spacing = 0.1
[[space.refine]]
shape.box = { lower = [1.5, -0.4], upper = [2.5, 1.4] }
[fluids.oil]
density = 1.0
viscosity = 0.1
shape.box = { lower = [0.0, 0.0], upper = [4.0, 1.0] }
velocity = [1.0, 0.0]
[walls.plates]
shape.difference.from.box = { lower = [-0.6, -0.4], upper = [4.6, 1.4] }
shape.difference.minus = [{ box = { lower = [-0.6, 0.0], upper = [4.6, 1.0] } }]
no_slip = true
[ends.inlet]
at = 0.0
inward = "+x"
velocity = 1.0
profile = "parabola"
[ends.outlet]
at = 4.0
inward = "-x"
pressure = 0.0
"""
"""Poiseuille's flow, ten coarse and twenty finer spacings across."""

CHANNEL = """
time.end = 6.0
[space]
dimensions = 2
spacing = 0.1
[[space.refine]]
shape.box = { lower = [1.5, -0.4], upper = [2.5, 1.4] }
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [4.0, 0.6] }
pressure = "hydrostatic"
velocity = [1.5, 0.0]
[walls.bed]
shape.box = { lower = [-0.8, -0.4], upper = [4.8, 0.0] }
[ends.upstream]
at = 0.0
inward = "+x"
flow = 0.9
[ends.downstream]
at = 4.0
inward = "-x"
level = { file = "level.csv", time = "t", value = "h" }
"""
"""A channel whose level rises, so that rows come and go behind its ends too."""


def plates(folder):
    """The flow between plates."""
    return draft(folder, PLATES)


def channel(folder):
    """The channel."""
    (folder / "level.csv").write_text("t,h\n0.0,0.6\n0.1,0.7\n6.0,0.7\n")
    return draft(folder, CHANNEL)


def through_the_region(case):
    """Of 5 to 8 s the means of the flux in front of, in and behind the region, over what is given, and the
    L2 error of the profile in the region.  Weights of a hat count whole rows wherever these are."""
    simulation, flux, error = start(case), [], []
    while simulation.time < 8.0:
        simulation.step(8.0)
        if simulation.time > 5.0 and simulation.passed(10):
            x, v, _, m, _ = leading(simulation)
            hats = [np.maximum(1.0 - np.abs(x[:, 0] - middle) / 0.4, 0.0) / 0.4 for middle in (0.8, 2.0, 3.2)]
            flux.append([hat @ (m * v[:, 0]) for hat in hats])
            inside = np.abs(x[:, 0] - 2.0) < 0.2
            u, exact = v[inside, 0], 6.0 * x[inside, 1] * (1.0 - x[inside, 1])
            error.append(((u - exact) ** 2).sum() / (exact**2).sum())
    return np.mean(flux, axis=0), np.sqrt(np.mean(error))


def test_a_stream_keeps_its_flux_and_profile_through_a_finer_region(tmp_path, monkeypatch):
    """With one spacing, coarse: 1.012 and 1.7 %; fine: 1.005 and 0.7 %; measured: 1.004 to 1.008, 1.4 %."""
    case = plates(tmp_path)
    flux, error = through_the_region(case)
    assert abs(flux - 1.0).max() < 0.01 and np.ptp(flux) < 0.006
    assert error < 0.016
    monkeypatch.setattr(levels, "ORDER", 0)
    assert through_the_region(case)[1] > 0.02  # the control: followers take means


def test_what_comes_less_what_goes_is_there(tmp_path):
    """Where rows of a channel fill, those that lead have as much more mass in the mean as the books say; now and
    then parts of a coarse row, 0.025 of the channel, are about to change sides at a border."""
    simulation, off = start(channel(tmp_path)), []
    before = leading(simulation)[3].sum()
    while simulation.time < 1.0:
        simulation.step(1.0)
        books = [one.books for one in simulation.engine.of("ends").states]
        net = sum(one.mass_in - one.mass_out for one in books)
        _, _, _, m, level = leading(simulation)
        off.append((m.sum() - before - net) / before)
    assert min(books[0].number_in, books[1].number_out) > 4
    assert abs(np.mean(off)) < 0.001 and max(map(abs, off)) < 0.02
    assert set(level) == {0, 1}
    species = simulation.plan.materials.species
    ended = np.array([one.ends_fluid for one in species])[simulation.store.shown("group")]
    assert np.array_equal(simulation.store.shown("ends_fluid") > 0.0, ended) and ended.any()
    assert len(np.unique(simulation.store.owned_rows("id"))) == simulation.store.owned


def test_an_end_acts_at_whole_steps_of_the_coarsest(tmp_path):
    """Within one nobody changes sides, and buffers keep their state."""
    simulation = start(plates(tmp_path))
    buffers, one, seen = simulation.engine.of("ends"), simulation._advance, []

    def watched(dt, left, end):
        kept = [state.means.pressure for state in buffers.states]
        one(dt, left, end)
        seen.append((left, kept != [state.means.pressure for state in buffers.states]))

    simulation._advance = watched
    for _ in range(20):
        simulation.step()
    assert simulation.plan.pace == 2
    assert all(acted == (left == 0) for left, acted in seen) and len(seen) == 40


@pytest.mark.mpi(min_size=2)
def test_same_bits_where_ends_and_levels_bear(mpi_tmp_path):
    case = together(mpi_tmp_path, channel)
    many, single = (steps(case, comm, 120) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    first, last = (one.books for one in single.engine.of("ends").states)
    assert first.born > 0 < last.died and single.engine.of("refine").counts[1, levels.BORN] > 0
    (rows, *_), (alone, *_) = state(many), state(single)
    assert np.array_equal(rows, alone)
    assert many.engine.of("ends").state() == single.engine.of("ends").state()


@pytest.mark.mpi(min_size=2)
def test_ends_beside_levels_go_on_on_one_rank(mpi_tmp_path):
    case = together(mpi_tmp_path, channel)
    simulation = steps(case, MPI.COMM_WORLD, 70)
    written = keep(simulation, case, mpi_tmp_path)
    MPI.COMM_WORLD.Barrier()
    go_on_alike(simulation, taken_up(case, written, MPI.COMM_SELF), 60)


@pytest.mark.parametrize(
    "region, by",
    [
        ("lower = [3.0, -0.4], upper = [4.6, 1.4]", "by 1.47 m"),
        ("lower = [2.2, -0.4], upper = [3.0, 1.4]", "by 0.19 m"),
    ],
)
def test_an_end_that_finer_particles_may_come_to_is_refused(region, by, tmp_path):
    scene = Scene(draft(tmp_path, PLATES.replace("lower = [1.5, -0.4], upper = [2.5, 1.4]", region)))
    with pytest.raises(Exception, match=r"ends.outlet.at: 4 m: .* space.refine\[0\]") as told:
        check(scene)
    assert str(told.value).endswith(by)


def test_a_plane_that_comes_to_a_region_is_refused(tmp_path):
    """It goes 0.5 m with its wall."""
    more = "walls.piston={shape={box={lower=[-0.6,1.0],upper=[0.0,1.4]}},motion={translation={velocity=[0.5,0.0]}}}"
    check(Scene(draft(tmp_path, PLATES)))
    scene = Scene(draft(tmp_path, PLATES, more, 'ends.inlet.on="piston"'))
    with pytest.raises(Exception, match="ends.inlet.at: 0 m: "):
        check(scene)
