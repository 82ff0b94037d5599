"""Drops under surface tension: their pressure, their currents and momentum, in 2D and 3D, alone and in others."""

import math

import numpy as np
import pytest
from cases.measures import CASES
from drafts import draft
from gauging import start
from long import LONG

from psph.case import load
from psph.physics.surface import tension
from psph.physics.surface.contact import ContactLine
from psph.scene import Scene

DROP = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 4.0
physics.sound_speed = 10.0
[fluids.water]
shape.disc = { center = [0.0, 0.0], radius = 1.0 }
density = 1.0
viscosity = 0.1
pressure = 1.0
"""
ALONE = "fluids.water.surface_tension=1.0"
BALL = (
    "space={dimensions=3,spacing=0.2}",
    "fluids.water.shape.disc=off",
    "fluids.water.shape.ball={center=[0.0,0.0,0.0],radius=1.0}",
    "fluids.water.pressure=2.0",
)


def immersed(density):
    """Overrides: the drop in a box of another fluid."""
    box = "{box={lower=[-2.0,-2.0],upper=[2.0,2.0]}}"
    return (
        "space={dimensions=2,spacing=0.1,periodic=['x','y'],lower=[-2.0,-2.0],upper=[2.0,2.0]}",
        f"fluids.other={{shape={{difference={{from={box},"
        f"minus=[{{disc={{center=[0.0,0.0],radius=1.0}}}}]}}}},density={density},viscosity=0.1}}",
        "fluids.water.interfacial_tension={other=1.0}",
    )


def settled(simulation, end):
    """At that time the mean pressure in the middle of the drop over that beside it, the root mean square of
    its velocity, its largest radius, and the momentum of all over that of the drop at 1 m/s."""
    while simulation.time < end:
        simulation.step()
    simulation.settle_pressure()
    store, inner = simulation.store, simulation.store.inner
    x, v = (np.array(store[name])[:, inner] for name in ("position", "velocity"))
    p, mass = np.array(store["pressure"])[inner], store.shown("mass")
    own, r = store.group[inner] == 0, np.linalg.norm(x, axis=0)
    beside = p[(r > 1.5) & (r < 2.0)]
    excess = p[own & (r < 0.6)].mean() - (beside.mean() if len(beside) else 0.0)
    momentum = np.abs((mass * v).sum(axis=1)).max() / (mass * own).sum()
    return excess, math.sqrt((v[:, own] ** 2).sum(axis=0).mean()), r[own].max(), momentum


@pytest.mark.parametrize("around", [(ALONE,), immersed(1.0), immersed(0.001)], ids=("none", "1:1", "1000:1"))
def test_a_drop_keeps_its_form_and_the_pressure_of_laplace(tmp_path, around):
    """σ/R, and some more on the crooked edge of a lattice with ten spacings a radius."""
    excess, speed, radius, momentum = settled(start(draft(tmp_path, DROP, *around)), 2.0)
    assert 1.0 < excess < 1.16 and speed < 0.03 and radius < 1.01 and momentum < 1e-13


@pytest.mark.parametrize("spacing, error", ((0.1, 0.05), (0.05, 0.025)))
def test_from_a_relaxed_start_the_pressure_is_that_of_laplace(tmp_path, spacing, error):
    """In the mean over two seconds: within 5 % at 10 spacings a radius and 2.5 % at 20."""
    relaxed = ("fluids.water.start='relaxed'", f"space.spacing={spacing}")
    simulation = start(draft(tmp_path, DROP, ALONE, *relaxed))
    found = [settled(simulation, 2.0 + 0.25 * n)[0] for n in range(9)]
    assert np.mean(found) == pytest.approx(1.0, abs=error)


def test_a_tension_that_ignores_the_curvature_errs_by_more(tmp_path, monkeypatch):
    """The control: it acts 1.5 spacings inside."""
    monkeypatch.setattr(tension, "DEPTH", 0.0)
    simulation = start(draft(tmp_path, DROP, ALONE, "fluids.water.start='relaxed'"))
    assert np.mean([settled(simulation, 2.0 + 0.25 * n)[0] for n in range(9)]) > 1.1


def test_a_ball_too(tmp_path):
    excess, speed, radius, momentum = settled(start(draft(tmp_path, DROP, ALONE, *BALL)), 0.5)
    assert 1.7 < excess < 2.3 and speed < 0.1 and radius < 1.05 and momentum < 1e-13


def test_without_tension_it_loses_its_pressure(tmp_path):
    """The control."""
    excess, *_ = settled(start(draft(tmp_path, DROP)), 2.0)
    assert excess < 0.1


HALF = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 4.0
physics.sound_speed = 10.0
[fluids.water]
shape.difference.from.disc = { center = [0.0, 0.0], radius = 1.0 }
shape.difference.minus = [{ box = { lower = [-2.0, -2.0], upper = [2.0, 0.0] } }]
density = 1.0
viscosity = 0.2
pressure = 1.0
surface_tension = 1.0
[walls.floor]
shape.box = { lower = [-3.0, -0.4], upper = [3.0, 0.0] }
"""


