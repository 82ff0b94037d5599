"""A kind of matter from a user's file: dust that the fluid drags, and it the fluid."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from guests.test_guests import begin

from psph.case import CaseError, load
from psph.fields import OTHER
from psph.runs.explain import explain
from psph.scene import Scene, check

BOX = """
use = ["dust.py"]
scheme = "sph"
space = { dimensions = 2, spacing = 0.05, smoothing = 2.0, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [1.0, 1.0] }
time.end = 1.0
physics.sound_speed = 20.0
fluids.gas.shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }

[dust.silt]
shape.box = { lower = [-0.025, -0.025], upper = [0.975, 0.975] }
density = 500.0
stopping_time = 0.05
velocity = [1.0, 0.5]
"""

STEPS = 40


@pytest.fixture
def path(tmp_path):
    """A function: what is replaced in the case, pair by pair → its path."""

    def make(*pairs, more=""):
        shutil.copy(Path(__file__).parent / "dust.py", tmp_path)
        text = more + BOX
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "dusty.toml").write_text(text)
        return tmp_path / "dusty.toml"

    return make


def momentum(store) -> np.ndarray:
    return (store.shown("mass")[:, None] * store.shown("velocity")).sum(axis=0)


def kinetic(store) -> float:
    return float(0.5 * (store.shown("mass") * (store.shown("velocity") ** 2).sum(axis=1)).sum())


def test_grains_and_fluid_come_to_one_velocity_and_the_books_close(path):
    """u = u₀ exp(−(1 + ε) t/t_s) with ε = ρ_dust/ρ, and what motion loses is heat."""
    simulation = begin(path())
    store = simulation.store
    grains = store.shown("kind") == OTHER
    assert np.count_nonzero(grains) == np.count_nonzero(~grains) == 400
    before, energy = momentum(store), kinetic(store)
    for _ in range(STEPS):
        simulation.step()
    grains, u = store.shown("kind") == OTHER, store.shown("velocity")
    apart = u[grains].mean(axis=0) - u[~grains].mean(axis=0)
    assert apart == pytest.approx(np.array([1.0, 0.5]) * np.exp(-1.5 * simulation.time / 0.05), rel=0.02)
    assert np.abs(momentum(store) - before).max() < 1e-12 * np.abs(before).max()
    [heat] = simulation.engine.booked()
    assert heat > 0.3 * energy and kinetic(store) + heat == pytest.approx(energy, rel=1e-6)


def test_without_its_effect_grains_fly_on_and_nothing_is_heated(path):
    """The control: it is the drag that slows them."""
    case = path()
    mine = case.parent / "dust.py"
    mine.write_text(
        mine.read_text().replace(
            "add(total, scale(", "add(total, scale(zero_like(i.position), 0.0) if True else scale("
        )
    )
    simulation = begin(case)
    for _ in range(4):
        simulation.step()
    store = simulation.store
    assert store.shown("velocity")[store.shown("kind") == OTHER] == pytest.approx(
        np.array([[1.0, 0.5]] * 400)
    )
    assert simulation.engine.booked() == [0.0]


def test_grains_settle_at_g_times_their_stopping_time_and_lie_on_the_ground(path):
    tank = (
        (
            'periodic = ["x", "y"], lower = [0.0, 0.0], upper = [1.0, 1.0]',
            'periodic = ["x"], lower = [0.0, -0.2], upper = [1.0, 1.0]',
        ),
        (
            "fluids.gas.shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }",
            'fluids.gas = { pressure = "hydrostatic", shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.8] } }\nwalls.floor.shape.box = { lower = [0.0, -0.2], upper = [1.0, 0.0] }',
        ),
        ("lower = [-0.025, -0.025], upper = [0.975, 0.975]", "lower = [0.0, 0.025], upper = [1.0, 0.4]"),
        ("density = 500.0", "density = 1.0"),
        ("velocity = [1.0, 0.5]\n", ""),
    )
    simulation = begin(path(*tank, more="physics.gravity = [0.0, -9.81]\n"))
    store = simulation.store
    while simulation.time < 0.25:
        simulation.step()
    falls = (store.shown("kind") == OTHER) & (store.shown("position")[:, 1] > 0.15)
    assert np.median(store.shown("velocity")[falls][:, 1]) == pytest.approx(-9.81 * 0.05, rel=0.1)
    lies = (store.shown("kind") == OTHER) & (store.shown("bed") >= 0.5)
    assert lies.any() and not store.shown("velocity")[lies].any()
    assert store.shown("position")[lies][:, 1].min() > -0.05


def test_grains_that_lie_on_a_wall_that_moves_go_with_it(path):
    """Everything drifts at 5 m/s: grains that begin in the floor do so too."""
    drifting = (
        (
            "fluids.gas.shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }",
            "fluids.gas = { velocity = [5.0, 0.0], shape.box = { lower = [0.0, 0.2], upper = [1.0, 0.8] } }\n"
            "walls.floor = { shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.2] }, "
            "motion.translation = [5.0, 0.0] }",
        ),
        ("lower = [-0.025, -0.025], upper = [0.975, 0.975]", "lower = [0.0, 0.1], upper = [1.0, 0.6]"),
        ("velocity = [1.0, 0.5]", "velocity = [5.0, 0.0]"),
    )
    simulation = begin(path(*drifting))
    for _ in range(10):
        simulation.step()
    store = simulation.store
    grains = store.shown("kind") == OTHER
    lies = grains & (store.shown("bed") >= 0.5)
    assert 0 < np.count_nonzero(lies) < np.count_nonzero(grains)
    assert np.abs(store.shown("velocity")[grains] - [5.0, 0.0]).max() < 1e-9


@pytest.mark.parametrize(
    ("pairs", "says"),
    [
        (
            [
                (
                    "[dust.silt]",
                    "bodies.b = { shape.box = { lower = [0.2, 0.2], upper = [0.4, 0.4] }, mass = 1.0 }\n[dust.silt]",
                )
            ],
            "bodies: dust knows nothing of it",
        ),
        ([("stopping_time = 0.05", "stopping_time = -1.0")], "dust.silt.stopping_time"),
        ([("[-0.025, -0.025]", "[-0.025]")], "dust.silt.shape"),
    ],
)
def test_what_a_case_cannot_ask_of_it_is_refused(pairs, says, path):
    with pytest.raises(CaseError, match=says):
        load(path(*pairs))


def test_two_kinds_have_groups_of_their_own(path):
    """Each moves its own particles: the control is what both would take from the first group on."""
    dye = "markers.dye.shape.box = { lower = [0.1, 0.1], upper = [0.3, 0.2] }\n[dust.silt]"
    case = path(('use = ["dust.py"]', 'use = ["dust.py", "markers.py"]'), ("[dust.silt]", dye))
    shutil.copy(Path(__file__).parent / "markers.py", case.parent)
    simulation = begin(case)
    store, grains = simulation.store, simulation.engine.of("dust")
    assert store.group[grains.own].tolist() == [1] * 400
    before = store.shown("position").copy()
    simulation.step()
    moved = np.abs(store.shown("position") - before).max(axis=1)
    assert np.count_nonzero(store.shown("group") == 2) == 8
    assert moved[store.shown("group") == 1].min() > 0.5 * simulation.time > 0.0
    assert moved[store.shown("group") == 2].max() < 0.1 * simulation.time  # the fluid is at rest at first


def test_its_checks_are_those_of_psph(path):
    empty = [
        ("lower = [-0.025, -0.025], upper = [0.975, 0.975]", "lower = [0.51, 0.51], upper = [0.52, 0.52]")
    ]
    with pytest.raises(CaseError, match="dust.silt.shape: no site lies in it"):
        check(Scene(load(path(*empty))))
    brief = Scene(load(path(("stopping_time = 0.05", "stopping_time = 1e-5"))))
    assert [line for line in check(brief) if "dust.silt.stopping_time: 1e-05 s makes short steps" in line]


def test_explain_tells_of_it_and_counts_it(path):
    lines = [*explain(Scene(load(path())), 1)]
    assert "  particles   800 in 2D, spacing 0.05 m" in lines
    assert "  dust        silt: 400 grains, 500 kg/m3, stopped in 0.05 s" in lines
    assert any(line.split() == ["drag", "of", "dust.silt", "0.0167", "s"] for line in lines)


def test_a_kind_by_the_name_of_a_table_of_psph_is_refused(path):
    case = path()
    mine = case.parent / "dust.py"
    mine.write_text(mine.read_text().replace('Entry("dust", Dust)', 'Entry("soils", Dust)'))
    with pytest.raises(CaseError, match="soils, and there is one"):
        load(case)
