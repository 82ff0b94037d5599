"""Forces on parts of walls that meet: each is right by itself, and together they are those on the whole."""

import numpy as np
import pytest
from drafts import draft
from gauging import readings, started
from long import LONG

WATER = """
[space]
dimensions = {dimensions}
spacing = 0.05
[time]
end = 1.0
[physics]
gravity = {gravity}
[fluids.water]
pressure = "hydrostatic"
shape.box = {{ lower = {zero}, upper = {upper} }}
"""


def tank(dimensions, gate="gate"):
    """Water 0.6 m long, 0.5 m high, in 3D 0.4 m wide, between walls that are parts: floor, gate and others."""
    length, width, height = 0.6, 0.4, 0.5
    size = [length, width, height] if dimensions == 3 else [length, height]
    gravity = [0.0] * (dimensions - 1) + [-9.81]
    text = WATER.format(dimensions=dimensions, gravity=gravity, zero=[0.0] * dimensions, upper=size)
    ends = np.array([[0.0] * dimensions, [*size[:-1], 0.7]])
    lower, upper = ends - 0.2 * np.array([[1.0], [1.0]]) * [[1], [-1]]
    upper[-1] = 0.7
    boxes = {"floor": (lower, [*upper[:-1], 0.0])}
    for axis, names in enumerate((("left", gate), ("front", "back"))[: dimensions - 1]):
        for name, (low, high) in zip(names, ((lower[axis], 0.0), (size[axis], upper[axis]))):
            below, above = [*lower[:-1], 0.0], [*upper]
            if axis == 1:  # between the others
                below[0], above[0] = 0.0, size[0]
            below[axis], above[axis] = low, high
            boxes[name] = (below, above)
    for name, (below, above) in boxes.items():
        below, above = ([float(x) for x in end] for end in (below, above))
        text += f"[walls.{name}.shape.box]\nlower = {below}\nupper = {above}\n"
        text += f'[gauges.{name}.force]\non = ["{name}"]\n'
    return text + f"[gauges.all.force]\non = {list(boxes)}\n".replace("'", '"'), boxes


@pytest.mark.parametrize("dimensions", [2, pytest.param(3, marks=LONG)])
def test_a_gate_bears_the_pressure_on_its_face(tmp_path, dimensions):
    """Of its own particles alone it bears 0.95 of it: the floor has the last half row."""
    text, boxes = tank(dimensions)
    simulation, scene = started(draft(tmp_path, text))
    read, store = readings(simulation, scene), simulation.store
    width = 0.4 if dimensions == 3 else 1.0
    up = "xyz"[dimensions - 1]
    side = 0.5 * 1000.0 * 9.81 * 0.5**2
    assert read["gate.force_x"] == pytest.approx(side * width, rel=5e-3)
    assert read["left.force_x"] == pytest.approx(-side * width, rel=5e-3)
    if dimensions == 3:
        assert read["back.force_y"] == pytest.approx(side * 0.6, rel=5e-3)
    assert read[f"floor.force_{up}"] == pytest.approx(-1000.0 * 9.81 * 0.5 * 0.6 * width, rel=7e-3)
    for axis in "xyz"[:dimensions]:
        parts = sum(read[f"{name}.force_{axis}"] for name in boxes)
        assert parts == pytest.approx(read[f"all.force_{axis}"], abs=1e-9 * side)
    own = store.shown("group") == scene.layout.names.index("gate")
    alone = (store.shown("mass")[own] * store.shown("load")[own, 0]).sum()
    assert alone < 0.96 * side * width


def test_a_gate_above_the_floor_shares_nothing_with_it(tmp_path):
    raised = "walls.gate.shape.box.lower=[0.6, 0.2]"
    simulation, scene = started(draft(tmp_path, tank(2)[0], raised))
    read, store = readings(simulation, scene), simulation.store
    own = store.shown("group") == scene.layout.names.index("gate")
    alone = (store.shown("mass")[own] * store.shown("load")[own, 0]).sum()
    assert alone > 100.0 and read["gate.force_x"] == pytest.approx(alone, rel=1e-12)


def test_moments_about_a_point_that_a_wall_carries_along(tmp_path):
    text, boxes = tank(2)
    moves = [f"walls.{name}.motion.translation={{velocity=[4.0, 1.0]}}" for name in boxes]
    carried = 'gauges.carried.force={on=["gate"], about=[0.6, 0.1], moves_with="gate"}'
    start = ["fluids.water.velocity=[4.0, 1.0]", "space.upper=[3.0, 1.0]", "space.lower=[-0.3, -0.3]"]
    simulation, scene = started(draft(tmp_path, text, carried, *moves, *start), 20)
    read, time = readings(simulation, scene), simulation.time
    assert 4.0 * time > 0.05  # a spacing
    x, y = 0.6 + 4.0 * time, 0.1 + time
    about = read["gate.moment_z"] - x * read["gate.force_y"] + y * read["gate.force_x"]
    assert read["carried.moment_z"] == pytest.approx(about, rel=1e-9)
    assert abs(read["carried.moment_z"] / read["gate.moment_z"] - 1.0) > 0.05