def angle(simulation, dx=0.1):
    """The contact angle of a drop of the form of a cap, degrees: by its height over half of its base."""
    x = np.array(simulation.store["position"])[:, simulation.store.inner]
    x = x[:, simulation.store.group[simulation.store.inner] == 0]
    foot = x[0, x[1] < dx]
    height = x[1].max() + 0.5 * dx
    return math.degrees(2.0 * math.atan(height / (0.5 * (np.ptp(foot) + dx))))


@pytest.mark.parametrize(
    "told, least, most", ((None, 85.0, 100.0), (60.0, 55.0, 72.0), (120.0, 112.0, 130.0))
)
def test_a_drop_on_a_wall_meets_it_at_the_angle_of_the_case(tmp_path, told, least, most):
    keys = [f"walls.floor.contact_angle={told}"] if told else []
    simulation = start(draft(tmp_path, HALF, *keys))
    while simulation.time < 4.0:
        simulation.step()
    assert least < angle(simulation) < most


def test_without_its_hold_on_walls_a_drop_is_lifted_off(tmp_path, monkeypatch):
    """The control."""
    monkeypatch.setattr(ContactLine, "in_scene", lambda self, scene: None)
    simulation = start(draft(tmp_path, HALF))
    while simulation.time < 2.5:
        simulation.step()
    store = simulation.store
    own = store.group[store.inner] == 0
    assert np.array(store["position"])[1, store.inner][own].min() > 0.3


BOUNDS = "space={{dimensions=2,spacing=0.1,lower=[{},-2.0],upper=[2.0,2.0]{}}}"
HALVED = (
    BOUNDS.format("0.0", ",symmetry=['x.lower']"),
    "fluids.water.shape.disc=off",
    "fluids.water.shape.difference={from={disc={center=[0.0,0.0],radius=1.0}},"
    "minus=[{box={lower=[-2.0,-2.0],upper=[0.0,2.0]}}]}",
)


def test_half_a_drop_before_a_plane_of_symmetry_moves_as_a_whole_one(tmp_path):
    found = []
    for keys in ((BOUNDS.format("-2.0", ""),), HALVED):
        simulation = start(draft(tmp_path, DROP, ALONE, *keys))
        for _ in range(40):
            simulation.step()
        x = np.array(simulation.store["position"])[:, simulation.store.inner]
        x = x[:, x[0] > 0.0]
        found.append(x[:, np.lexsort(np.round(x, 6))])
    assert np.abs(found[0] - found[1]).max() < 1e-13


FILM = f"{CASES}/tension/film.toml"


def retreat(*keys):
    """By how much the edge of the film of the case has drawn back at 2 and 4 s, m, and at 2 s, before the film at
    the plane of symmetry moves, the momentum of all over 2σt."""
    simulation, found, momentum = start(load(FILM, keys)), [], []
    store = simulation.store
    for time in (2.0, 4.0):
        while simulation.time < time:
            simulation.step()
        x, v = (np.array(store[name])[0, store.inner] for name in ("position", "velocity"))
        found.append(12.0 - x.max() - 0.05)
        momentum.append(-(store.shown("mass") * v).sum() / (2.0 * simulation.time))
    return found, momentum[0]


def rounded(time, thickness=1.0, sigma=1.0, rho=1.0):
    """By how much a film is drawn back that takes itself up into a round rim: s − D with the s for which
    s (s − D) = 2σt²/(ρe), D = √(4es/π); m."""
    least, most = 4.0 * thickness / math.pi, 100.0 * thickness
    for _ in range(60):
        s = 0.5 * (least + most)
        back = s - math.sqrt(4.0 * thickness * s / math.pi)
        least, most = (s, most) if s * back < 2.0 * sigma * time**2 / (rho * thickness) else (least, s)
    return back


def test_a_film_draws_back_as_by_taylor_and_culick():
    """Its momentum is 2σt, and its edge where the round rim has it that takes this up."""
    found, momentum = retreat()
    assert found == pytest.approx([rounded(2.0), rounded(4.0)], rel=0.02)
    assert momentum == pytest.approx(1.0, abs=0.005)


