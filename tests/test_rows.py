"""Sums over the components of rows: the same bits in however many rows."""

import numpy as np
import pytest
from theory.solutions.test_solutions import FLOWS, places

from psph.case.fluids import Fluid
from psph.physics.fluid.state import Linear, Tait
from psph.rows import projected
from psph.scene.fluid.still import Still
from psph.scene.species import Start

N = 103


def same_in_parts(function, x):
    """Whether each row of ``x`` alone, and each five, give what all give together."""
    whole = np.asarray(function(x))
    return all(
        np.array_equal(function(x[k : k + n]), whole[k : k + n]) for n in (1, 5) for k in range(len(x))
    )


def drawn(dim):
    return np.random.default_rng(dim).uniform(-3.0, 3.0, (N, dim))


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_a_projection_is_the_same_in_however_many_rows(dim):
    direction = tuple(np.random.default_rng(9).normal(size=dim))
    assert projected(drawn(dim), direction) == pytest.approx(drawn(dim) @ np.array(direction), rel=1e-13)
    assert same_in_parts(lambda x: projected(x, direction), drawn(dim))


def test_a_sheared_start_is_the_same_in_however_many_rows():
    rows = [[0.1, 0.7, 0.3], [1.3, 0.2, 0.9], [0.37, 0.41, 0.77]]
    box = {"box": {"lower": [0.0] * 3, "upper": [1.0] * 3}}
    body = Fluid(shape=box, velocity_gradient=rows, velocity_center=[0.333, 0.111, 0.05])
    assert same_in_parts(body.sheared, drawn(3))
    assert body.sheared(drawn(3)) == pytest.approx((drawn(3) - body.velocity_center) @ np.array(rows).T)


@pytest.mark.parametrize("law", (Linear(), Tait()))
def test_the_density_of_a_still_column_is_the_same_in_however_many_rows(law):
    layer = Still(up=(0.6, 0.64, 0.48), surface=5.0, above=0.0, weight=9800.0, highest=0.0)
    column = Start(law, 1000.0, 50.0, 0.0, layer=layer)
    assert same_in_parts(column.density, drawn(3))


@pytest.mark.parametrize("name", FLOWS)
def test_exact_solutions_are_the_same_in_however_many_rows(name):
    flow, setting = FLOWS[name]
    for field in ("velocity", "pressure"):
        if hasattr(flow, field):
            assert same_in_parts(lambda x: getattr(flow, field)(x, 0.02, setting), places(setting, N))
