"""Fluids that start relaxed: even without order, in their shapes, with the state of where they are."""

import numpy as np
import pytest
from drafts import ROUND, WATER, draft, refusal
from mpi4py import MPI
from runs.resuming import keep, steps, taken_up

from psph.fields import FLUID
from psph.runs.explain import explain
from psph.runs.setup import lattice_particles
from psph.scene import Scene
from psph.smoothing import slope_over_r, weight

PERIODIC = (
    ROUND
    + """
[time]
end = 1.0
[physics]
sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
"""
)

TANK = """
[space]
dimensions = 2
spacing = 0.05
[time]
end = 1.0
[physics]
gravity = [0.0, -10.0]
sound_speed = 30.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.4] }
start = "relaxed"
pressure = "hydrostatic"
velocity_gradient = [[0.0, 2.0], [0.0, 0.0]]
[fluids.oil]
shape.box = { lower = [0.0, 0.4], upper = [0.8, 0.7] }
start = "relaxed"
density = 800.0
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [1.0, 1.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [0.8, 1.0] } }]
"""
"""Oil with a free surface on water."""

RELAXED = "fluids.water.start=relaxed"
MIRRORS = "space.symmetry=['x.lower','y.lower']"


def found(folder, text, *sets):
    """A scene and its particles."""
    scene = Scene(draft(folder, text, *sets))
    return scene, lattice_particles(scene, MPI.COMM_SELF)


def unevenness(scene, x):
    """Standard deviation of Σ V W, and root mean square of h |Σ V ∇W|, of particles that fill a period."""
    layout, kernel = scene.layout, scene.layout.kernel
    away = x[:, None] - x[None]
    away -= np.array(layout.periods) * np.rint(away / np.array(layout.periods))
    r = np.sqrt((away**2).sum(axis=2))
    pairs = np.nonzero((r > 0.0) & (r < layout.support))
    w, steep = np.zeros_like(r), np.zeros_like(r)
    w[pairs] = [weight(kernel, one) for one in r[pairs]]
    steep[pairs] = [slope_over_r(kernel, one, 1.0 / one) for one in r[pairs]]
    volume = layout.spacing**layout.dimensions
    crowding = volume * (steep[:, :, None] * away).sum(axis=1)
    size = np.sqrt((crowding**2).sum(axis=1).mean())
    return (volume * w.sum(axis=1)).std(), layout.smoothing_length * size


def test_it_is_even_without_order(tmp_path):
    scene, relaxed = found(tmp_path, PERIODIC, RELAXED)
    _, jittered = found(tmp_path, PERIODIC, "fluids.water.jitter=0.1")
    (sums, crowding), control = unevenness(scene, relaxed.position), unevenness(scene, jittered.position)
    assert sums < 0.005 < 0.02 < control[0]
    assert crowding < 0.005 < 0.05 < control[1]
    ordered = [np.abs(np.exp(2j * np.pi * one.position / 0.05).mean(axis=0)) for one in (relaxed, jittered)]
    assert (ordered[0] < 0.15).all()  # the lattice is forgotten: chance leaves 1/√400
    assert (ordered[1] > 0.8).all()
    assert (relaxed.mass == jittered.mass).all()


def test_seeds_differ(tmp_path):
    _, one = found(tmp_path, PERIODIC, RELAXED)
    _, again = found(tmp_path, PERIODIC, RELAXED)
    _, other = found(tmp_path, PERIODIC, RELAXED, "fluids.water.seed=1")
    assert (one.position == again.position).all()
    assert np.abs(one.position - other.position).max() > 0.01


def test_fluids_fill_their_shapes_and_have_the_state_of_their_places(tmp_path):
    scene, all_of_it = found(tmp_path, TANK)
    lattice = all_of_it.where(all_of_it.kind != FLUID)
    assert lattice.position / 0.05 % 1.0 == pytest.approx(np.full_like(lattice.position, 0.5))  # walls stay
    water, oil = (all_of_it.where(all_of_it.material == k) for k in (0, 1))
    assert (len(water.id), len(oil.id)) == (16 * 8, 16 * 6)
    for one, low, high in ((water, 0.0, 0.4), (oil, 0.4, 0.7)):
        inside = [0.01, low + 0.01] < one.position, one.position < [0.79, high - 0.01]
        assert np.all(inside)
        assert np.sum(one.position[:, 1] > high - 0.045) >= 14  # of 16: a flat row lies along the surface
    law, depth = scene.species[0].law, 0.4 - water.position[:, 1]
    pressure = law.pressure(water.density, 1000.0, scene.sound_speed)
    assert pressure == pytest.approx(800.0 * 10.0 * 0.3 + 1000.0 * 10.0 * depth, rel=1e-6)
    assert water.velocity[:, 0] == pytest.approx(2.0 * water.position[:, 1])
    assert sorted(all_of_it.id.tolist()) == list(range(int(scene.census.counts.sum())))


def test_beside_mirrors_it_is_as_even_as_far_from_them(tmp_path):
    half = PERIODIC.replace("1.0, 1.0", "0.5, 0.5").replace(
        'periodic = ["x", "y"]', 'symmetry = ["x.lower", "x.upper", "y.lower", "y.upper"]'
    )
    scene, quarter = found(tmp_path, half, RELAXED)
    assert ((quarter.position > 0.0) & (quarter.position < 0.5)).all()
    images = [quarter.position * sign for sign in ([1, 1], [-1, 1], [1, -1], [-1, -1])]
    whole = Scene(draft(tmp_path, PERIODIC))
    sums, crowding = unevenness(whole, np.concatenate(images))
    assert sums < 0.005
    assert crowding < 0.005


