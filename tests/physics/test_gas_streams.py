"""Gas that comes in through a side of the domain and leaves through another."""

import numpy as np
import pytest
from cases.measures import CASES
from gauging import start
from mpi4py import MPI

from psph.case import CaseError, load
from psph.moments import length_at_a_face
from psph.runs.setup import compile_ahead
from psph.scene import Scene, check
from psph.scene.checks import warnings
from psph.simulation.plan import make_plan
from psph.smoothing import kernel
from psph.theory.riemann import GasState, riemann

WIND = """
scheme = "gas"

[space]
dimensions = 1
spacing = 0.02
lower = [0.0]
upper = [2.0]

[time]
end = 20.0

[ideal_gases.wind]
shape.box = { lower = [0.0], upper = [2.0] }
density = 1.3
pressure = 0.8
velocity = [3.0]
inflow = "x.lower"
outflow = "x.upper"
"""

TUNNEL = WIND.replace("dimensions = 1", 'dimensions = 2\nperiodic = ["y"]')
for old, new in (("[0.0]", "[0.0, 0.0]"), ("[2.0]", "[2.0, 0.8]"), ("[3.0]", "[3.0, 0.0]")):
    TUNNEL = TUNNEL.replace(old, new)
TUNNEL = TUNNEL.replace("spacing = 0.02", "spacing = 0.04")


def wind(tmp_path, text, *sets):
    (tmp_path / "wind.toml").write_text(text)
    return start(load(tmp_path / "wind.toml", sets))


def state(simulation):
    """x, density, velocity and pressure of all, by place."""
    simulation.settle_pressure()
    store = simulation.store
    x, rho, v, p = (store.shown(name) for name in ("position", "density", "velocity", "pressure"))
    order = np.argsort(x[:, 0])
    return tuple(np.array(one)[order] for one in (x[:, 0], rho, v[:, 0], p))


def inner(x, *values, deep=0.35):
    """Values off both sides."""
    within = (x > deep) & (x < 2.0 - deep)
    return [one[within] for one in values]


@pytest.mark.parametrize(("text", "flows"), [(WIND, 20), (TUNNEL, 3)], ids=["1D", "2D"])
def test_a_uniform_stream_stays_uniform(tmp_path, text, flows):
    """To rounding, while so many domains of it flow through; as many particles as at the start are there."""
    simulation = wind(tmp_path, text)
    x, *begun = state(simulation)
    [rho, v, p] = (one.mean() for one in inner(x, *begun))
    count, end = len(x), flows * 2.0 / 3.0
    while simulation.time < end:
        simulation.step(end)
        assert abs(simulation.store.owned - count) <= 0.1 * count
    x, *found = state(simulation)
    for values, first in zip(inner(x, *found), (rho, v, p)):
        assert np.abs(values / first - 1.0).max() < 1e-8
    gases = simulation.engine.of("ideal_gases")
    came, went = gases.streams.came, gases.streams.went
    assert (
        came[0] == pytest.approx(flows * count, rel=0.02)
        and came[0] - went[1] == simulation.store.owned - count
    )
    assert len(set(simulation.store.shown("id").tolist())) == simulation.store.owned


def test_a_stream_that_is_not_held_or_followed_does_not(tmp_path, monkeypatch):
    """Without rows that follow it is gone, without what is held its end bursts into the vacuum."""
    monkeypatch.setattr("psph.simulation.gas_streams.HELD", ())
    simulation = wind(tmp_path, WIND)
    while simulation.time < 1.0:
        simulation.step(1.0)
    x, rho, v, p = state(simulation)
    assert np.abs(inner(x, rho)[0] / 1.3 - 1.0).max() > 0.1


SHOCK = WIND.replace(
    "shape.box = { lower = [0.0], upper = [2.0] }", "shape.box = { lower = [0.0], upper = [1.0] }"
)
SHOCK = SHOCK.replace('outflow = "x.upper"\n', "").replace("pressure = 0.8", "pressure = 3.0")
SHOCK += """outflow = "x.upper"

[ideal_gases.thin]
shape.box = { lower = [1.0], upper = [2.0] }
density = 1.3
pressure = 0.8
velocity = [SPEED]
outflow = "x.upper"
"""


def left_behind(tmp_path, speed, pressure):
    """By how much the pressure is off that of what comes in, over the rise of a shock, at the most, 4 s after
    gas of this pressure stood behind gas of 0.8 Pa: shock, contact and fan have met the outflow."""
    of_wind = f"ideal_gases.wind.velocity=[{speed}]", f"ideal_gases.wind.pressure={pressure}"
    simulation = wind(tmp_path, SHOCK.replace("SPEED", f"{speed}"), *of_wind)
    while simulation.time < 4.0:
        simulation.step(4.0)
    x, _, _, p = state(simulation)
    return np.abs(inner(x, p)[0] - pressure).max() / (pressure - 0.8)


