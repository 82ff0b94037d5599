"""Walls beside fluids that they do not continue: dry ones, pressureless ones, those that are pushed."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.physics.fluid import continuity, correction, pressure, several
from psph.physics.fluid.several import Mirroring
from psph.physics.fluid.weight import gravitation_of
from psph.physics.walls.dry import DryWall
from psph.simulation.step import BlowUp

DX, G = 0.05, 9.81
COLUMN = f"""
space = {{ dimensions = 2, spacing = {DX} }}
time.end = 1.0
physics.gravity = [0.0, -{G}]
physics.sound_speed = 30.0
[fluids.water]
shape.box = {{ lower = [0.0, 0.0], upper = [0.4, 0.6] }}
pressure = "hydrostatic"
[fluids.air]
shape.box = {{ lower = [0.4, 0.0], upper = [1.2, 0.6] }}
density = 10.0
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = {{ lower = [-0.2, -0.2], upper = [1.4, 0.8] }}
shape.difference.minus = [{{ box = {{ lower = [0.0, 0.0], upper = [1.2, 0.6] }} }}]
"""


def beside_air(folder):
    """The largest |p| of the walls with no water in reach, Pa, while water falls over in air."""
    simulation = start(draft(folder, COLUMN))
    for _ in range(60):
        simulation.step()
    simulation.settle_pressure()
    store = simulation.store
    x, p, group = store.owned_rows("position"), store.owned_rows("pressure"), store.owned_rows("group")
    walls, water = x[group == 2], x[group == 0]
    apart = np.linalg.norm(walls[:, None] - water[None], axis=2).min(axis=1)
    return float(np.abs(p[group == 2][apart > 2.8 * DX]).max())


def test_a_wall_beside_air_keeps_no_pressure_of_water(tmp_path, monkeypatch):
    """And the control: what comes from wet walls, and what water leaves, would hit it when it comes back."""
    assert beside_air(tmp_path) == 0.0
    monkeypatch.setattr(DryWall, "in_scene", lambda self, scene: self)
    assert beside_air(tmp_path) > 500.0


LAYERS = f"""
space = {{ dimensions = 2, spacing = {DX} }}
time.end = 1.0
physics.gravity = [0.0, -{G}]
physics.sound_speed = 44.3
[fluids.water]
shape.box = {{ lower = [0.0, 0.0], upper = [0.5, 0.5] }}
pressure = "hydrostatic"
[fluids.light]
shape.box = {{ lower = [0.0, 0.5], upper = [0.5, 1.0] }}
density = 100.0
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = {{ lower = [-0.2, -0.2], upper = [0.7, 1.2] }}
shape.difference.minus = [{{ box = {{ lower = [0.0, 0.0], upper = [0.5, 1.0] }} }}]
"""
LIFT = "{acceleration={acceleration=[0.0,9.81]},ramp=0.3}"


def lifted(folder, key):
    """The largest speed of the light layer relative to its box, m/s, that is pushed up by g."""
    simulation = start(draft(folder, LAYERS, f"{key}.motion={LIFT}", "physics.position_shift=off"))
    for _ in range(700):
        simulation.step()
    store = simulation.store
    v, group = store.owned_rows("velocity"), store.owned_rows("group")
    return float(np.abs(v[group == 1] - v[group == 2].mean(axis=0)).max())


def test_a_wall_that_is_pushed_pushes_what_it_does_not_continue(tmp_path, monkeypatch):
    """As in the frame of the box; and the control, by gravity alone."""
    assert lifted(tmp_path, "walls.tank") < 1.2 * lifted(tmp_path, "frame") < 0.1
    monkeypatch.setattr(several, "pull_at_walls", gravitation_of)
    assert lifted(tmp_path, "walls.tank") > 0.2


def test_walls_without_pressure_do_not_mirror(tmp_path, monkeypatch):
    """999 kg/m³ beside 1000 rest as one fluid does; and the control, in which the pressures of both sides of a
    corner of the wall differ."""
    keys = ("fluids.light.density=999.0", "walls.tank.condition=repulsive")
    simulation = start(draft(tmp_path, LAYERS, *keys))
    for _ in range(700):
        simulation.step()
    assert simulation.speed < 1.0
    for module in (continuity, correction, pressure):
        monkeypatch.setattr(module, "facing_of", lambda scene: Mirroring(gravitation_of(scene)))
    simulation = start(draft(tmp_path, LAYERS, *keys, "time.passes=1"))  # in two it takes ten times as long
    with pytest.raises(BlowUp):
        for _ in range(700):
            simulation.step()


def test_the_image_of_a_fluid_is_that_of_its_own_column(tmp_path):
    """Behind a mirror across a part of gravity: with the weight of the water the image of air had a density below
    nothing, and the water before it 1e24 m/s²."""
    keys = ("fluids.light.density=1.0", "physics.gravity=[3.0,-9.81]", "physics.sound_speed=20.0")
    simulation = start(draft(tmp_path, LAYERS, *keys, "walls.tank.condition=mirror"))
    assert 1.0 < simulation.acceleration < 2000.0
