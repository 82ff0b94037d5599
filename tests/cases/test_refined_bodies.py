"""Walls that move and rigid bodies beside particles of several sizes: loads, momentum, bits on ranks."""

import numpy as np
import pytest
from cases.test_refined import leading, together
from drafts import draft, refusal
from gauging import start
from mpi4py import MPI
from parallel.test_simulation import state
from runs.resuming import go_on_alike, keep, steps, taken_up

from psph.case import load
from psph.output.gauges import gauges_of
from psph.scene import Scene, faces
from psph.scene.levels import SHARE, SLOPE
from psph.simulation import levels
from psph.simulation.level_faces import FaceShares

BOX = """
time.end = 0.4
[space]
dimensions = 2
spacing = 0.04
refine = [{ shape.box = { lower = [LOWER, 0.0], upper = [1.6, 0.8] } }]
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.6, 0.64] }
shape.difference.minus = [{ box = { lower = [0.64, 0.32], upper = [0.96, 0.64] } }]
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.16, -0.16], upper = [1.76, 0.96] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.6, 0.96] } }]
[walls.block]
shape.box = { lower = [0.64, 0.32], upper = [0.96, 0.8] }
[gauges.push.force]
on = ["block"]
about = [0.8, 0.32]
"""
"""Still water that lifts a block by 0.32 m of its own depth and width."""

CARRIED = """
time.end = 1.0
physics.sound_speed = 20.0
[space]
dimensions = 2
spacing = 0.02
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.2, 0.6]
[[space.refine]]
shape.box = { lower = [0.6, 0.0], upper = [1.2, 0.6] }
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.2, 0.6] }
shape.difference.minus = [{ box = { lower = [0.32, 0.24], upper = [0.44, 0.36] } }]
velocity = [2.0, 0.0]
[bodies.box]
shape.box = { lower = [0.32, 0.24], upper = [0.44, 0.36] }
density = 1200.0
velocity = [2.0, 0.0]
spin = SPIN
"""
"""A box in a stream that takes it through a border."""

DRIVEN = """
time.end = 1.0
[space]
dimensions = 2
spacing = 0.04
[[space.refine]]
shape.box = { lower = [0.4, 0.0], upper = [1.2, 0.6] }
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.2, 0.4] }
pressure = "hydrostatic"
[walls.tank]
shape.union = [
    { box = { lower = [-0.6, -0.16], upper = [1.36, 0.0] } },
    { box = { lower = [1.2, 0.0], upper = [1.36, 0.6] } },
]
[walls.paddle]
shape.box = { lower = [-0.16, 0.0], upper = [0.0, 0.6] }
motion.sinusoid = { amplitude = [0.2, 0.0], frequency = 0.8 }
[bodies.float]
shape.box = { lower = [0.48, 0.2], upper = [0.8, 0.4] }
density = 700.0
[gauges.push.force]
on = ["paddle"]
"""
"""A paddle that comes near a border, and a box that floats across it."""


ALONG = BOX.replace("lower = [LOWER, 0.0]", "lower = [0.0, LOWER]")
"""A border along the face of the block, not across it."""


def lift(folder, lower, scene=BOX):
    """The mean force on the block over its buoyancy, and the moment over that and its width."""
    simulation = start(draft(folder, scene.replace("LOWER", str(lower))))
    gauge, found = next(iter(gauges_of(Scene(simulation_case(folder))).values())), []
    while simulation.time < 0.4:
        simulation.step(0.4)
        if simulation.time > 0.2:
            found.append(gauge.row(simulation))
    force_x, force_y, moment = np.mean(found, axis=0) / (1000.0 * 9.81 * 0.32 * 0.32)
    return force_x, force_y, moment / 0.32


def simulation_case(folder):
    """The case that :func:`draft` has written there."""
    return load(folder / "case.toml")


@pytest.mark.parametrize("lower", [0.8, 0.0, 1.2])
def test_water_lifts_a_block_by_its_weight_across_a_border(lower, tmp_path):
    """Across it, in finer and in coarse water alone."""
    force_x, force_y, moment = lift(tmp_path, lower)
    assert abs(force_y - 1.0) < 0.04
    assert abs(force_x) < 0.02 and abs(moment) < 0.02