def test_without_tension_a_film_stays():
    """The control."""
    found, momentum = retreat("fluids.water.surface_tension=0.0")
    assert found == pytest.approx([0.0, 0.0], abs=0.06) and abs(momentum) < 1e-3


PLATES = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 6.0
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [-2.0, 0.0], upper = [2.0, 2.0] }
density = 1.0
viscosity = 0.2
surface_tension = 1.0
[walls.below]
shape.box = { lower = [-4.0, -0.4], upper = [4.0, 0.0] }
[walls.above]
shape.box = { lower = [-4.0, 2.0], upper = [4.0, 2.4] }
"""


def between_plates(path, angle, *keys):
    """Of a bridge in 2D, in the mean of 4 to 6 s: its pressure, Pa, and by how much it is thicker in the middle
    than at the plates, at each side, m."""
    angles = (f"walls.{name}.contact_angle={angle}" for name in ("below", "above"))
    simulation, found = start(draft(path, PLATES, *keys, *angles)), []
    store = simulation.store
    for time in (4.0, 4.5, 5.0, 5.5, 6.0):
        while simulation.time < time:
            simulation.step()
        simulation.settle_pressure()
        own = store.group[store.inner] == 0
        x, p = (
            np.array(store["position"])[:, store.inner][:, own],
            np.array(store["pressure"])[store.inner][own],
        )
        middle = np.ptp(x[0, np.abs(x[1] - 1.0) < 0.15])
        feet = 0.5 * (np.ptp(x[0, x[1] < 0.12]) + np.ptp(x[0, x[1] > 1.88]))
        found.append((p[np.abs(x[0]) < 1.0].mean(), 0.5 * (middle - feet)))
    return np.mean(found, axis=0)


PULLING = ("physics.tension_floor=off", "fluids.water.pressure=-0.5")
"""Overrides: walls pull, as a hollow meniscus must."""


@pytest.mark.parametrize("angle, keys", ((90.0, ()), (120.0, ()), pytest.param(60.0, PULLING, marks=LONG)))
def test_a_bridge_between_plates_has_the_meniscus_of_its_angle(tmp_path, angle, keys):
    """An arc of radius H/(−2 cos φ), its pressure σ over that; within a spacing and 0.15 σ/H."""
    pressure, bulge = between_plates(tmp_path, angle, *keys)
    cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    assert pressure == pytest.approx(-2.0 * cos / 2.0, abs=0.15)
    assert bulge == pytest.approx(-cos * (1.0 - sin) / cos**2 if angle != 90.0 else 0.0, abs=0.1)


def running(*keys):
    """The mean velocity of the drop of the case from 4 to 12 s along its wall: all of it, its foot, its top, m/s."""
    simulation, found = start(load(f"{CASES}/tension/sliding_drop.toml", keys)), []
    store = simulation.store
    while simulation.time < 12.0:
        simulation.step()
        if simulation.time > 4.0:
            own = store.group[store.inner] == 0
            x, v = (np.array(store[name])[:, store.inner][:, own] for name in ("position", "velocity"))
            found.append([v[0, part].mean() for part in (x[1] > 0.0, x[1] < 0.2, x[1] > 0.7)])
    return np.mean(found, axis=0)


def test_a_drop_runs_down_a_wall_by_its_weight_over_its_viscosity():
    """No drop sticks, and on a wall that holds the fluid it rolls; the control: on a level wall it rests."""
    mean, foot, top = running()
    assert 0.03 < mean < 0.08 and top > 1.5 * foot > 0.0
    assert running("physics.gravity=[0.2,-0.1]")[0] == pytest.approx(2.0 * mean, rel=0.2)
    assert running("fluids.water.viscosity=0.4")[0] == pytest.approx(0.5 * mean, rel=0.2)
    assert abs(running("physics.gravity=[0.0,-0.1]")[0]) < 0.05 * mean


def creeping(*keys, after=10.0):
    """Of the drop of the case that sticks: how far it comes in 8 s after that time, and before, in the means of
    4 s, m."""
    simulation = start(load(f"{CASES}/tension/sticking_drop.toml", keys))
    store, means = simulation.store, []
    for begin in (after, after + 8.0):
        found = []
        while simulation.time < begin + 4.0:
            simulation.step()
            if simulation.time > begin:
                x = np.array(store["position"])[0, store.inner]
                found.append(x[store.group[store.inner] == 0].mean())
        means.append(np.mean(found))
    return means[1] - means[0], means[0]


def test_a_drop_sticks_to_a_tilted_wall_below_the_limit_of_its_angles():
    """σ (cos 70° − cos 110°) = 0.68 N/m: its weight is 0.48, and of the control, which slides, 0.80."""
    further, leans = creeping()
    assert abs(further) < 0.04 and 0.1 < leans < 0.3
    assert creeping("physics.gravity=[0.5,-0.1]", after=4.0)[0] > 0.4


def test_a_drop_that_is_thrown_sticks_where_it_comes_to_rest():
    further, leans = creeping("physics.gravity=[0.2,-0.1]", "fluids.water.velocity=[1.0,0.0]")
    assert abs(further) < 0.04 and leans > 0.1


def test_with_one_angle_the_same_drop_slides():
    """The control: 0.1 m/s and more."""
    assert creeping("walls.floor.contact_angle=90.0", after=1.0)[0] > 0.8


@LONG
def test_a_jet_breaks_into_drops_of_the_flow_of_a_period():
    """Beyond 12 R each piece between two gaps is 9π R³ of water."""
    simulation = start(load(f"{CASES}/tension/jet.toml"))
    while simulation.time < 14.0:
        simulation.step()
    store = simulation.store
    x, mass = np.array(store["position"])[0, store.inner], store.shown("mass")
    water = store.group[store.inner] == 0
    order = np.sort(x[water & (x > 12.0)])
    ends = np.flatnonzero(np.diff(order) > 0.5)
    pieces = np.diff(ends) * mass[water].max()
    drops = pieces[pieces > 1.0]  # what is left of threads is less
    assert len(drops) >= 2 and drops == pytest.approx(9.0 * math.pi, rel=0.1)


BRIDGE = ("space.spacing=0.25", "space.lower=[-0.5,-3.0,-3.0]")
LOW = "{{cylinder={{center=[{},0.0,0.0],radius=2.25,height=0.5,axis='x'}}}}"


def leaning(length):
    """Of a bridge of four spacings a radius between plates: how far its middle is off theirs at 2 and 5 s, m."""
    plates = f"[{LOW.format(-0.25)},{LOW.format(length + 0.25)}]"
    case = load(
        f"{CASES}/tension/liquid_bridge.toml",
        (
            *BRIDGE,
            f"space.upper=[{2.0 * length - 0.5},3.0,3.0]",
            f"fluids.water.shape.cylinder={{center=[{length / 2.0},0.0,0.0],radius=1.0,height={length},axis='x'}}",
            f"exact.liquid_thread.length={2.0 * length}",
            f"walls.plates.shape.union={plates}",
        ),
    )
    simulation, found = start(case), []
    store = simulation.store
    for time in (2.0, 5.0):
        while simulation.time < time:
            simulation.step()
        own = store.group[store.inner] == 0
        found.append(0.5 * length - np.array(store["position"])[0, store.inner][own].mean())
    return found


def test_a_long_bridge_breaks_and_a_short_one_does_not():
    """Vogel's limit of lines that slide, a length of πR: 4.5 R leans on, 2.5 R comes back."""
    before, after = leaning(4.5)
    assert 0.0 < 2.0 * before < after
    before, after = leaning(2.5)
    assert abs(after) < max(before, 0.06)


