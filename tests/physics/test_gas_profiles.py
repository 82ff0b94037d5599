"""Ideal gases that start by formulas of place: what particles then have, and waves that follow."""

import re

import numpy as np
import pytest
from drafts import ROUND, draft, refusal
from gauging import start
from parallel.written import written
from physics.test_gas import CALM, of
from runs.resuming import go_on_elsewhere

from psph.scene import Scene, check

WAVE = """
scheme = "gas"
[space]
dimensions = 1
spacing = {spacing}
periodic = ["x"]
lower = [0.0]
upper = [1.0]
[time]
end = 1.0
cfl = 0.1
[ideal_gases.air]
shape.box = {{ lower = [0.0], upper = [1.0] }}
density = "1 + 1e-4 * sin(2 * pi * x)"
pressure = "(1 + 1.4e-4 * sin(2 * pi * x)) / 1.4"
velocity = ["1e-4 * sin(2 * pi * x)"]
"""
"""Sound of 1 m/s that goes to the right."""

STRETCH = 'ideal_gases.air.stretch="x"'


def gone_round(tmp_path, count, *sets):
    """Mean error of a wave after sound has gone once round the box, by its amplitude."""
    simulation = start(draft(tmp_path, WAVE.format(spacing=1.0 / count), *CALM, *sets))
    end = 1.0 / of(simulation, "sound")[0].mean()
    while simulation.time < end:
        simulation.step(end)
    x, v = of(simulation, "position", "velocity")
    return np.abs(v[:, 0] * 1e4 - np.sin(2.0 * np.pi * x[:, 0])).mean()


@pytest.mark.parametrize("sets", [(), (STRETCH,)])
def test_sound_goes_round_a_box_and_comes_back_to_second_order(tmp_path, sets):
    errors = [gone_round(tmp_path, count, *sets) for count in (16, 32, 64, 128)]
    if not sets:
        assert errors == pytest.approx([0.20, 0.053, 0.0137, 0.0034], rel=0.1)
    assert errors[2] < 0.02 and errors[1] / errors[2] > 3.5


def test_a_density_is_had_by_masses_or_by_places(tmp_path):
    """0.5 to 1.5 kg/m over a box; summed densities, which smooth, are as near by both."""
    sets = ('ideal_gases.air.density="1 + 0.5 * sin(2 * pi * x)"', "ideal_gases.air.pressure=1.0")
    for more in ((), (STRETCH,)):
        simulation = start(draft(tmp_path, WAVE.format(spacing=0.01), *sets, *more))
        x, rho, mass, p = of(simulation, "position", "density", "mass", "pressure")
        assert np.abs(rho / (1.0 + 0.5 * np.sin(2.0 * np.pi * x[:, 0])) - 1.0).max() < 0.02
        assert mass.sum() == pytest.approx(1.0, rel=1e-6) and p == pytest.approx(1.0, rel=1e-12)
        assert np.ptp(mass) == (0.0 if more else pytest.approx(0.01, rel=0.01))
        gaps = np.diff(np.sort(x[:, 0]))
        assert gaps.max() / gaps.min() == pytest.approx(3.0 if more else 1.0, rel=0.01)


BALL = """
scheme = "gas"
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
[ideal_gases.cloud]
density = "1 / (2 * pi * r)"
stretch = "r"
thermal_energy = "0.05 * (2 - r)"
velocity = ["-y", "x", "0.1 * r"]
shape.ball = { center = [3.0, 0.0, 0.0], radius = 1.0 }
"""


def test_a_ball_is_stretched_by_its_radius(tmp_path):
    """Evrard's cloud: r² of its kg are within r, about its own middle."""
    simulation = start(draft(tmp_path, BALL))
    x, v, mass, heat = of(simulation, "position", "velocity", "mass", "thermal_energy")
    r = np.linalg.norm(x - [3.0, 0.0, 0.0], axis=1)
    assert np.ptp(mass) == 0.0 and mass.sum() == pytest.approx(1.0, rel=0.02)
    for radius in (0.2, 0.5, 0.8):
        assert mass[r < radius].sum() == pytest.approx(radius**2, abs=0.02)
    assert heat == pytest.approx(0.05 * (2.0 - r), rel=1e-12)
    assert v == pytest.approx(np.stack([-x[:, 1], x[:, 0], 0.1 * r], axis=1), abs=1e-12)


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        ('density="1 + "', "is no formula; give one such as"),
        ('density="sinn(x)"', "no function 'sinn'; did you mean 'sin'?"),
        ('density="1 + u"', "no coordinate 'u'; known here: x, y, z, r, pi"),
        ('density="max(x)"', "'max' has 1 numbers in its brackets; give 2"),
        ('density="x.real"', "has what no formula has; use"),
        ('density="__import__(x)"', "no function '__import__'; known here"),
        ("density=\"'1'\"", "holds what is no number"),
        ('density="0 < x < 1"', "compares more than two numbers"),
        ('density="1 + y"', "there is no y in 1D; give r, x"),
        ('pressure="1 + y"', "there is no y in 1D; give r, x"),
        ('velocity=["y"]', r"velocity\[0\]: .*there is no y in 1D"),
        ('velocity=["x", "x"]', "velocity: .*2 numbers or formulas; give 1"),
        ("density=-1.0", "density: -1.0: a number that must be above 0"),
        ("density=[1.0]", r"density: \[1.0\]: neither a number nor a formula"),
        ('stretch="r"', 'stretch: "r": needs density as a formula of r alone'),
        ('stretch="w"', 'stretch: "w" is not known'),
    ],
)
def test_what_is_no_formula_is_told_in_a_line(tmp_path, sets, says):
    [line] = refusal(tmp_path, WAVE.format(spacing=0.01), f"ideal_gases.air.{sets}")
    assert re.search(says, line), line


def test_a_stretch_needs_a_box_and_a_formula_numbers_everywhere(tmp_path):
    union = "{ union = [{ box = { lower = [0.0], upper = [0.5] } }] }"
    lines = refusal(tmp_path, WAVE.format(spacing=0.01), STRETCH, f"ideal_gases.air.shape={union}")
    assert re.search("stretch: .*moves particles within a box alone; give such a shape", lines[0])
    case = draft(tmp_path, WAVE.format(spacing=0.01), 'ideal_gases.air.density="0.5 - x"')
    with pytest.raises(ValueError, match=r'density: "0.5 - x" is -0.005 at \[0.505\]; give .* above 0 there'):
        check(Scene(case))


FLOW = (
    'scheme = "gas"'
    + ROUND
    + """
[time]
end = 0.03
[physics]
shock_viscosity = { least = 0.0 }
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
density = "1 + 0.5 * exp(-20 * r**2)"
pressure = "2 + sin(2 * pi * x) * cos(2 * pi * y)"
velocity = ["sin(2 * pi * y)", "0.1 if x < 0.5 else tanh(x)"]
jitter = 0.2
"""
)


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize(("before", "after"), [(1, 2), (2, 1)])
def test_formulas_have_the_same_bits_on_any_ranks_and_after_a_checkpoint(mpi_tmp_path, before, after):
    go_on_elsewhere(written(mpi_tmp_path, FLOW), before, after, mpi_tmp_path)