def everyone(found, lists):
    """Shares of 1, whatever level."""
    store = found._store
    store[SHARE.name][store.inner] = 1.0
    return np.ones(store.owned, bool)


def test_a_load_of_which_all_levels_have_all_lifts_twice(tmp_path, monkeypatch):
    """The control: levels that are there twice would push twice."""
    monkeypatch.setattr(FaceShares, "tell", everyone)
    assert lift(tmp_path, 0.8)[1] > 1.3


@pytest.mark.parametrize("lower", [0.24, 0.28, 0.32, 0.34, 0.38, 0.44])
def test_water_lifts_it_by_its_weight_wherever_a_border_runs_along_its_face(lower, tmp_path):
    """Two rows and one below its face, on that, half a row above, one and a half, three."""
    force_x, force_y, moment = lift(tmp_path, lower, ALONG)
    assert abs(force_y - 1.0) < 0.004
    assert abs(force_x) < 0.002 and abs(moment) < 0.002


def by_place(found, number, points):
    """Where points are, for where the nearest face is."""
    return np.zeros(len(points)), points, np.zeros(points.shape)


def test_shares_by_where_particles_are_lift_it_by_too_little(tmp_path, monkeypatch):
    """The control: not by the nearest face."""
    monkeypatch.setattr(FaceShares, "_nearest", by_place)
    assert abs(lift(tmp_path, 0.34, ALONG)[1] - 1.0) > 0.02


def test_shares_where_the_fluid_is_not_half_the_way_to_the_wall_lift_it_by_too_much(tmp_path, monkeypatch):
    """The control: what a wall bears along its face is that of two levels, which differ."""
    tell = FaceShares.tell

    def without_slopes(found, lists):
        told = tell(found, lists)
        for along in found._store[SLOPE.name]:
            along[:] = 0.0
        return told

    monkeypatch.setattr(FaceShares, "tell", without_slopes)
    assert lift(tmp_path, 0.4, ALONG)[1] - 1.0 > 0.01


@pytest.mark.parametrize(
    "lower, upper, border",
    [("0.76, 0.2", "0.84, 0.6", "0.8, 0.0"), ("0.56, 0.36", "1.04, 0.44", "0.0, 0.36")],
)
def test_a_plate_with_a_border_along_it_has_the_push_of_both_sides(lower, upper, border, tmp_path):
    """Of two coarse rows, so that each particle in it is near to both faces; over the push on one side.  Its own
    nearest face, as the mean with that of the fluid had it until 29 November, let 0.06 to 0.12 of that be felt."""
    plate = f"lower = [{lower}], upper = [{upper}]"
    lowest, highest = (np.array([float(x) for x in one.split(",")]) for one in (lower, upper))
    scene = BOX.replace("lower = [0.64, 0.32], upper = [0.96, 0.64]", plate)
    scene = scene.replace("lower = [0.64, 0.32], upper = [0.96, 0.8]", plate)
    force = np.array(lift(tmp_path, "", scene.replace("LOWER, 0.0", border))[:2]) * 0.32**2
    width, height = highest - lowest
    wanted = np.array([0.0, width * height])
    one_side = max(height * (0.64 - 0.5 * (lowest + highest)[1]), width * (0.64 - lowest[1]))
    assert np.abs(force - wanted).max() < 0.01 * one_side


def in_a_gap(wide, border, axis):
    """The block so many coarse spacings above the floor, or from the side of the tank, and a border, so many
    spacings from there, along the gap between them."""
    lowest, edge = [0.64, 0.32], [-0.16, -0.16]
    lowest[axis], edge[axis] = 0.04 * wide, 0.04 * border
    low = f"lower = [{lowest[0]:g}, {lowest[1]:g}]"
    scene = BOX.replace("lower = [LOWER, 0.0], upper = [1.6, 0.8]", f"lower = {edge}, upper = [1.76, 0.96]")
    return scene.replace("lower = [0.64, 0.32]", low), 0.64 - lowest[1], 0.96 - lowest[0]