SHORT = (
    "space={dimensions=3,spacing=0.2013833,periodic=['x'],lower=[0.0,-2.5,-2.5],upper=[4.8332,2.5,2.5]}",
    "fluids.water.shape.cylinder={center=[2.4166,0.0,0.0],radius=1.0,height=4.8332,axis='x'}",
    "exact.liquid_thread.length=4.8332",
)
"""kR = 1.3."""


def swelling(*keys):
    """Of a thread of five spacings a radius: how fast its wave moves at 2.8 and 5.6 s, over its start."""
    case = load(f"{CASES}/tension/liquid_thread.toml", ("space.spacing=0.199472", *keys))
    scene, simulation, found = Scene(case), start(case), []
    store = simulation.store
    for time in (0.0, 2.8, 5.6):
        while simulation.time < time:
            simulation.step()
        x, v = (np.array(store[name])[:, store.inner].T for name in ("position", "velocity"))
        form = scene.layout.exact.velocity(x, 0.0, scene.starts.setting)
        found.append((v * form).sum() / (form**2).sum())
    return np.array(found[1:]) / found[0]


def test_a_long_wave_breaks_a_thread_and_a_short_one_does_not():
    """Plateau's and Rayleigh's limit, kR = 1: 0.7 grows, if slower than by theory, 1.3 swings back."""
    before, after = swelling()
    assert 1.3 * before < after
    before, after = swelling(*SHORT)
    assert before < 0.0 and abs(after) < 0.3
