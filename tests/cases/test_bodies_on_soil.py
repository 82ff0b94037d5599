"""Rigid bodies that rest on soil, slide on it, hit it and lie in it."""

import math

import numpy as np
import pytest
from cases.measures import finished
from invariances.running import begun, by_id
from long import LONG

pytestmark = pytest.mark.timeout(600)

G = 9.81

BED = {
    "density": 1800.0,
    "young": 2e6,
    "poisson": 0.3,
    "friction_angle": 30.0,
    "cohesion": 2000.0,
}


def box(lower, upper):
    return {"box": {"lower": lower, "upper": upper}}


def scene(bed, block, dx=0.025, **tables):
    return {
        "space": {"dimensions": 2, "spacing": dx, "lower": [-1.0, -1.0], "upper": [2.0, 2.0]},
        "time": {"end": 10.0},
        "soils": {"bed": {"shape": bed, **BED}},
        "bodies": {"block": block},
        **tables,
    }


def velocity_of(simulation) -> np.ndarray:
    """That of the body (3,), m/s."""
    return simulation.engine.of("bodies").bodies.velocity[0]


def test_a_body_that_hits_soil_gives_it_its_momentum(tmp_path):
    side, density, speed, spin = 0.12, 2500.0, np.array([0.7, -1.5]), 3.0
    block = {
        "shape": box([0.02, 0.22], [0.14, 0.34]),
        "density": density,
        "velocity": speed.tolist(),
        "spin": spin,
    }
    simulation = begun(scene(box([-0.2, 0.0], [0.2, 0.2]), block, dx=0.02), tmp_path)
    mass, soil = density * side**2, by_id(simulation, "kind") == 0
    before = mass * speed
    while simulation.time < 0.02:
        simulation.step()
    m, v = by_id(simulation, "mass")[soil], by_id(simulation, "velocity")[soil]
    given = (m[:, None] * v).sum(axis=0)
    now = mass * velocity_of(simulation)[:2]
    assert np.abs(given + now - before).max() < 1e-11 * np.abs(before).max()
    assert given[1] < 0.5 * before[1]  # it did hit


@LONG
@pytest.mark.parametrize("no_slip", (True, False))
def test_a_block_slides_until_sand_has_stopped_it(no_slip, tmp_path):
    """Without dilatancy a plane of slip bears sin φ of what presses on it; without no_slip, the control, nothing."""
    run = finished("soils/sliding_block", tmp_path, f"bodies.block.no_slip={str(no_slip).lower()}")
    motion = run.gauges()["block"]
    time, speed = motion["time"], motion["block.velocity_x"]
    early = (time > 0.02) & (time < 0.12)
    slowed = -np.polynomial.polynomial.polyfit(time[early], speed[early], 1)[1] / G
    if no_slip:
        assert slowed == pytest.approx(math.sin(math.radians(30.0)), rel=0.05)
        assert np.abs(speed[time > 0.2]).max() < 0.01 and abs(motion["block.turn_z"][-1]) < 0.01
    else:
        assert slowed < 0.07 and speed[-1] > 0.6


@LONG
@pytest.mark.parametrize("density", (1500.0, 1800.0))
def test_soil_bears_a_body_on_it_or_in_it(density, tmp_path):
    """What rests on it creeps, as ground does under a load that is not its own (docs/soils.md)."""
    buried = density == 1800.0
    low = 0.2 if buried else 0.6
    block = {"shape": box([0.4, low], [0.6, low + 0.2]), "density": density}
    wall = {
        "shape": {
            "difference": {
                "from": box([-0.1, -0.1], [1.1, 0.8]),
                "minus": [box([0.0, 0.0], [1.0, 0.9])],
            }
        },
    }
    tables = scene(box([0.0, 0.0], [1.0, 0.6]), block, walls={"tank": wall}, physics={"gravity": [0.0, -G]})
    simulation = begun(tables, tmp_path)
    left = []  # what the push lacks of the weight
    while simulation.time < 0.6:
        simulation.step()
        left += [simulation.engine.of("bodies").bodies.force[0, 1]] * (simulation.time > 0.4)
    assert abs(np.mean(left)) < 0.01 * 0.04 * density * G
    assert abs(velocity_of(simulation)[1]) < 0.01