OPEN = """
scheme = "sph"
space = {{ dimensions = 2, spacing = 0.1, kernel = "wendland-c2", smoothing = 1.4 }}
time.end = 1.0
physics.sound_speed = 10.0
[fluids.water]
start = "relaxed"
shape.{}
"""
FORMS = {
    "a disc": ("disc = { center = [0.0, 0.0], radius = 0.6 }", 112, 0.8),
    "three in a row": ("box = { lower = [0.0, 0.0], upper = [0.3, 0.1] }", 3, 0.9),
    "one": ("box = { lower = [0.0, 0.0], upper = [0.1, 0.1] }", 1, 0.0),
    "far from 0": ("box = { lower = [1e5, 1e5], upper = [100001.0, 100000.5] }", 50, 0.8),
}


@pytest.mark.parametrize(("shape", "many", "least"), FORMS.values(), ids=FORMS)
def test_small_round_and_far_shapes(tmp_path, shape, many, least):
    scene, relaxed = found(tmp_path, OPEN.format(shape))
    assert len(relaxed.id) == many
    assert scene.layout.holds(0, relaxed.position).all()
    away = np.linalg.norm(relaxed.position[:, None] - relaxed.position[None], axis=2)
    assert (away + np.eye(many)).min() > least * 0.1


def test_it_is_held_by_every_kind_of_wall_alike(tmp_path):
    places = [
        found(tmp_path, TANK, f"walls.tank.condition={condition}")[1].position
        for condition in ("dynamic", "extrapolated", "repulsive", "penalty")
    ]
    assert all((one == places[0]).all() for one in places)


def test_it_makes_room_for_a_body(tmp_path):
    hole = "{ disc = { center = [0.4, 0.3], radius = 0.1 } }"
    box = "shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.4] }"
    within = "shape.difference.from.box = { lower = [0.0, 0.0], upper = [0.8, 0.4] }"
    text = TANK.replace(box, f"{within}\nshape.difference.minus = [{hole}]")
    text = text[: text.index("[fluids.oil]")] + text[text.index("[walls.tank]") :]
    scene, beside = found(tmp_path, text + f"[bodies.disc]\nshape = {hole}\ndensity = 500.0\n")
    water, disc = (beside.position[beside.material == k] for k in (0, 2))
    assert scene.layout.holds(0, water).all()
    assert np.linalg.norm(water[:, None] - disc[None], axis=2).min() > 0.8 * 0.05


def test_a_run_that_goes_on_does_not_relax_again(tmp_path, monkeypatch):
    case = draft(tmp_path, PERIODIC, RELAXED)
    through = steps(case, MPI.COMM_SELF, 4)
    path = keep(steps(case, MPI.COMM_SELF, 2), case, tmp_path)
    monkeypatch.setattr("psph.runs.setup.relaxed", lambda *_: pytest.fail("it relaxes"))
    resumed = taken_up(case, path, MPI.COMM_SELF)
    for _ in range(2):
        resumed.step()
    for name in ("position", "velocity", "density"):
        assert (resumed.store.shown(name) == through.store.shown(name)).all(), name
    with pytest.raises(pytest.fail.Exception):
        steps(case, MPI.COMM_SELF, 0)  # the control: a start calls it


@pytest.mark.parametrize(
    ("text", "words"),
    {
        "one dimension": (
            "scheme = 'sph'\nspace = { dimensions = 1, spacing = 0.1 }\ntime.end = 1.0\nphysics.sound_speed = 9.0\n"
            "fluids.water = { shape.box = { lower = [0.0], upper = [1.0] }, start = 'relaxed' }",
            'fluids.water.start: "relaxed": a row of particles has but one even order',
        ),
        "jitter": (WATER + "start = 'relaxed'\njitter = 0.1", "fluids.water.jitter: 0.1: start = "),
        "a kick": (
            WATER + "start = 'relaxed'\n[[perturbations]]\nposition = [0.1, 0.1]\nvelocity = [1.0, 0.0]",
            "perturbations name sites of the lattice",
        ),
        "soils": (
            WATER.replace("fluids.water", "soils.sand")
            + "density = 2e3\nyoung = 1e6\npoisson = 0.3\nfriction_angle = 30.0\nstart = 'relaxed'",
            "soils.sand.start: unknown key",
        ),
        "solids": (
            WATER.replace("fluids.water", "solids.bar") + "young = 1e6\npoisson = 0.3\nstart = 'relaxed'",
            "solids.bar.start: unknown key",
        ),
        "another word": (WATER + "start = 'glass'", "fluids.water.start: "),
    }.values(),
)
def test_what_cannot_relax_is_refused(tmp_path, text, words):
    assert words in "\n".join(refusal(tmp_path, text))


def test_explain_says_that_it_relaxes(tmp_path):
    said = [line for line in explain(Scene(draft(tmp_path, TANK)), 1) if line.startswith("  start ")]
    assert said == ["  start       water, oil: relaxed from a shaken lattice in 200 passes before the run"]
    assert not [line for line in explain(Scene(draft(tmp_path, PERIODIC)), 1) if line.startswith("  start ")]
