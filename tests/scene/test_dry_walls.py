"""A wall that no water touches yet must not push when water comes."""

import numpy as np
import pytest

from psph.case import load
from psph.fields import WALL
from psph.scene import Scene

REACH = 0.056
"""How far the kernel of the case reaches, m: deeper layers of its walls feel no water."""


@pytest.fixture(scope="module")
def dam():
    scene = Scene(load("run/cases/dam_break.toml"))
    return scene, scene.particles(0, scene.layout.planes, 0)


def test_only_walls_near_the_column_carry_its_pressure(dam):
    scene, particles = dam
    wall = particles.kind == WALL
    pressed = particles.density > scene.species[0].density
    x, y = particles.position.T
    near = wall & (np.minimum(x, y) > -REACH)
    assert pressed[near & (x < 0) & (y > 0) & (y < 1.9)].all()
    assert pressed[near & (y < 0) & (x < 1.0)].all()
    assert not pressed[wall & (np.minimum(x, y) < -2.0 * REACH)].any()
    assert not pressed[wall & (x > 1.2)].any()


def test_the_column_s_pressure_goes_on_in_the_floor(dam):
    scene, particles = dam
    x, y = particles.position.T
    below = (particles.kind == WALL) & (abs(x - 0.5) < 0.1) & (y < 0) & (y > -REACH)
    pressure = scene.sound_speed**2 * (particles.density - 1000.0)
    assert pressure[below] == pytest.approx(9800.0 * (2.0 - y[below]))


def test_it_does_not_depend_on_where_the_planes_are_cut(dam):
    scene, whole = dam
    cut = scene.layout.planes // 3
    first = scene.particles(0, cut, 0)
    second = scene.particles(cut, scene.layout.planes, len(first.id))
    assert np.array_equal(np.concatenate([first.density, second.density]), whole.density)
