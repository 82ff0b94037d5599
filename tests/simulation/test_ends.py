"""Open ends by themselves: what particles behind a plane see, who is born and dies, waves that leave."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.particles.neighbours import Neighbours
from psph.physics.open_ends import (
    column_pressure,
    column_weight,
    follow,
    grown,
    of_pressure_end,
    of_velocity_end,
    parabola,
    pipe,
)
from psph.scene import ends
from psph.scene.end_columns import Column
from psph.simulation.end_fit import (
    FITTED,
    NEAR,
    SEEN,
    Flowing,
    Listed,
    Planes,
    Vicinity,
    room_for,
    see_fronts,
)
from psph.simulation.end_queues import DIES, STAYS, run_queues
from psph.smoothing import kernel

DX = 0.1


def around(dimensions, axis, sign):
    """A jittered lattice of fluid before a plane through the origin and a buffer of four rows behind it:
    places (dim, n), and whether each is behind."""
    drawn = np.random.default_rng(3)
    side = (np.arange(-5, 5) + 0.5) * DX
    places = np.stack(np.meshgrid(*[side] * dimensions, indexing="ij")).reshape(dimensions, -1)
    places = places[:, sign * places[axis] > -4.0 * DX]
    places = places + drawn.uniform(-0.1, 0.1, places.shape) * DX
    return places, sign * places[axis] < 0.0


def seen_by(dimensions, axis, sign, field, added=(0.0, 0.0), gravity=None, under=False):
    """What the buffer sees of fluid whose pressure and velocity are ``field`` (1 + dim, n) of places, ``under``
    a surface or not."""
    places, behind = around(dimensions, axis, sign)
    p, *v = field(places)
    n, gravity = places.shape[1], gravity or (0.0,) * dimensions
    p, v = p + added[0] * behind, np.array(v)
    v[axis] += added[1] * sign * behind
    lists = Neighbours(
        np.arange(n, dtype=np.uint64) * np.uint64(n),
        np.full(n, n, np.uint32),
        np.tile(np.arange(n, dtype=np.uint32), n),
    )
    columns = np.flatnonzero(behind)
    pushed = np.array(added)[:, None]
    still, surface = np.zeros(1), np.array([under])
    stands = np.array([axis]), still, still, np.array([float(sign)])
    planes = Planes(*stands, *pushed, *[None] * 7, 0.0, surface)
    vicinity = Vicinity(kernel("wendland-c2", 1.4 * DX, dimensions), DX, gravity, (None,) * dimensions)
    seen = np.zeros((len(columns), FITTED + 1 + dimensions))
    flowing = Flowing(tuple(places), None, tuple(v), None, np.full(n, 1e-3), p, None, None, None)
    matter, none = np.where(behind, -1, 1), np.zeros(len(columns), np.int64)
    listed, room = Listed(0, lists, matter), room_for(dimensions)
    see_fronts(columns, none, planes, vicinity, listed, flowing, room, seen)
    return seen, places[:, columns]


@pytest.mark.parametrize(
    "dimensions, axis, sign", [(1, 0, 1), (2, 0, 1), (2, 1, -1), (3, 0, -1), (3, 1, 1), (3, 2, 1)]
)
def test_what_is_linear_across_the_face_is_seen_exactly(dimensions, axis, sign):
    """Where fluid in front of the plane is seen by itself.  Control: along the normal it is not."""
    slopes = np.arange(1.0, 1.0 + dimensions)
    slopes[axis] = 0.0

    def field(x):
        return np.stack([(3.0 + n) + (slopes * (1.0 + n)) @ x for n in range(1 + dimensions)])

    seen, places = seen_by(dimensions, axis, sign, field)
    near = seen[:, NEAR] > 0.0
    assert near.any() and seen[near, SEEN].all()
    np.testing.assert_allclose(seen[near, FITTED:], field(places[:, near]).T, atol=1e-12)
    slopes[axis] = 1.0
    seen, places = seen_by(dimensions, axis, sign, field)
    assert abs(seen[near, FITTED:] - field(places[:, near]).T).max() > DX


@pytest.mark.parametrize("dimensions, axis, sign", [(2, 0, 1), (2, 1, -1), (3, 1, 1), (3, 2, -1)])
def test_a_profile_is_seen_with_its_curvature(dimensions, axis, sign):
    """Velocities of second order across the face are seen exactly within it, so that what leaves is as fast as
    what comes.  Control: under a surface, where rows of the fluid come and go, they are not."""
    bent = np.outer(np.arange(1.0, 1.0 + dimensions), np.arange(2.0, 2.0 + dimensions))
    bent[axis], bent[:, axis] = 0.0, 0.0

    def field(x):
        v = 3.0 + np.einsum("ij,in,jn->n", bent, x, x)
        return np.stack([0.0 * v, *[v] * dimensions])

    def off(under):
        seen, places = seen_by(dimensions, axis, sign, field, under=under)
        row = abs(places).max(axis=0) < 2.5 * DX
        row &= abs(places[axis]) < DX
        return abs(seen[row, FITTED + 1 :] - field(places[:, row]).T[:, 1:]).max()

    assert off(False) < 1e-12
    assert off(True) > 1e-3


@pytest.mark.parametrize("dimensions, axis", [(2, 0), (3, 1)])
def test_what_was_added_to_the_buffer_is_taken_off(dimensions, axis):
    """Rows out of reach of the fluid see those before them, less what these got in the last step."""

    def field(x):
        return np.stack([np.full(x.shape[1], 2.0 + n) for n in range(1 + dimensions)])

    seen, places = seen_by(dimensions, axis, 1, field, added=(50.0, 0.3))
    far = (seen[:, SEEN] > 0.0) & (seen[:, NEAR] == 0.0)
    assert far.any()
    np.testing.assert_allclose(seen[far, FITTED:], field(places[:, far]).T, atol=1e-12)


def test_a_still_column_is_seen_as_one():
    """ρg·x is taken along: across the face, and along it."""
    gravity = (2.0, -9.0)

    def field(x):
        return np.stack([1000.0 * (np.array(gravity) @ x), 0.0 * x[0], 0.0 * x[0]])

    seen, places = seen_by(2, 0, 1, field, gravity=gravity)
    near = seen[:, NEAR] > 0.0
    np.testing.assert_allclose(seen[near, FITTED], field(places[:, near])[0], atol=1e-9)


def queued(depth, across, crossing, layers=4, period=0.0):
    """Fates and births of particles behind a plane in 2D, in spacings."""
    n = len(depth)
    fate, born = np.zeros(n, np.int64), np.zeros(n)
    places = np.array(depth, float) * DX, np.array([across], float) * DX
    run_queues(
        np.argsort(depth), *places, np.array([period * DX]), np.array(crossing), DX, layers, fate, born
    )
    return fate, born / DX


def test_who_comes_in_leaves_a_place_at_the_end_of_the_strip():
    """The strip beside it has no part in it."""
    fate, born = queued([-0.1, 0.9, 1.9, 2.9, 3.9], [0.0, 0.0, 0.0, 0.0, 1.0], [1, 0, 0, 0, 0])
    assert (fate == STAYS).all() and born.tolist() == pytest.approx([3.9, 0, 0, 0, 0])


def test_nobody_is_born_into_a_full_strip():
    """Control: one that is not full (above)."""
    fate, born = queued([-0.1, 0.5, 1.5, 2.5, 3.5], [0.0] * 5, [1, 0, 0, 0, 0])
    assert not born.any() and (fate == STAYS).all()


def test_who_goes_out_takes_the_place_of_the_last():
    """Where the strip would hold more than its layers."""
    fate, born = queued([0.1, 0.9, 1.9, 2.9, 3.9], [0.0] * 5, [-1, 0, 0, 0, 0])
    assert fate.tolist() == [STAYS] * 4 + [DIES] and not born.any()
    fate, _ = queued([0.1, 0.9, 1.9, 2.9], [0.0] * 4, [-1, 0, 0, 0])
    assert (fate == STAYS).all()


def test_who_is_too_deep_dies_and_strips_go_on_across_a_period():
    """A strip at one end of a period holds those at the other."""
    fate, _ = queued([5.6, 1.0], [0.0, 0.0], [0, 0])
    assert fate.tolist() == [DIES, STAYS]
    _, born = queued([-0.1, 0.9, 1.9, 2.9, 3.9], [0.1, 9.9, 9.9, 9.9, 9.9], [1, 0, 0, 0, 0], period=10.0)
    assert not born.any()  # full, by way of the period
    _, born = queued([-0.1, 0.9, 1.9, 2.9, 3.9], [0.1, 9.9, 9.9, 9.9, 9.9], [1, 0, 0, 0, 0])
    assert born.any()


def test_to_and_fro_keeps_the_number():
    """One that crosses in and out again, many times: the strip has four layers or three and a half."""
    depth = [0.1, 1.1, 2.1, 3.1]
    for _ in range(20):
        fate, born = queued([-0.1, *depth[1:]], [0.0] * 4, [1, 0, 0, 0])
        depth = [*depth[1:], *born[born > 0.0]]
        assert len(depth) == 4 and (fate == STAYS).all()
        fate, born = queued([0.1, *depth], [0.0] * 5, [-1, 0, 0, 0, 0])
        depth = [d for d, one in zip([0.1, *depth], fate) if one == STAYS]
        assert len(depth) == 4 and not born.any()


Z = 1500.0


def test_a_wave_that_goes_out_finds_no_answer():
    """p' = −Z u' with u inward goes out: its pressure and its speed are what the end adds, as if the fluid
    went on.  Controls: a wave that comes in is taken away at once, and the mean state is left alone."""
    for size in (40.0, -7.0):
        out = of_pressure_end(size, 0.0, -size / Z, 0.0, Z)
        assert out == pytest.approx((size, 0.0))
        out = of_velocity_end(-size / Z, 0.0, size, 0.0, Z)
        assert out == pytest.approx((0.0, -size / Z))
    assert of_pressure_end(3.0, 3.0, 0.2, 0.2, Z) == pytest.approx((0.0, 0.0))
    assert of_velocity_end(0.2, 0.2, 3.0, 3.0, Z) == pytest.approx((0.0, 0.0))
    assert of_pressure_end(40.0, 0.0, 40.0 / Z, 0.0, Z) == pytest.approx((0.0, -40.0 / Z))


def test_profiles_have_a_mean_of_one():
    """Over a fine lattice of the face; they are zero at its sides."""
    s = (np.arange(400) + 0.5) / 400
    line = parabola(s[:, None] * 2.0 + 1.0, np.array([1.0]), np.array([3.0]))
    assert line.mean() == pytest.approx(1.0, abs=1e-4) and line.max() == pytest.approx(1.5, abs=1e-4)
    y, z = (x.ravel() for x in np.meshgrid(s, s))
    both = np.stack([y, z], axis=1)
    low, high = np.zeros(2), np.ones(2)
    assert parabola(both, low, high).mean() == pytest.approx(1.0, abs=1e-4)
    inside = np.hypot(y - 0.5, z - 0.5) < 0.5
    assert pipe(both, low, high)[inside].mean() == pytest.approx(1.0, abs=2e-3)
    assert not pipe(both, low, high)[~inside].any()


def test_what_is_given_grows_and_references_follow():
    """Half of it after half of the ramp; 1 − 1/e of a jump after the settling time."""
    assert [grown(t, 2.0) for t in (0.0, 1.0, 2.0, 9.0)] == pytest.approx([0.0, 0.5, 1.0, 1.0])
    assert follow(1.0, 3.0, 0.5, 0.5) == pytest.approx(3.0 - 2.0 / np.e)


LAYERED = np.array([-np.inf, 0.9995, np.inf]), np.array([900.0, 700.0]), np.array([30.0, 20.0])


def test_layers_under_a_level_are_at_rest():
    """dp/dz = −ρg with the density of its own pressure, and none above; there are two densities."""
    edges, rest, sound = LAYERED
    z, g = np.linspace(0.0, 2.0, 2001), 9.81
    p = np.array([column_pressure(2.0, one, g, edges, rest, sound) for one in z])
    of = np.where(z < edges[1], 0, 1)
    density = rest[of] + p / sound[of] ** 2
    np.testing.assert_allclose(-np.diff(p), 0.5 * (density[1:] + density[:-1]) * g * 1e-3, rtol=2e-4)
    assert column_pressure(2.0, 2.5, g, edges, rest, sound) == 0.0


def test_weight_is_that_of_the_layers_between():
    """Up and down from the middle, across the edge and within a layer."""
    edges, rest, _ = LAYERED
    for middle, height, weight in (
        (0.5, 1.5, -799.9),
        (1.5, 0.5, 799.9),
        (0.2, 0.7, -450.0),
        (2.0, 1.5, 350.0),
    ):
        assert column_weight(middle, height, 1.0, edges, rest) == pytest.approx(weight)


STREAM = """
space = { dimensions = 2, spacing = 0.1, periodic = ["y"], lower = [-0.4, 0.0], upper = [1.4, 1.0] }
time.end = 9.0
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
velocity = [1.0, 0.0]
[ends.inlet]
at = 0.0
inward = "+x"
velocity = 1.0
[ends.outlet]
at = 1.0
inward = "-x"
pressure = 0.0
"""


def test_forces_do_not_move_a_buffer_and_books_balance(tmp_path):
    """Particles inside less those of the start are what came in less what went out, exactly; buffers keep
    their number; nobody has the number of another."""
    simulation = start(draft(tmp_path, STREAM))
    store, buffers = simulation.store, simulation.engine.of("ends")
    before = np.count_nonzero(store.shown("kind") == 0)
    mass = store.shown("mass")[0]
    for _ in range(450):
        simulation.step()
        assert not store["acceleration"][0][buffers.behind.columns].any()
    books = [state.books for state in buffers.states]
    assert min(book.number_in + book.number_out for book in books) > 50
    gained = sum(book.number_in - book.number_out for book in books)
    assert np.count_nonzero(store.shown("kind") == 0) == before + gained
    assert sum(book.mass_in for book in books) == pytest.approx(mass * books[0].number_in)
    assert np.count_nonzero(store.shown("kind") == 4) == 80
    assert len(np.unique(store.shown("id"))) == store.owned
    speed = store.shown("velocity")[:, 0]
    assert abs(speed - 1.0).max() < 1e-5


DUCT = STREAM.replace(', periodic = ["y"], lower = [-0.4, 0.0], upper = [1.4, 1.0]', "")
DUCT += """
[walls.duct.shape.difference]
from.box = { lower = [-0.4, -0.4], upper = [1.4, 1.4] }
minus = [{ box = { lower = [-0.4, 0.0], upper = [1.4, 1.0] } }]
"""


@pytest.mark.parametrize("text, held", [(DUCT, True), (STREAM, False)])
def test_nothing_behind_a_plane_moves_through_the_walls_beside_it(tmp_path, text, held):
    """Where the fluid in front flows across the face, what leaves does too, but for the row that is at the
    wall.  Control: a domain that repeats has no such row."""
    simulation = start(draft(tmp_path, text))
    store = simulation.store
    for name in ("velocity", "predicted_velocity"):
        store[name][1][store.low + np.flatnonzero(store.shown("kind") == 0)] = 0.5
    simulation.step()
    x, y = store.shown("position").T
    leaves = (store.shown("kind") == 4) & (x > 1.0) & (x < 1.2)  # those behind see them a step later
    across = store.shown("velocity")[leaves, 1]
    assert across[y[leaves] < 0.9].min() > 0.1
    assert (across[y[leaves] > 0.95].max() == 0.0) == held


LAYERS = """
space = { dimensions = 2, spacing = 0.1, lower = [-0.5, -0.4], upper = [1.5, 1.0] }
time.end = 9.0
physics = { gravity = [0.0, -9.81], sound_speed = 35.0 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.3] }
pressure = "hydrostatic"
velocity = [0.4, 0.0]
[fluids.oil]
shape.box = { lower = [0.0, 0.3], upper = [1.0, 0.6] }
density = 700.0
pressure = "hydrostatic"
velocity = [0.4, 0.0]
[walls.floor]
shape.box = { lower = [-0.5, -0.4], upper = [1.5, 0.0] }
[ends.left]
at = 0.0
inward = "+x"
velocity = 0.4
[ends.right]
at = 1.0
inward = "-x"
velocity = -0.4
"""


def test_buffers_of_several_fluids_are_fluids(tmp_path):
    """Oil upon water comes in by layers: what stands behind a plane, and has come in, is of its fluid, and
    goes on to see what is in front."""
    simulation = start(draft(tmp_path, LAYERS))
    store, buffers = simulation.store, simulation.engine.of("ends")
    while simulation.time < 1.0:
        simulation.step()
        assert buffers.states[0].means.rows > 5.0
    assert buffers.states[0].books.number_in >= 18
    of = np.where(store.shown("rest_density") > 900.0, 1.0, 2.0)
    flows = store.shown("kind") != 1
    np.testing.assert_array_equal(store.shown("fluid")[flows], of[flows])
    assert abs(store.shown("velocity")[flows]).max() < 0.8


LAYERS_AT_REST = LAYERS.replace("velocity = [0.4, 0.0]\n", "").replace(
    "upper = [1.5, 1.0] }", "upper = [1.5, 1.4] }", 1
)
BY_LEVELS = ('ends.left={at=0.0,inward="+x",level=0.6}', 'ends.right={at=1.0,inward="-x",level=0.6}')
MIDDLE = 0.3 * 9.81 * 700.0
BY_PRESSURES = tuple(one.replace("level=0.6", f"pressure={MIDDLE}") for one in BY_LEVELS)
LID = ("walls.lid.shape.box={lower=[-0.5,0.6],upper=[1.5,1.0]}",)


@pytest.mark.parametrize("given", [BY_LEVELS, (*BY_PRESSURES, *LID)])
def test_layers_between_ends_rest(tmp_path, monkeypatch, given):
    """Oil upon water under a level or between plates stays at rest.  Control: under a column of oil alone the
    water is driven."""

    def fastest():
        simulation = start(draft(tmp_path, LAYERS_AT_REST, *given))
        while simulation.time < 0.8:
            simulation.step()
        store = simulation.store
        return abs(store.shown("velocity")[store.shown("kind") == 0]).max()

    assert fastest() < 0.02
    oil = Column(np.array([-np.inf, np.inf]), np.array([700.0]), np.array([35.0]))
    monkeypatch.setattr(ends, "column_of", lambda *_: (oil, None))
    assert fastest() > 0.1