def test_a_shock_leaves_with_a_stream_faster_than_sound(tmp_path):
    """All that is left is the stream that comes in; what leaves slower than sound comes back."""
    assert left_behind(tmp_path, 3.5, 3.0) < 1e-3
    assert left_behind(tmp_path, 0.4, 0.9) > 0.3


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        (("ideal_gases.wind.velocity=[-1.0]",), "straight in through that side"),
        (('ideal_gases.wind.density="1 + x"',), "give numbers in place of formulas"),
        (("ideal_gases.wind.jitter=0.1",), "layer by layer"),
        (('ideal_gases.wind.inflow="y.lower"',), "there is no such side in 1D"),
        (('ideal_gases.wind.outflow="z.upper"',), "there is no such side in 1D"),
        (('ideal_gases.wind.outflow="x.lower"',), "is where it comes in; give another side"),
        (("ideal_gases.wind.shape.box.lower=[0.1]",), "does not begin there"),
        (("ideal_gases.wind.shape.box.upper=[0.1]",), "make it deeper"),
        (('space.periodic=["x"]',), "repeats or is a mirror"),
    ],
)
def test_what_cannot_come_in_is_told_in_a_line(tmp_path, sets, says):
    (tmp_path / "wind.toml").write_text(WIND)
    with pytest.raises(CaseError, match=says):
        check(Scene(load(tmp_path / "wind.toml", sets)))


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        ((), []),
        (
            ("ideal_gases.wind.velocity=[0.5]",),
            ["inflow: x.lower: its speed there is 0.5 m/s", "outflow: x.upper: its speed there is 0.5 m/s"],
        ),
        (
            ('ideal_gases.wind.inflow="x.upper"', 'ideal_gases.wind.outflow="x.lower"')
            + ("ideal_gases.wind.velocity=[-3.0]",),
            [],
        ),
    ],
)
def test_a_stream_slower_than_sound_is_warned_of(tmp_path, sets, says):
    """Sound goes at 0.928 m/s."""
    (tmp_path / "wind.toml").write_text(WIND)
    found = [*warnings(Scene(load(tmp_path / "wind.toml", sets)))]
    assert len(found) == len(says)
    assert all(part in line and "that of sound 0.92" in line for line, part in zip(found, says))


def test_a_gas_at_rest_that_a_wind_carries_out_is_not_warned_of():
    assert not [*warnings(Scene(load(f"{CASES}/gas/cloud_in_wind.toml")))]


NARROW = "space.spacing=0.05", "space.upper=[2.0, 0.6]", "ideal_gases.wind.shape.box.upper=[2.0, 0.6]"
OPEN = "space.periodic=[]", "ideal_gases.wind.velocity=[3.0, 0.0]"
MIRRORS = 'space.symmetry=["y.lower", "y.upper"]'
TIGHT = "space.spacing=0.05", "space.upper=[2.0, 0.2]", "ideal_gases.wind.shape.box.upper=[2.0, 0.2]"


def test_the_longer_smoothing_lengths_at_an_open_face_are_known_before_a_run(tmp_path):
    """As the first that a run finds."""
    simulation = wind(tmp_path, TUNNEL)
    face = 0.04 * length_at_a_face(kernel("wendland-c2", 1.0, 2), 1.4, 2)
    assert simulation.store.shown("smoothing_length").max() == pytest.approx(face, rel=1e-6)


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        (NARROW, "space.upper: the domain is 0.6 m long along the periodic axis y; at open faces"),
        ((*TIGHT, *OPEN, MIRRORS), "space: mirrors at y = 0 and 0.2 m; at open faces of gases"),
    ],
)
def test_a_domain_too_short_for_what_is_at_an_open_face_is_refused(tmp_path, sets, says):
    """The bulk fits into it: where nothing comes or goes, and x repeats too, it is good."""
    (tmp_path / "wind.toml").write_text(TUNNEL)
    with pytest.raises(CaseError, match=says):
        check(Scene(load(tmp_path / "wind.toml", sets)))
    (tmp_path / "wind.toml").write_text(TUNNEL.replace("inflow", "# ").replace("outflow", "# "))
    closed = [one for one in sets if "periodic" not in one]
    periods = '["x"]' if MIRRORS in sets else '["x", "y"]'
    check(Scene(load(tmp_path / "wind.toml", (*closed, f"space.periodic={periods}"))))


def test_a_gas_that_leaves_unheld_beside_one_that_is_held_is_warned_of(tmp_path):
    (tmp_path / "wind.toml").write_text(SHOCK.replace("SPEED", "3.5"))
    assert not [*warnings(Scene(load(tmp_path / "wind.toml")))]
    head, _, tail = SHOCK.replace("SPEED", "3.5").rpartition('outflow = "x.upper"\n')
    (tmp_path / "wind.toml").write_text(head + tail)
    [line] = warnings(Scene(load(tmp_path / "wind.toml")))
    assert "ideal_gases.thin.outflow: ideal_gases.wind leaves through x.upper, this gas does not" in line


COARSE = "space.spacing=0.025", "ideal_gases.cloud.spacing=0.008333333333333333"


def test_a_wind_meets_a_cloud_at_the_pressure_that_theory_has(tmp_path):
    """While its face is as good as flat; neither shocks nor shreds lose momentum across."""
    case = load(f"{CASES}/gas/cloud_in_wind.toml", COARSE)
    simulation, wind, cloud = start(case), case.ideal_gases["wind"], case.ideal_gases["cloud"]
    left = GasState(wind.density, wind.pressure, wind.velocity[0])
    found = riemann(left, GasState(cloud.density, cloud.pressure), wind.gamma)
    while simulation.time < 0.024:
        simulation.step(0.024)
    simulation.settle_pressure()
    store = simulation.store
    x, v, p, mass = (store.shown(name) for name in ("position", "velocity", "pressure", "mass"))
    assert p[np.abs(x[:, 1]) < 0.03].max() == pytest.approx(found.pressure, rel=0.05)
    assert np.abs(mass @ v[:, 1]) < 1e-12 * (mass @ np.abs(v[:, 0]))


def test_a_gas_that_is_held_at_a_side_keeps_what_it_has_where_none_stands_behind_it(tmp_path):
    """As those few do by which loops are compiled: they have a step then."""
    scene = Scene(load(f"{CASES}/gas/cloud_in_wind.toml", COARSE))
    assert compile_ahead(scene, make_plan(scene), MPI.COMM_SELF) > 0.0
