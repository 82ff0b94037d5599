"""How long lists hold where sizes stay: a bound by the last look at neighbours leaves most looks out."""

import numpy as np
import pytest
from cases.test_refined import begun, stream, together
from mpi4py import MPI
from parallel.test_simulation import state

from psph.matter import refinement
from psph.matter.refinement import LEAST_SKIN, SKINS
from psph.parallel.straying import Straying


@pytest.fixture
def wide(monkeypatch):
    """Lists stay as wide as they may be."""
    monkeypatch.setattr(refinement, "LEAST_SKIN", SKINS[2])


def long_wave(folder):
    """A box that repeats, with a finer part."""
    return stream(folder, length=2.4, width=0.3, lower=0.6, upper=1.8, speed=0.0)


def shorn(case, steps, comm=MPI.COMM_SELF, speed=1.0):
    """Shear with a long wave, whose neighbours go together for long, at a ``speed``, m/s: the simulation after
    some steps, those in which lists were made, and how often neighbours were looked at."""
    simulation = begun(
        case,
        lambda x: np.stack([0.0 * x[:, 0], speed * np.sin(2.0 * np.pi * x[:, 0] / 2.4)], axis=1),
        lambda x: 0.0 * x[:, 0],
        comm,
    )
    made, looks, skin = [], [], simulation.neighbourhood.skin
    see = skin._see_who_goes_together

    def seen(mirrored):
        looks.append(simulation.steps)
        return see(mirrored)

    skin._see_who_goes_together = seen
    for _ in range(steps):
        lists = simulation.domain.rebuilds
        simulation.step()
        made += [simulation.steps] * (simulation.domain.rebuilds > lists)
    return simulation, made, looks


def test_fewer_looks_and_the_same_lists(tmp_path, monkeypatch, wide):
    few, made, looks = shorn(long_wave(tmp_path), 40)
    monkeypatch.setattr(Straying, "_bound", lambda self, look: np.inf)
    many, as_before, each_step = shorn(long_wave(tmp_path), 40)
    assert made == as_before and len(made) > 2
    assert len(looks) < 0.5 * len(each_step)
    assert np.array_equal(state(few)[0], state(many)[0])


def test_a_bound_is_no_less_than_what_a_look_finds(tmp_path, monkeypatch):
    """Of who stray anyhow, each by another way; the control, which forgets these ways, is less."""
    simulation = shorn(long_wave(tmp_path), 5)[0]
    straying, store, rng = simulation.neighbourhood.skin, simulation.store, np.random.default_rng(1)
    straying._see_who_goes_together(0.0)
    look, narrow = straying._look, 0.002 * straying._look.narrowest
    for n in range(20):
        for x in store["position"]:
            x[store.inner] += narrow * (rng.uniform(-1.0, 1.0, store.owned) + n)
        found = straying._see_who_goes_together(0.0)
        assert straying._bound(look) > found > 0.5 * look.apart


def test_who_goes_on_looks_again_and_has_the_same_lists(tmp_path, wide):
    """From a checkpoint nobody knows of the last look."""
    case = long_wave(tmp_path)
    whole, _, _ = shorn(case, 45)
    cut, _, _ = shorn(case, 16)
    straying = cut.neighbourhood.skin
    assert straying._look is not None
    straying.restore(straying.state())
    assert straying._look is None
    while cut.steps < whole.steps:
        cut.step()
    assert cut.domain.rebuilds == whole.domain.rebuilds > 3
    assert np.array_equal(state(cut)[0], state(whole)[0])


def test_lists_reach_as_far_as_pays(tmp_path):
    """They stay wide where they soon are worn; where they last they narrow, by as much on from a checkpoint."""
    case = long_wave(tmp_path)
    fast, slow = (shorn(case, steps, speed=speed)[0] for speed, steps in ((3.0, 40), (0.3, 200)))
    widths = [one.domain.sizes.skin for one in (fast, slow)]
    assert fast.domain.rebuilds > 4 and widths[0] == SKINS[2]
    assert slow.domain.rebuilds > 4 and LEAST_SKIN < widths[1] < 0.5 * SKINS[2]
    entries = [int(one.domain.lists.lengths[: one.store.owned].sum()) for one in (fast, slow)]
    assert entries[1] < 0.85 * entries[0]
    again = begun(case, lambda x: 0.0 * x, lambda x: 0.0 * x[:, 0])
    again.neighbourhood.skin.reach_as(slow.neighbourhood.skin.state())
    assert again.domain.sizes.skin == widths[1]


@pytest.mark.mpi(min_size=2)
def test_same_lists_and_looks_on_many_ranks(mpi_tmp_path):
    case = together(mpi_tmp_path, long_wave)
    (many, *found), (alone, *one) = (shorn(case, 40, comm) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    assert found == one and len(one[0]) > 2
    assert np.array_equal(state(many)[0], state(alone)[0])
