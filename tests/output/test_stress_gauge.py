"""The stress at a point: of a soil at rest under its weight, of a solid that is stretched and carried along."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import readings, started
from long import LONG
from simulation.test_solid_stress import BLOCK, POISSON, STRETCHES, YOUNG, closed_form

from psph.case import CaseError
from psph.scene import Scene, check

LAYER = """
time.end = 1.0
[space]
dimensions = {d}
spacing = 0.1
lower = {lower}
upper = {upper}
[physics]
gravity = {gravity}
[soils.sand]
shape.box = {{ lower = {lower}, upper = {top} }}
density = 1600.0
young = 1e7
poisson = 0.3
friction_angle = 33.0
rest_coefficient = 0.6
[gauges.deep.stress]
of = "sand"
at = {deep}
[gauges.top.stress]
of = "sand"
at = {surface}
[gauges.air.stress]
of = "sand"
at = {air}
"""
"""A layer 0.6 m deep, open at its sides."""


@pytest.mark.parametrize("d", (2, pytest.param(3, marks=LONG)))
def test_a_layer_of_soil_begins_with_the_stress_of_its_weight(tmp_path, d):
    def at(x, y):
        return [x] * (d - 1) + [y]

    points = {"lower": at(0.0, 0.0), "upper": at(0.6, 1.2), "top": at(0.6, 0.6), "gravity": at(0.0, -10.0)}
    points |= {"deep": at(0.3, 0.23), "surface": at(0.3, 0.6), "air": at(0.3, 1.0)}
    found = readings(*started(draft(tmp_path, LAYER.format(d=d, **points))))
    down, across = -1600.0 * 10.0 * 0.37, -0.6 * 1600.0 * 10.0 * 0.37
    expected = {"stress_xx": across, "stress_zz": across if d == 2 else down, "stress_xy": 0.0}
    expected["stress_yy"] = down if d == 2 else across
    expected |= {"mean_stress": (down + 2.0 * across) / 3.0, "von_mises": across - down}
    for column, value in expected.items():
        assert found[f"deep.{column}"] == pytest.approx(value, rel=1e-3, abs=5.0), column
        assert found[f"top.{column}"] == pytest.approx(0.0, abs=20.0), column
        assert np.isnan(found[f"air.{column}"])


@pytest.mark.parametrize("d", (2, 3))
def test_a_point_of_a_stretched_solid_takes_its_stress_along(tmp_path, d):
    numbers = {"young": YOUNG, "poisson": POISSON, "law": "neo-hookean"}
    text = BLOCK.format(dimensions=d, lower=[0.0] * d, upper=[0.5] * d, **numbers)
    simulation, scene = started(draft(tmp_path, text, f"gauges.a.stress={{of='block',at={[0.5] * d}}}"))
    store = simulation.store
    for axis, stretch in enumerate(STRETCHES[:d]):
        store["position"][axis][store.inner] *= stretch
        store["position"][axis][store.inner] += 7.0
    found, expected = readings(simulation, scene), closed_form("neo-hookean")
    assert [found[f"a.stress_{k}"] for k in ("xx", "yy", "zz")] == pytest.approx(expected, rel=1e-8)
    assert found["a.stress_xy"] == pytest.approx(0.0, abs=1e-3)
    assert found["a.mean_stress"] == pytest.approx(expected.mean(), rel=1e-8)
    spread = ((expected - expected.mean()) ** 2).sum()
    assert found["a.von_mises"] == pytest.approx(np.sqrt(1.5 * spread), rel=1e-8)


def test_a_point_that_is_nowhere_is_refused(tmp_path):
    numbers = {"young": YOUNG, "poisson": POISSON, "law": "neo-hookean"}
    text = BLOCK.format(dimensions=2, lower=[0.0, 0.0], upper=[0.5, 0.5], **numbers)
    [line] = refusal(tmp_path, text, "gauges.a.stress={of='blok',at=[0.2,0.2]}")
    assert "gauges.a.stress.of" in line and "no solid or soil has this name; did you mean 'block'?" in line
    off = Scene(draft(tmp_path, text, "gauges.a.stress={of='block',at=[0.2,0.9]}"))
    with pytest.raises(CaseError, match=r"gauges.a.stress.at: \[0.2, 0.9\] lies off solids.block"):
        check(off)
