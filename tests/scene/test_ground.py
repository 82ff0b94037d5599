"""Soils under their own weight and that of others at the start: psph.scene.stressed."""

import numpy as np
import pytest
from drafts import draft

from psph.scene import Scene

SAND = """
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle = 33.0
"""
CLAY = """
density = 2400.0
young = 4.0e6
poisson = 0.4
friction_angle = 10.0
cohesion = 2000.0
"""
G = 9.81


def ground(gravity, lower, shapes):
    """A case of sand and clay without walls."""
    parts = "".join(f"[soils.{name}]\nshape.{shape}{soil}" for name, shape, soil in shapes)
    return (
        f"[space]\ndimensions = {len(gravity)}\nspacing = 0.01\n"
        f"lower = {lower}\nupper = {[x + 0.3 for x in lower]}\n"
        f"[time]\nend = 0.1\n[physics]\ngravity = {list(gravity)}\n{parts}"
    )


def borne(scene, name, x):
    """Pressure along gravity of a soil at the points ``x`` (n, dim), Pa."""
    x = np.array(x, float)
    layer = scene.starts.layers[scene.layout.names.index(name)]
    rows = layer.deviator(x)
    diagonal = {2: (0, 2), 3: (0, 3, 5)}[x.shape[1]][layer.axis]
    return layer.pressure(x) - rows[:, diagonal]


LAYERS_2D = (
    ("clay", "box = { lower = [0.0, 0.08], upper = [0.1, 0.12] }", CLAY),
    ("sand", "box = { lower = [0.0, 0.0], upper = [0.2, 0.08] }", SAND),
)


def test_a_layer_bears_what_lies_on_it_and_nothing_where_nothing_does(tmp_path):
    scene = Scene(draft(tmp_path, ground((0.0, -G), [-0.05, -0.05], LAYERS_2D)))
    sand = borne(scene, "sand", [[0.055, 0.005], [0.155, 0.005], [0.055, 0.075]])
    weight = np.array([0.075 * 1600.0 + 0.04 * 2400.0, 0.075 * 1600.0, 0.005 * 1600.0 + 0.04 * 2400.0]) * G
    assert sand == pytest.approx(weight, rel=1e-12)
    assert borne(scene, "clay", [[0.055, 0.085]]) == pytest.approx([0.035 * 2400.0 * G], rel=1e-12)


def test_a_lens_weighs_what_it_is_made_of(tmp_path):
    """Gravity along +x: what is above is to the left."""
    lens = "box = { lower = [0.04, 0.0], upper = [0.06, 0.1] }"
    whole = "box = { lower = [0.0, 0.0], upper = [0.1, 0.1] }"
    around = f"difference = {{ from = {{ {whole} }}, minus = [{{ {lens} }}] }}"
    text = ground((G, 0.0), [-0.05, -0.05], (("clay", lens, CLAY), ("sand", around, SAND)))
    scene = Scene(draft(tmp_path, text))
    below, above = borne(scene, "sand", [[0.095, 0.055], [0.035, 0.055]])
    assert below == pytest.approx((0.075 * 1600.0 + 0.02 * 2400.0) * G, rel=1e-12)
    assert above == pytest.approx(0.035 * 1600.0 * G, rel=1e-12)
    assert borne(scene, "clay", [[0.055, 0.055]]) == pytest.approx(
        [(0.04 * 1600 + 0.015 * 2400) * G], rel=1e-12
    )


def test_a_layer_under_another_and_under_water_in_space(tmp_path):
    """The pores of the sand are full up to 0.2 m: its clay is in that water, and bears no more of it."""
    shapes = (
        ("clay", "box = { lower = [0.0, 0.0, 0.08], upper = [0.05, 0.1, 0.12] }", CLAY),
        ("sand", "box = { lower = [0.0, 0.0, 0.0], upper = [0.1, 0.1, 0.08] }", SAND + "water_level = 0.2\n"),
    )
    scene = Scene(draft(tmp_path, ground((0.0, 0.0, -G), [-0.05] * 3, shapes)))
    under, free = borne(scene, "sand", [[0.025, 0.055, 0.005], [0.085, 0.055, 0.005]])
    assert under == pytest.approx((0.075 * 1600.0 + 0.04 * 2400.0 + 0.08 * 1000.0) * G, rel=1e-12)
    assert free == pytest.approx((0.075 * 1600.0 + 0.12 * 1000.0) * G, rel=1e-12)


def test_under_tilted_gravity_the_water_in_the_pores_is_that_of_the_law(tmp_path):
    """Its level is level: height is along gravity, not along the axis of which gravity has most (0.3 of ρ_w g H)."""
    sand = ("sand", "box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }", SAND + "water_level = 0.08\n")
    gravity = (3.0, -9.0)
    scene = Scene(draft(tmp_path, ground(gravity, [-0.05, -0.05], (sand,))))
    [layer], [part] = scene.starts.layers.values(), scene.layout.parts
    x = np.array([[0.005, 0.005], [0.195, 0.005], [0.105, 0.055], [0.005, 0.095]])
    law = part.strength(gravity)
    water = law.pores * np.maximum(law.level - x @ np.array(law.up), 0.0)
    assert layer.stress(x)[0] == pytest.approx(water, rel=1e-12) and water.min() == 0.0 < water.max()
    grains = (0.1 - x[:, 1]) * 1600.0 * 9.0  # less the water, which presses from the ground on
    over = law.pores * np.maximum(law.level - np.c_[x[:, 0], np.full(4, 0.1)] @ np.array(law.up), 0.0)
    assert borne(scene, "sand", x) == pytest.approx(grains + over, rel=1e-12)
