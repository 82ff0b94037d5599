"""Drops under surface tension: their pressure, their currents and momentum, in 2D and 3D, alone and in others."""

import math

import numpy as np
import pytest
from cases.measures import CASES
from drafts import draft
from gauging import start

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