@pytest.mark.parametrize(
    "wide, border, axis", [(2, 0.5, 1), (2, 2.0, 1), (3, 1.0, 1), (3, 1.5, 1), (3, 1.5, 0), (2, 1.0, 0)]
)
def test_both_sides_of_a_narrow_gap_have_the_push_of_the_water_in_it(wide, border, axis, tmp_path):
    """Of the block and the tank, which are two parts."""
    scene, deep, long = in_a_gap(wide, border, axis)
    force_x, force_y, _ = lift(tmp_path, "", scene)
    assert force_y * 0.32**2 / (deep * long) == pytest.approx(1.0, abs=0.004)
    assert abs(force_x) < 0.004


@pytest.mark.parametrize("wide, border, axis", [(3, 1.5, 1), (3, 1.5, 0)])
def test_they_have_not_where_water_counts_by_the_one_face_nearest_to_it(
    wide, border, axis, tmp_path, monkeypatch
):
    """The control: the water before one side is on one level, that before the other on another."""
    gaps = FaceShares._gaps
    monkeypatch.setattr(
        FaceShares, "_gaps", lambda *told: (one := gaps(*told))._replace(facing=0.0 * one.facing)
    )
    scene, deep, long = in_a_gap(wide, border, axis)
    force_x, force_y, _ = lift(tmp_path, "", scene)
    assert max(abs(force_y * 0.32**2 / (deep * long) - 1.0), abs(force_x)) > 0.03


ROUND = """
time.end = 0.4
[space]
dimensions = 2
spacing = 0.04
periodic = ["x"]
lower = [0.0, -0.16]
upper = [1.2, 1.0]
refine = [{ shape.box = { lower = [-0.1, 0.4], upper = [1.3, 1.0] } }]
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.2, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.28], upper = [0.32, 0.52] } }]
pressure = "hydrostatic"
[walls.floor]
shape.box = { lower = [0.0, -0.16], upper = [1.2, 0.0] }
[walls.block]
shape.box = { lower = [0.0, 0.28], upper = [0.32, 0.52] }
[gauges.push.force]
on = ["block"]
"""
"""A block of 0.32 by 0.24 m with one side at the end of a period, where water is before it."""


def test_water_lifts_a_block_by_its_weight_at_the_end_of_a_period(tmp_path):
    force_x, force_y, _ = lift(tmp_path, "", ROUND)
    assert abs(force_y - 0.75) < 0.003 and abs(force_x) < 0.002


def test_a_side_at_the_end_of_a_period_that_is_no_face_has_wrong_shares(tmp_path, monkeypatch):
    """The control: as at the open ends of a domain, where a wall goes on."""
    monkeypatch.setattr(FaceShares, "_room", lambda found, moves: (np.full(2, 1e-4), np.array([1.2, 1.0])))
    monkeypatch.setattr(faces, "Union", lambda images: images[1].of)
    assert abs(lift(tmp_path, "", ROUND)[1] - 0.75) > 0.01


@pytest.mark.parametrize("spin", [0.0, 4.0])
def test_a_box_goes_through_a_border_with_its_stream(spin, tmp_path):
    simulation = start(draft(tmp_path, CARRIED.replace("SPIN", f"{spin:g}")))
    bodies, box = simulation.engine.of("bodies").bodies, 1200.0 * 0.12**2
    while simulation.time < 0.3:
        simulation.step(0.3)
    _, v, _, m, _ = leading(simulation)
    assert abs(bodies.velocity[0, 0] - 2.0) < 0.01
    assert abs(bodies.velocity[0, 1]) < 0.01 + 0.01 * spin
    whole = (m[:, None] * v).sum(axis=0) + box * bodies.velocity[0, :2]
    assert whole[0] == pytest.approx(2.0 * (m.sum() + box), rel=2e-3)


def driven(folder):
    """The paddle and the float."""
    return draft(folder, DRIVEN)


