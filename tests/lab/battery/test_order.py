"""What the battery measures, on particles put by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from drafts import SQUARE, TANK, draft

from psph.case import load
from psph.lab.battery import measures
from psph.lab.battery.command import CASES
from psph.lab.battery.measures import ghia
from psph.lab.battery.order import checkerboard, nearest, pieces, voids
from psph.lab.battery.walls import lost
from psph.lab.study.experiment import path_of, read_experiment
from psph.output.errors import OutputError
from psph.scene import Scene

FREE = SQUARE.replace("[1.0, 1.0]", "[2.0, 1.0]")
PERIODIC = FREE.replace(
    "spacing = 0.1", 'spacing = 0.1\nperiodic = ["x", "y"]\nlower = [0.0, 0.0]\nupper = [2.0, 1.0]'
)


def sites(nx=20, ny=10, dx=0.1):
    """A block of the square lattice, (n, 2)."""
    x, y = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    return (np.stack([x.ravel(), y.ravel()], axis=1) + 0.5) * dx


@pytest.fixture
def free(tmp_path):
    return Scene(draft(tmp_path, FREE))


def test_distances_pieces_and_voids(free):
    x = sites()
    assert nearest(free, x) == pytest.approx(0.1)
    assert pieces(free, x) == 1 and voids(free, x, x) == 0.0
    cut = x[(x[:, 0] < 0.9) | (x[:, 0] > 1.1)]  # a gap of two columns
    assert pieces(free, cut) == 2 and voids(free, cut, cut) == 0.0
    hole = x[np.hypot(*(x - [1.0, 0.5]).T) > 0.25]
    assert pieces(free, hole) == 1
    open_area = math.pi * 0.2**2 / len(hole) / 0.01  # particles no nearer than a spacing
    assert 0.1 * open_area < voids(free, hole, hole) < open_area
    near = x.copy()
    near[0] = near[1] + 0.01
    assert nearest(free, near).min() == pytest.approx(0.01 * math.sqrt(2.0))


def test_periods_count(tmp_path):
    scene = Scene(draft(tmp_path, PERIODIC))
    x = sites()
    apart = x[(np.abs(x[:, 0] - 1.0) > 0.35)]  # connected across the edge alone
    assert pieces(scene, apart) == 1
    assert voids(scene, x, x) == 0.0 and voids(scene, apart, apart) > 0.1
    assert nearest(scene, np.array([[0.01, 0.5], [1.99, 0.5]])) == pytest.approx(0.02)


def test_noise_is_what_differs_from_the_surroundings(free):
    x = sites()
    frame = {"position": x, "pressure": 1000.0 * x[:, 1]}
    assert checkerboard(free, frame, frame) < 1e-9  # a slope is no noise
    lines = frame | {"pressure": np.where(np.round(x[:, 0] / 0.1 - 0.5) % 2, 1.0, -1.0)}
    assert checkerboard(free, lines, lines) == pytest.approx(1.5, rel=0.05)


def test_lost_particles(tmp_path):
    scene = Scene(draft(tmp_path, TANK))
    inside = np.array([[0.5, 0.2], [0.03, 0.2], [0.5, 5.0], [-0.02, 0.2]])
    assert lost(scene, inside) == 0  # splashes above, and a wall's face is soft
    gone = np.array([[-0.12, 0.2], [0.5, -0.15], [0.5, -3.0], [9.0, 0.2], [math.nan, 0.2]])
    assert lost(scene, gone) == len(gone)


def test_growth():
    time = np.linspace(0.0, 1.0, 200)
    risen = np.minimum(1e-9 * np.exp(40.0 * time), 1.0)
    assert measures._growth(time, risen) == pytest.approx(40.0, rel=0.01)
    assert measures._growth(time, 1e-3 * np.exp(-3.0 * time)) == 0.0
    assert measures._growth(time, 1.0 + 0.5 * np.sin(20.0 * time)) == 0.0
    assert measures._growth(time, 0.0 * time) == 0.0


def test_growth_is_that_of_what_is_small():
    """A kick spreads first; what is torn in the end grows no longer as it did."""
    time = np.linspace(0.0, 1.0, 400)
    kick, wave = 1e-7 * np.exp(-60.0 * time), 1e-9 * np.exp(40.0 * time)
    torn = np.minimum(kick + wave, 1e-3) + 10.0 * np.maximum(time - 0.4, 0.0) ** 3
    assert measures._growth(time, torn) == pytest.approx(40.0, rel=0.02)
    assert measures._growth(time, np.where(time > 0.0, 1e-2, 1e-7)) == math.inf  # pushed
    assert measures._growth(time, np.where(time > 0.0, 1e-2, 0.0)) == 0.0  # at rest before


def test_ghia(tmp_path):
    from psph.lab.battery.command import CASES

    place, u = ghia(CASES.parent / "experiments/ghia_1982_u.csv")
    assert len(place) == 15 and u[place == 0.5] == pytest.approx(-0.0608)
    with pytest.raises(OutputError, match="belongs beside the case"):
        ghia(tmp_path / "none.csv")


def test_a_cavity_is_read_on_its_centre_lines():
    case = load(CASES / "cavity.toml")
    x = (np.indices((50, 50)).reshape(2, -1).T + 0.5) * 0.02
    places, u = ghia(CASES.parent / "experiments/ghia_1982_u.csv")
    along, v = ghia(CASES.parent / "experiments/ghia_1982_v.csv")
    curves = [(x[:, 1], places, u), (x[:, 0], along, v)]
    flow = np.stack([np.interp(at, np.sort(p), w[np.argsort(p)]) for at, p, w in curves], axis=1)
    for scale, expected in ((1.0, 0.0), (0.0, math.sqrt((u @ u + v @ v) / (len(u) + len(v))))):
        frame = {"position": x, "velocity": scale * flow}
        [(name, error)] = measures._of_cavity(None, case, [frame])
        assert name == "ghia_error" and error == pytest.approx(expected, abs=0.02)


def test_swing_of_a_drop_after_four_periods():
    case = load(CASES / "drop.toml")
    time = np.linspace(0.0, 25.0, 5000)
    motion = 3.0 * np.exp(-0.02 * time) * np.cos(2.0 * math.pi * time / measures.PERIOD) ** 2
    run = SimpleNamespace(log=lambda: {"time": time, "kinetic_energy": motion})
    [(name, swing)] = measures._of_drop(run, case, None)
    expected = math.exp(-0.01 * measures.PERIODS * measures.PERIOD)
    assert name == "swing" and swing == pytest.approx(expected, rel=1e-3) and swing < 0.9
    early = SimpleNamespace(log=lambda: {"time": time[:3000], "kinetic_energy": motion[:3000]})
    assert not list(measures._of_drop(early, case, None))
    assert not list(measures._of_drop(run, load(CASES / "patch.toml"), None))


def test_energy_left_is_told_over_that_of_the_exact_solution():
    scene = Scene(load(CASES / "taylor_green.toml"))
    x = (np.indices((50, 50)).reshape(2, -1).T + 0.5) * 0.02
    times = np.array([0.0, 0.5, 1.0])
    exact = [
        {"position": x, "velocity": scene.layout.exact.velocity(x, t, scene.starts.setting)} for t in times
    ]
    energy = [float((f["velocity"] ** 2).sum()) for f in exact]
    assert energy[2] / energy[0] == pytest.approx(0.854, abs=1e-3)  # exp(-16 π² ν)
    worn = [exact[0], exact[1], exact[2] | {"velocity": 0.8 * exact[2]["velocity"]}]
    run = SimpleNamespace(times=times)
    assert dict(measures._of_energy(run, scene, exact)) == {"energy_left": pytest.approx(1.0)}
    assert dict(measures._of_energy(run, scene, worn)) == {"energy_left": pytest.approx(0.64)}
    assert not dict(measures._of_energy(run, Scene(load(CASES / "patch.toml")), exact))


def test_a_front_that_is_early_is_told_from_one_that_is_fast():
    case = load(CASES / "dam_break.toml")
    time, place = read_experiment(case, "martin_moyce", path_of(case).parent)
    moments = np.linspace(0.0, case.study.until, 200)

    def found(places):
        run = SimpleNamespace(probes=lambda: {"time": moments, "tip.front": places})
        return dict(measures._of_front(run, case, None))

    early = found(np.interp(moments + 0.05, time, place))
    assert early["front_error"] > 0.1 > 0.01 > early["front_begun_later"]
    fast = found(1.2 * np.interp(moments, time, place))
    assert fast["front_error"] == pytest.approx(0.2, rel=0.02) and fast["front_begun_later"] > 0.02
