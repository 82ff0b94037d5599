"""Waves from paddles, two wavelengths and ten depths away, against the theory that moves the paddle."""

import math
from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES, by_id, finished, window
from drafts import TANK, draft
from long import LONG
from mpi4py import MPI

from psph.case import load
from psph.case.paddles import Irregular
from psph.output.reader import Run
from psph.physics.rigid.schedule import ActingTime
from psph.runs.start import run
from psph.theory.water_waves import bound_crest, piston_gain, second_harmonic, wave_number

DEPTH = 0.3


def sloshed(folder, *overrides):
    """The last frame of water that runs to and fro in a tank 1 m long."""
    folder.mkdir()
    case = draft(folder, TANK, "time.end=0.3", "fluids.water.velocity=[0.2, 0.0]", *overrides)
    run(case, folder / "run", MPI.COMM_SELF, say=lambda *_: None)
    return by_id(Run(folder / "run").frame(-1))


def test_damping_zones_calm_what_is_in_them_alone(tmp_path):
    free = sloshed(tmp_path / "free")
    beside = sloshed(tmp_path / "beside", "physics.damping_zone={ begin = 1.5, end = 2.5 }")
    assert all(np.array_equal(free[name], beside[name]) for name in free)  # no water is there
    within = sloshed(tmp_path / "within", "physics.damping_zone={ begin = -0.5, end = 1.2 }")
    energy, left = ((one["velocity"] ** 2).sum() for one in (free, within))
    assert left < 0.5 * energy
    other = sloshed(tmp_path / "other", "physics.other_damping_zone={ begin = -0.5, end = 1.2 }")
    assert all(np.array_equal(within[name], other[name]) for name in within)
    ends = (
        "physics.damping_zone={ begin = -0.5, end = 1.2 }",
        "physics.other_damping_zone={ begin = 1.5, end = -0.2 }",
    )
    both = sloshed(tmp_path / "both", *ends)
    assert (both["velocity"] ** 2).sum() < 0.5 * left


@LONG
def test_a_piston_makes_waves_of_the_height_that_was_asked_for(tmp_path):
    found = finished("piston_wave", tmp_path / "run")
    far = found.gauges()["far"]  # two wavelengths from the paddle
    periods = [window(far, "far.level", begin, begin + 1.2) for begin in (8.4, 9.6, 10.8)]
    assert np.mean([np.ptp(levels) for levels in periods]) == pytest.approx(0.08, rel=0.05)


@LONG
def test_a_solitary_wave_keeps_its_height_and_speed(tmp_path):
    """Measured: 0.0595 and 0.0598 m, and 1.857 m/s, which is 1.1 % slow: the crest passes a gauge at a time that is
    known to 5 ms, 0.3 % of its way, and with another sound or spacing it takes as long.  Without ``summation_density`` it is 0.6 % slow, and 2 % lower."""
    found = finished("solitary_wave", tmp_path / "run")
    (begin, low), (end, high) = (crest(found, name) for name in ("first", "second"))
    speed = 3.0 / (end - begin)
    assert (low, high) == pytest.approx((0.06, 0.06), rel=0.05)
    assert speed == pytest.approx(EXACT_SPEED, rel=0.015)
    if speed != pytest.approx(1.879, rel=0.01):
        pytest.xfail("more than 1 % slow")


EXACT_SPEED = 1.0943 * math.sqrt(9.81 * DEPTH)
"""m/s, of the exact solitary wave of a fifth of the depth."""


HIGH = (
    "space.spacing=0.015",
    "time.end=3.4",
    "physics.sound_speed=18.0",
    "physics.position_shift=off",
    "gauges.first.level.top=[0.8, 0.44]",
    "gauges.second.level.top=[3.8, 0.44]",
    "walls.paddle.motion.solitary.height=0.12",
    'walls.paddle.motion.solitary.theory="grimshaw"',
)
"""A wave of 0.4 of the depth, 8 spacings."""


