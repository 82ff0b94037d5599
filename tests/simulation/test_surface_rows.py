"""What rows below a surface bear: theory beside still water, and from one spacing to another."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.physics.fluid.rows import pressures_of_rows
from psph.scene import Scene
from psph.simulation.surface_rows import borne, rows_of, weighed

COLUMN = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
[space]
dimensions = 2
spacing = 0.02
periodic = ["x"]
lower = [0.0, -0.08]
upper = [0.2, 0.3]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 0.2] }
pressure = "hydrostatic"
[walls.floor]
shape.box = { lower = [0.0, -0.08], upper = [0.2, 0.0] }
"""


@pytest.mark.parametrize("smoothing", [1.2, 1.4])
def test_rows_at_rest_bear_what_theory_says(smoothing, tmp_path):
    """Within 0.03 of ρ g dx; did they bear their depth it would be 0.12."""
    case = draft(tmp_path, COLUMN, f"space.smoothing={smoothing}")
    simulation = start(case)
    found, many = np.zeros(5), 0
    while simulation.time < 0.4:
        simulation.step(0.4)
        if simulation.time > 0.1 and simulation.steps % 10 == 0:
            simulation.settle_pressure()
            fluid = simulation.store.group[simulation.store.inner] == 0
            height = simulation.store.owned_rows("position")[fluid, 1]
            order = np.argsort(-height).reshape(10, 10)[:5]
            found += simulation.store.owned_rows("pressure")[fluid][order].mean(axis=1)
            many += 1
    theory = pressures_of_rows(Scene(case))[1:6]
    assert found / many / (9810.0 * 0.02) == pytest.approx(theory, abs=0.03)
    assert (np.arange(5) + 0.5 - theory)[0] > 0.09


def test_a_pressure_goes_to_another_spacing_as_a_depth(tmp_path):
    rows = rows_of(Scene(draft(tmp_path, COLUMN)))
    unit = rows.weight * 0.028
    assert unit == pytest.approx(9810.0 * 0.02)
    pressures = np.linspace(-1.0, 8.0, 91) * unit
    depths = np.array([weighed(rows, 0.028, p) for p in pressures])
    assert (np.diff(depths) > 0.0).all()
    assert [borne(rows, 0.028, depth) for depth in depths] == pytest.approx(pressures)
    assert weighed(rows, 0.028, rows.borne[2] * unit) == pytest.approx(1.5 * unit)
    assert borne(rows, 0.014, 0.75 * unit) == pytest.approx(rows.borne[2] * 0.5 * unit)


@pytest.mark.parametrize("key", ["physics.gravity=[0.0,0.0]", 'physics.gradient_correction="off"'])
def test_without_weight_or_corrected_gradients_pressures_stay(key, tmp_path):
    keys = [key, "fluids.water.pressure=100.0", "physics.sound_speed=20.0"]
    if "correction" in key:
        keys += [f"physics.{one}=off" for one in ("local_potential", "fourth_order_diffusion")]
        keys += ["physics.reconstructed_damping=off"]
    rows = rows_of(Scene(draft(tmp_path, COLUMN, *keys)))
    assert not len(rows.borne)
    assert weighed(rows, 0.028, 50.0) == borne(rows, 0.028, 50.0) == 50.0
