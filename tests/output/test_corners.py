"""Forces on parts of walls that meet: each is right by itself, and together they are those on the whole."""

import numpy as np
import pytest
from drafts import draft
from gauging import readings, started
from jobs import mpirun
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


def walls(dimensions, gate="gate"):
    """The lower and upper corners of the walls around the water, by name: floor, gate and others."""
    length, width, height = 0.6, 0.4, 0.5
    size = [length, width, height] if dimensions == 3 else [length, height]
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
    return boxes


def cut(boxes, name, axis, at):
    """The same with one of them in two parts, 0 and 1, where ``axis`` is ``at``."""
    lower, upper = ([*end] for end in boxes[name])
    between = [*lower], [*upper]
    between[0][axis] = between[1][axis] = at
    parts = {f"{name}0": (lower, between[1]), f"{name}1": (between[0], upper)}
    return {key: box for key, box in boxes.items() if key != name} | parts


def drawn(dimensions, boxes, turned=False):
    """The case of water 0.6 m long, 0.5 m high, in 3D 0.4 m wide, between walls, each with a gauge; ``turned``
    with its axes in reverse order."""
    order = slice(None, None, -1 if turned else 1)
    gravity = [0.0] * (dimensions - 1) + [-9.81]
    size = [0.6, 0.4, 0.5] if dimensions == 3 else [0.6, 0.5]
    told = {"gravity": gravity[order], "zero": [0.0] * dimensions, "upper": size[order]}
    text = WATER.format(dimensions=dimensions, **told)
    for name, box in boxes.items():
        below, above = ([float(x) for x in end][order] for end in box)
        text += f"[walls.{name}.shape.box]\nlower = {below}\nupper = {above}\n"
        text += f'[gauges.{name}.force]\non = ["{name}"]\n'
    return text + f"[gauges.all.force]\non = {list(boxes)}\n".replace("'", '"')


def tank(dimensions, gate="gate"):
    """Water between walls that are parts, and their boxes."""
    return drawn(dimensions, boxes := walls(dimensions, gate)), boxes


def alone(simulation, scene, name):
    """The force on the particles of a wall, N (dim,)."""
    store = simulation.store
    own = store.shown("group") == scene.layout.names.index(name)
    return (store.shown("mass")[own, None] * store.shown("load")[own]).sum(axis=0)


@pytest.mark.parametrize("dimensions", [2, pytest.param(3, marks=LONG)])
def test_a_gate_bears_the_pressure_on_its_face(tmp_path, dimensions):
    """Of its own particles alone it bears 0.95 of it: the floor has the last half row."""
    text, boxes = tank(dimensions)
    simulation, scene = started(draft(tmp_path, text))
    read = readings(simulation, scene)
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
    assert alone(simulation, scene, "gate")[0] < 0.96 * side * width


def test_a_gate_above_the_floor_shares_nothing_with_it(tmp_path):
    raised = "walls.gate.shape.box.lower=[0.6, 0.2]"
    simulation, scene = started(draft(tmp_path, tank(2)[0], raised))
    read, own = readings(simulation, scene), alone(simulation, scene, "gate")[0]
    assert own > 100.0 and read["gate.force_x"] == pytest.approx(own, rel=1e-12)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("dimensions", [2, pytest.param(3, marks=LONG)])
def test_two_walls_in_one_plane_bear_nothing_along_it(tmp_path, dimensions, turned):
    """Of its own particles alone each misses by p dx/4 for each metre of a seam (psph.output.gauges.seams)."""
    boxes, up = cut(walls(dimensions), "gate", -1, 0.2), dimensions - 1
    if dimensions == 3:
        boxes = cut(cut(boxes, "gate0", 1, 0.15), "gate1", 1, 0.15)
    simulation, scene = started(draft(tmp_path, drawn(dimensions, boxes, turned)))
    read = readings(simulation, scene)
    axes = "xyz"[:dimensions][:: -1 if turned else 1]
    seam = 1000.0 * 9.81 * 0.3 * 0.05 / 4.0  # p dx/4
    for name in boxes:
        if name.startswith("gate"):
            own = alone(simulation, scene, name)[:: -1 if turned else 1]
            for axis in range(1, dimensions):
                assert abs(own[axis]) > (0.9 if dimensions == 2 else 0.1) * seam
                assert abs(read[f"{name}.force_{axes[axis]}"]) < (0.03 if axis == up else 0.005) * seam
    across = sum(read[f"{name}.force_{axes[0]}"] for name in boxes if name.startswith("gate"))
    assert across == pytest.approx(-read[f"left.force_{axes[0]}"], rel=1e-9)
    for axis in axes:
        parts = sum(read[f"{name}.force_{axis}"] for name in boxes)
        assert parts == pytest.approx(read[f"all.force_{axis}"], abs=1e-8 * seam)


def test_a_seam_on_two_ranks(tmp_path):
    """The same bytes; what passes along the gate is in them."""
    case = tmp_path / "case.toml"
    case.write_text(drawn(2, cut(walls(2), "gate", -1, 0.2)).replace("end = 1.0", "end = 0.02"))
    tables = []
    for ranks in (1, 2):
        out = tmp_path / str(ranks)
        job = mpirun(ranks, ["-m", "psph", "run", case, "--out", out, "--set", "parallel.axis=y"])
        assert job.returncode == 0, job.stderr
        tables.append([(out / f"gauge-gate{part}.csv").read_bytes() for part in (0, 1)])
    assert tables[0] == tables[1]
    assert all(len(table.splitlines()) > 2 for table in tables[0])


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