@LONG
def test_a_high_solitary_wave_keeps_its_height_and_speed(tmp_path):
    """Against the exact wave of 0.4 of the depth, F = 1.178 (tests/physics/rigid/test_solitary.py)."""
    run(load(Path(CASES) / "solitary_wave.toml", HIGH), tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    (begin, low), (end, high) = (crest(Run(tmp_path / "run"), name) for name in ("first", "second"))
    assert 3.0 / (end - begin) == pytest.approx(1.178 * math.sqrt(9.81 * DEPTH), rel=0.015)
    assert high == pytest.approx(low, rel=0.03)
    assert (low, high) == pytest.approx((0.12, 0.12), rel=0.07)


@LONG
def test_a_paddle_that_absorbs_keeps_waves_before_a_wall_from_growing(tmp_path):
    """Twice the height of the waves that come, 0.12 m: measured 0.115 m; 0.26 m without."""
    text = (Path(CASES) / "absorbing_paddle.toml").read_text(encoding="utf-8")
    (tmp_path / "plain.toml").write_text(text.replace(", absorb = {}", ""), encoding="utf-8")
    found = []
    for name in (Path(CASES) / "absorbing_paddle.toml", tmp_path / "plain.toml"):
        run(load(name), tmp_path / name.stem, MPI.COMM_SELF, say=lambda *_: None)
        table = Run(tmp_path / name.stem).gauges()["wall"]
        periods = [window(table, "wall.wetted", begin, begin + 1.2) for begin in (9.6, 10.8, 12.0, 13.2)]
        found.append(np.mean([np.ptp(levels) for levels in periods]))
    assert found[0] == pytest.approx(0.12, rel=0.08)
    assert found[1] > 2.0 * found[0]


FLUME = """
space = { dimensions = 2, spacing = 0.015 }
time.end = 9.6
physics.gravity = [0.0, -9.81]
physics.position_shift = "off"
physics.damping_zone = { begin = 3.0, end = 5.4 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [5.4, 0.3] }
pressure = "hydrostatic"
[walls.flume]
shape.union = [
  { box = { lower = [-0.15, -0.045], upper = [5.445, 0.0] } },
  { box = { lower = [5.4, 0.0], upper = [5.445, 0.45] } },
]
[walls.paddle]
shape.box = { lower = [-0.045, 0.0], upper = [0.0, 0.45] }
motion = { piston = { height = 0.06, period = 1.6, depth = 0.3, order = ORDER }, ramp = 1.6 }
[output]
frames = 9.6
probes = 0.02
"""
"""Waves of kh = 0.75 and HL²/h³ = 14, 4 spacings high."""
PLACES = [0.8 + 0.2 * n for n in range(11)]


def second_harmonics(folder, order):
    """Amplitudes, m, of the waves of half the period: that which goes with the crests, and the free one.

    c₂(x) = B exp(−2ikx) + F exp(−ik₂x), (2ω)² = gk₂ tanh k₂h, through the second harmonic c₂ at the gauges.
    """
    folder.mkdir()
    gauges = (f"gauges.g{n}.level={{ foot = [{x}, 0.0], top = [{x}, 0.42] }}" for n, x in enumerate(PLACES))
    run(
        draft(folder, FLUME.replace("ORDER", str(order)), *gauges),
        folder / "run",
        MPI.COMM_SELF,
        say=lambda *_: None,
    )
    tables, omega = Run(folder / "run").gauges(), 2.0 * math.pi / 1.6
    found = []
    for n in range(len(PLACES)):
        time = window(tables[f"g{n}"], "time", 6.4, 9.6)
        turns = [f(m * omega * time) for m in (1, 2, 3) for f in (np.cos, np.sin)]
        level = window(tables[f"g{n}"], f"g{n}.level", 6.4, 9.6)
        fit = np.linalg.lstsq(np.stack([np.ones_like(time), *turns], axis=1), level, rcond=None)[0]
        found.append(fit[3] - 1j * fit[4])
    numbers = (2.0 * wave_number(omega, DEPTH, 9.81), wave_number(2.0 * omega, DEPTH, 9.81))
    waves = np.stack([np.exp(-1j * k * np.array(PLACES)) for k in numbers], axis=1)
    return np.abs(np.linalg.lstsq(waves, np.array(found), rcond=None)[0])


@LONG
@pytest.mark.timeout(1800)
def test_to_second_order_a_piston_makes_no_free_wave_of_half_the_period(tmp_path):
    """Measured: 2.85 mm by a sinusoid, where Madsen's theory has 2.75, and 0.81 mm to second order; the bound wave
    is 5.74 and 5.73 mm, where Stokes' has 5.75."""
    omega = 2.0 * math.pi / 1.6
    kh, own = (DEPTH * wave_number(w, DEPTH, 9.81) for w in (omega, 2.0 * omega))
    bound, told = bound_crest(0.06, kh, DEPTH), second_harmonic(0.06, kh, DEPTH) * piston_gain(own)
    (with_first, free), (with_second, rest) = (second_harmonics(tmp_path / str(n), n) for n in (1, 2))
    assert (with_first, with_second) == pytest.approx((bound, bound), rel=0.1)
    assert free == pytest.approx(told, rel=0.15)  # the control: what a sinusoid makes is there
    assert rest < 0.4 * free


SEA = """
space = { dimensions = 2, spacing = 0.015 }
time.end = 24.0
physics.gravity = [0.0, -9.81]
physics.damping_zone = { begin = 2.4, end = 4.5 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [4.5, 0.3] }
pressure = "hydrostatic"
[walls.flume]
shape.union = [
  { box = { lower = [-0.3, -0.045], upper = [4.545, 0.0] } },
  { box = { lower = [4.5, 0.0], upper = [4.545, 0.48] } },
]
[walls.paddle]
shape.box = { lower = [-0.045, 0.0], upper = [0.0, 0.48] }
motion = { irregular = { height = 0.06, period = 1.4, depth = 0.3, seed = 7 }, ramp = 1.4 }
[gauges.near.level]
foot = [0.75, 0.0]
top = [0.75, 0.46]
[output]
frames = 24.0
probes = 0.02
"""
"""Waves of a spectrum, 4 spacings high."""


def beside_its_theory(found, seed):
    """Heights 4σ, m, of the level at the gauge of SEA from 6 to 24 s and of the sum of the waves of a ``seed``
    there, and how the two correlate."""
    table = found.gauges()["near"]
    time, level = (window(table, name, 6.0, 24.0) for name in ("time", "near.level"))
    crests = Irregular(height=0.06, period=1.4, depth=DEPTH, seed=seed).crests(9.81)
    told = [crests.elevation(ActingTime(0.0, math.inf, 1.4), t, 0.75) for t in time]
    return 4.0 * level.std(), 4.0 * np.std(told), np.corrcoef(level, told)[0, 1]


@LONG
@pytest.mark.timeout(1800)
def test_a_spectrum_makes_the_waves_of_its_seed(tmp_path):
    """Measured: 0.0579 m, where the sum of its waves has 0.0602 m in this time, and 0.978; of another seed 0.16."""
    run(draft(tmp_path, SEA), tmp_path / "run", MPI.COMM_SELF, say=lambda *_: None)
    height, told, alike = beside_its_theory(Run(tmp_path / "run"), 7)
    assert height == pytest.approx(told, rel=0.1) and alike > 0.95
    assert abs(beside_its_theory(Run(tmp_path / "run"), 8)[2]) < 0.6  # the control: other waves


def crest(found, name):
    """When the crest passes a gauge, and how high it is, by a parabola through its top."""
    table = found.gauges()[name]
    time, level = table["time"], table[f"{name}.level"] - DEPTH
    early = time < (3.2 if name == "first" else 4.6)  # before the wall sends it back
    top = int(np.argmax(level[early]))
    near = slice(top - 15, top + 16)
    a, b, c = np.polyfit(time[near] - time[top], level[near], 2)
    return time[top] - b / (2.0 * a), c - b * b / (4.0 * a)
