"""Pistons: mirrors that move, and press ideal gas or let it expand."""

import numpy as np
import pytest
import tomli_w
from drafts import draft, refusal
from gauging import start
from physics.test_gas import of

from psph.case import CaseError
from psph.output.probes import FieldProbe
from psph.particles.sizes import TooLarge
from psph.scene import Scene

GAMMA, SPEED = 1.4, np.sqrt(1.4)
"""Of a gas of 1 kg/m³ and 1 Pa, in which sound has this speed, m/s."""

TUBE = """
scheme = "gas"
space = { dimensions = 1, spacing = 0.005 }
time.end = 10.0
[ideal_gases.gas]
shape.box = { lower = [0.0], upper = [1.5] }
density = 1.0
pressure = 1.0
[walls.end]
shape.box = { lower = [1.5], upper = [1.6] }
condition = "mirror"
[walls.piston]
shape.box = { lower = [-0.1], upper = [0.0] }
condition = "mirror"
motion = { translation = { velocity = [1.0] } }
"""

CHANNEL = """
scheme = "gas"
space = { dimensions = 2, spacing = 0.02, lower = [0.0, 0.0], upper = [0.3, 1.2] }
time.end = 10.0
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [0.3, 1.2] }
density = 1.0
pressure = 1.0
[walls.sides]
shape.difference.from.box = { lower = [-0.1, 0.0], upper = [0.4, 1.2] }
shape.difference.minus = [{ box = { lower = [0.0, -1.0], upper = [0.3, 2.0] } }]
condition = "mirror"
[walls.bottom]
shape.box = { lower = [-0.1, -0.1], upper = [0.4, 0.0] }
condition = "mirror"
[walls.piston]
shape.box = { lower = [-0.1, 1.2], upper = [0.4, 1.3] }
condition = "mirror"
motion = { translation = { velocity = [0.0, -1.0] } }
"""


def pressed(folder, end, text=TUBE, *sets):
    """Place along the tube, velocity along it, density and pressure, in order, and the simulation, at the ``end``, s."""
    simulation, axis = start(draft(folder, text, *sets)), 0 if text is TUBE else 1
    while simulation.time < end:
        simulation.step(end)
    simulation.settle_pressure()
    x, v, *rest = of(simulation, "position", "velocity", "density", "pressure")
    order = np.argsort(x[:, axis])
    return *(one[order] for one in (x[:, axis], v[:, axis], *rest)), simulation


def energy(simulation):
    """Σ m (u + v²/2), J."""
    u, v, m = of(simulation, "thermal_energy", "velocity", "mass")
    return float((m * (u + 0.5 * (v**2).sum(axis=1))).sum())


def behind_shock(speed):
    """Density and pressure before a piston of a ``speed``, m/s, and how fast the shock goes, m/s: Rankine-Hugoniot."""
    a = 0.25 * (GAMMA + 1.0) * speed / SPEED
    m2 = (a + np.sqrt(1.0 + a * a)) ** 2
    density = (GAMMA + 1.0) * m2 / ((GAMMA - 1.0) * m2 + 2.0)
    return density, 1.0 + 2.0 * GAMMA / (GAMMA + 1.0) * (m2 - 1.0), np.sqrt(m2) * SPEED


def test_a_piston_drives_the_shock_of_its_speed(tmp_path):
    """The gas goes with it, is as dense and hot as Rankine and Hugoniot say, and then wins what the piston does."""
    rho, p, pace = behind_shock(1.0)
    x, v, density, pressure, simulation = pressed(tmp_path, 0.4)
    behind = (x > 0.45) & (x < 0.4 * pace - 0.05)
    assert v[behind].mean() == pytest.approx(1.0, abs=1e-3) and x.min() > 0.4
    assert density[behind].mean() == pytest.approx(rho, rel=0.015)
    assert pressure[behind].mean() == pytest.approx(p, rel=0.01)
    assert x[density > 0.5 * (1.0 + rho)].max() == pytest.approx(0.4 * pace, abs=0.01)
    face = FieldProbe("", np.array([0.4]), ("pressure", "velocity"))
    assert face.sample(simulation) == pytest.approx([p, 1.0], rel=0.01)  # images and gas meet there
    before = energy(simulation)
    while simulation.time < 0.6:
        simulation.step(0.6)
    assert energy(simulation) - before == pytest.approx(p * 0.2, rel=0.01)


def test_a_mirror_that_stands_drives_none(tmp_path):
    """The control."""
    x, v, density, pressure, _ = pressed(
        tmp_path, 0.4, TUBE, "walls.piston.motion.translation.velocity=[0.0]"
    )
    assert np.abs(v).max() < 1e-6 and np.abs(pressure - 1.0).max() < 0.01