@pytest.mark.mpi(min_size=2)
def test_same_bits_with_a_paddle_and_a_float(mpi_tmp_path):
    case = together(mpi_tmp_path, driven)
    many, single = (steps(case, comm, 240) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    assert single.engine.of("refine").counts[1, levels.BORN] > 0
    (rows, *_), (alone, *_) = state(many), state(single)
    assert np.array_equal(rows, alone)
    assert many.engine.of("bodies").state() == single.engine.of("bodies").state()


def turning(folder):
    """The box, turning, in the middle of its stream, where ranks meet, and a border along that."""
    text = CARRIED.replace("SPIN", "4.0").replace("[0.32, 0.24]", "[0.54, 0.24]")
    text = text.replace("[0.44, 0.36]", "[0.66, 0.36]")
    return draft(folder, text.replace("[0.6, 0.0], upper = [1.2", "[-0.1, 0.3], upper = [1.3"))


@pytest.mark.mpi(min_size=2)
def test_same_bits_where_a_body_turns_at_a_border_between_ranks(mpi_tmp_path):
    """What ranks know of each other's shares has to be of the same lists: until 29 November it was of those
    before."""
    case = together(mpi_tmp_path, turning)
    many, single = (steps(case, comm, 60) for comm in (MPI.COMM_WORLD, MPI.COMM_SELF))
    assert single.domain.rebuilds > 2
    (rows, *_), (alone, *_) = state(many), state(single)
    assert np.array_equal(rows, alone)
    assert many.engine.of("bodies").state() == single.engine.of("bodies").state()


@pytest.mark.mpi(min_size=2)
def test_a_paddle_and_a_float_go_on_on_one_rank(mpi_tmp_path):
    case = together(mpi_tmp_path, driven)
    simulation = steps(case, MPI.COMM_WORLD, 45)
    written = keep(simulation, case, mpi_tmp_path)
    MPI.COMM_WORLD.Barrier()
    go_on_alike(simulation, taken_up(case, written, MPI.COMM_SELF), 80)


def test_who_moves_is_there_on_every_level_that_it_may_touch(tmp_path):
    scene = Scene(draft(tmp_path, DRIVEN))
    names = [one.name for one in scene.species]
    there = {names[number] for number in scene.layout.placed}
    assert {"tank (level 1)", "float (level 1)", "paddle (level 1)"} <= there
    far = Scene(
        draft(
            tmp_path,
            DRIVEN.replace(
                "lower = [0.4, 0.0], upper = [1.2, 0.6]", "lower = [0.8, 0.0], upper = [1.2, 0.6]"
            ),
        )
    )
    assert "paddle (level 1)" not in {names[number] for number in far.layout.placed}


@pytest.mark.parametrize(
    "key, says",
    [
        ('walls.block.condition="repulsive"', "it counts on one spacing"),
    ],
)
def test_what_does_not_work_with_levels_is_refused(key, says, tmp_path):
    text = BOX.replace("LOWER", "0.8")
    [line] = refusal(tmp_path, text[: text.index("[gauges")], key)
    assert says in line


SENSED = """
time.end = 0.05
[space]
dimensions = 2
spacing = 0.04
refine = [{ shape.box = { lower = [-0.2, -0.2], upper = [REACHED] } }]
[physics]
gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.6, 0.8] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [1.8, 1.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.6, 1.0] } }]
[gauges.side.sensor]
position = [0.0, 0.3]
axis = "x"
diameter = 0.12
[gauges.floor.sensor]
position = [0.8, 0.0]
axis = "y"
diameter = 0.12
"""
"""Still water on sensors in a side and the floor."""


def sensed(folder, reached):
    """What the sensors read, over ρg times their depths, with a finer part that has ``reached`` so far."""
    simulation = start(draft(folder, SENSED.replace("REACHED", reached)))
    while simulation.time < 0.05:
        simulation.step(0.05)
    side, floor = (one.row(simulation)[0] for one in gauges_of(Scene(simulation_case(folder))).values())
    return side / (9810.0 * 0.5), floor / (9810.0 * 0.8)


@pytest.mark.parametrize(
    "reached, side, floor",
    [("1.8, 1.0", 0.015, 0.015), ("0.6, 0.3", 0.025, 0.015), ("0.78, 1.0", 0.015, 0.045)],
)
def test_sensors_read_still_water_in_finer_and_coarse_water_and_across_borders(
    reached, side, floor, tmp_path
):
    on_side, on_floor = sensed(tmp_path, reached)
    assert abs(on_side - 1.0) < side and abs(on_floor - 1.0) < floor


def test_a_sensor_of_which_all_levels_have_all_reads_too_much(tmp_path, monkeypatch):
    """The control."""
    monkeypatch.setattr(FaceShares, "tell", everyone)
    assert min(sensed(tmp_path, "1.8, 1.0")) > 1.5