def test_a_piston_that_draws_back_lets_gas_expand(tmp_path):
    """c = c₀ − (γ − 1)/2 u between it and the fan of waves that goes into the gas."""
    x, v, density, pressure, _ = pressed(
        tmp_path, 0.4, TUBE, "walls.piston.motion.translation.velocity=[-0.5]"
    )
    c = SPEED - 0.5 * (GAMMA - 1.0) * 0.5
    beside = (x > -0.15) & (x < 0.4 * (c - 0.5) - 0.05)
    assert v[beside].mean() == pytest.approx(-0.5, abs=1e-3)
    assert density[beside].mean() == pytest.approx((c / SPEED) ** (2.0 / (GAMMA - 1.0)), rel=0.01)
    assert pressure[beside].mean() == pytest.approx((c / SPEED) ** (2.0 * GAMMA / (GAMMA - 1.0)), rel=0.01)


def test_a_slow_piston_presses_as_an_adiabat(tmp_path):
    """To two thirds of the volume at 0.08 c, and back again."""
    swing = "walls.piston.motion={ sinusoid = { amplitude = [0.25], frequency = 0.0625, phase = -1.5707963267948966 } }"
    _, _, density, pressure, _ = pressed(tmp_path, 8.0, TUBE, swing, "space.spacing=0.02")
    assert density.mean() == pytest.approx(1.5, rel=0.01)
    assert pressure.mean() == pytest.approx(1.5**GAMMA, rel=0.02)


def test_a_piston_in_a_corner_of_mirrors_drives_the_same_shock(tmp_path):
    """In 2D, downwards, between two sides that stand: nothing depends on the place across."""
    rho, p, pace = behind_shock(1.0)
    x, v, density, pressure, simulation = pressed(tmp_path, 0.3, CHANNEL)
    behind = (x < 0.9 - 0.08) & (x > 1.2 - 0.3 * pace + 0.08)
    assert v[behind].mean() == pytest.approx(-1.0, abs=0.01)
    assert density[behind].mean() == pytest.approx(rho, rel=0.03)
    assert pressure[behind].mean() == pytest.approx(p, rel=0.02)
    assert np.abs(of(simulation, "velocity")[0][:, 0]).max() < 0.02


def along(folder, axis, way):
    """Place, velocity and pressure along ``axis``, in order, of gas that a piston has pressed ``way`` (1, −1) against
    its weight."""

    def box(first, last, wide=(0.0, 0.6)):
        ends = [
            list(ends)
            for ends in zip(*(sorted((way * first, way * last)) if d == axis else wide for d in (0, 1)))
        ]
        return dict(zip(("lower", "upper"), ends))

    def vector(size):
        return [way * size if d == axis else 0.0 for d in (0, 1)]

    gas, across = box(0.0, 1.0), (-0.2, 0.8)
    tables = {
        "scheme": "gas",
        "space": {"dimensions": 2, "spacing": 0.05, "periodic": ["yx"[axis]], **gas},
        "time": {"end": 1.0, "step": 0.002},
        "physics": {"gravity": vector(-0.5)},
        "ideal_gases": {"gas": {"shape": {"box": gas}, "density": 1.0, "pressure": 1.0}},
        "walls": {
            "end": {"shape": {"box": box(1.0, 1.2, across)}, "condition": "mirror"},
            "piston": {
                "shape": {"box": box(-0.2, 0.0, across)},
                "condition": "mirror",
                "motion": {"translation": {"velocity": vector(1.0)}},
            },
        },
    }
    simulation = start(draft(folder, tomli_w.dumps(tables)))
    for _ in range(60):
        simulation.step()
    simulation.settle_pressure()
    x, v, p = of(simulation, "position", "velocity", "pressure")
    order = np.argsort(way * x[:, axis], kind="stable")
    return np.array([way * x[order, axis], way * v[order, axis], p[order]])


def test_a_piston_that_is_turned_or_mirrored_does_the_same(tmp_path):
    first = along(tmp_path, 0, 1.0)
    assert first[2].max() > 2.5
    for axis, way in ((0, -1.0), (1, 1.0), (1, -1.0)):
        assert np.abs(along(tmp_path, axis, way) - first).max() < 1e-12


def test_pistons_that_meet_end_the_run(tmp_path):
    with pytest.raises(TooLarge, match="let them stop before"):
        pressed(tmp_path, 0.11, CHANNEL.replace("1.2", "0.12").replace("1.3]", "0.2]"))


@pytest.mark.parametrize(
    "motion",
    ["{ translation = { velocity = [1.0, -1.0] } }", "{ rotation = { speed = 1.0, center = [0.0, 1.2] } }"],
)
def test_mirrors_that_go_along_or_turn_are_refused(tmp_path, motion):
    case = draft(tmp_path, CHANNEL, f"walls.piston.motion={motion}")
    with pytest.raises(CaseError, match="walls.piston.motion: a mirror moves along its normal alone, here y"):
        Scene(case).layout.mirror_planes


def test_mirrors_before_water_stand(tmp_path):
    water = CHANNEL.replace('scheme = "gas"\n', "").replace("ideal_gases.gas", "fluids.water")
    [line] = refusal(tmp_path, water.replace("pressure = 1.0\n", ""))
    assert "a mirror moves before gases alone" in line
