"""Poses of every part of a motion: velocity and acceleration against finite differences, and exact places."""

import math

import numpy as np
import pytest

from psph.physics.rigid.laws import Accelerated, Sinusoidal, SteadyRate, Tabulated
from psph.physics.rigid.motion import MotionPart, Rigid
from psph.physics.rigid.pose import ZERO, inertia
from psph.physics.rigid.schedule import ActingTime

SKEW = (1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0)
AWAY = (0.3, -0.2, 0.7)
ALWAYS, RAMPED, ONCE = ActingTime(), ActingTime(0.2, 1.9, 0.5), ActingTime(0.2, 1.9)
TIMES = np.linspace(0.0, 2.0, 9)
TABLE = np.column_stack([np.sin(TIMES), TIMES**2, np.cos(3.0 * TIMES) - 1.0, 0.4 * np.sin(2.0 * TIMES)])
LAWS = {
    "translation": SteadyRate((0.5, -0.3, 0.2, 0.0)),
    "rotation": SteadyRate((0.0, 0.0, 0.0, 1.7)),
    "acceleration": Accelerated((0.5, -1.0, 0.3, 0.0)),
    "sinusoid": Sinusoidal((0.2, 0.1, -0.3, 0.0), 4.0, 0.6),
    "swing": Sinusoidal((0.0, 0.0, 0.0, 0.5), 4.0, 0.6),
    "series": Tabulated(TIMES, TABLE),
}
POINT = (0.9, 0.1, -0.4)
STEP = 2e-6
MOMENTS = (0.1, 0.35, 0.699, 0.9, 1.35, 1.6, 1.95)


def agree(motion, time):
    """The velocity and acceleration of a point are the slopes of its place and velocity."""
    before, now, after = (motion.pose(t) for t in (time - STEP, time, time + STEP))
    for value, slope in (("place", "velocity_of"), ("velocity_of", "acceleration_of")):
        ends = [np.array(getattr(pose, value)(POINT)) for pose in (before, after)]
        told = getattr(now, slope)(POINT)
        assert told == pytest.approx((ends[1] - ends[0]) / (2.0 * STEP), abs=2e-8), (value, time)


@pytest.mark.parametrize("schedule", [ALWAYS, RAMPED, ONCE])
@pytest.mark.parametrize("name", LAWS)
def test_every_part_has_the_slopes_that_it_says(name, schedule):
    part = MotionPart(LAWS[name], schedule, AWAY, SKEW)
    for time in MOMENTS:
        agree(part, time)
    assert part.pose(0.0).place(POINT) == pytest.approx(POINT, abs=1e-15)  # it begins where the wall stands


@pytest.mark.parametrize("first", LAWS)
@pytest.mark.parametrize("second", LAWS)
def test_compositions_have_the_slopes_that_they_say(first, second):
    motion = Rigid(
        (
            MotionPart(LAWS[first], RAMPED, AWAY, SKEW),
            MotionPart(LAWS[second], ALWAYS, ZERO),
            MotionPart(LAWS["swing"]),
        )
    )
    for time in MOMENTS:
        agree(motion, time)


def test_a_ramp_leaves_speed_and_acceleration_without_a_jump():
    for law in LAWS.values():
        part = MotionPart(law, RAMPED, AWAY, SKEW)
        for moment in (RAMPED.start, RAMPED.start + RAMPED.ramp, RAMPED.end - RAMPED.ramp, RAMPED.end):
            before, after = (part.pose(moment + way) for way in (-1e-9, 1e-9))
            assert before.velocity_of(POINT) == pytest.approx(after.velocity_of(POINT), abs=1e-7)
            assert before.acceleration_of(POINT) == pytest.approx(after.acceleration_of(POINT), abs=1e-5)


def test_places_are_what_formulas_say():
    def moved(law, schedule, time):
        return MotionPart(law, schedule).pose(time).translation[0]

    assert moved(LAWS["translation"], ONCE, 1.0) == pytest.approx(0.5 * 0.8)
    assert moved(LAWS["translation"], RAMPED, 5.0) == pytest.approx(0.5 * (1.7 - 0.5))  # a ramp less
    assert moved(LAWS["acceleration"], ALWAYS, 2.0) == pytest.approx(0.25 * 4.0)
    assert moved(LAWS["acceleration"], ONCE, 2.9) == pytest.approx(0.25 * 1.7**2 + 0.5 * 1.7 * 1.0)
    assert moved(LAWS["sinusoid"], ALWAYS, 1.0) == pytest.approx(0.2 * (math.sin(4.6) - math.sin(0.6)))
    assert moved(LAWS["sinusoid"], RAMPED, 1.0) == pytest.approx(0.2 * math.sin(4.0 * 0.8 + 0.6))
    assert moved(LAWS["sinusoid"], RAMPED, 2.0) == 0.0  # it has faded
    for time, row in zip(TIMES, TABLE):
        assert MotionPart(LAWS["series"]).pose(time).translation == pytest.approx(row[:3], abs=1e-15)
    after = MotionPart(LAWS["series"]).pose(7.0)
    assert after.translation == pytest.approx(TABLE[-1, :3]) and after.velocity == ZERO


def test_a_part_moves_what_the_parts_before_it_have_made():
    """A wheel that turns about its hub and travels: the hub as drawn, whatever the wheel has travelled."""
    turn = MotionPart(SteadyRate((0.0, 0.0, 0.0, 0.5 * math.pi)), ALWAYS, (1.0, 0.0, 0.0))
    travel = MotionPart(SteadyRate((3.0, 0.0, 0.0, 0.0)))
    rolling, orbiting = Rigid((turn, travel)).pose(1.0), Rigid((travel, turn)).pose(1.0)
    assert rolling.place((2.0, 0.0, 0.0)) == pytest.approx((4.0, 1.0, 0.0))
    assert orbiting.place((2.0, 0.0, 0.0)) == pytest.approx((1.0, 4.0, 0.0), abs=1e-15)


def test_inertia_is_what_a_point_at_rest_in_space_seems_to_feel():
    """A point that gravity alone pulls, told in a frame that moves: its path there against differences."""
    gravity = (0.5, -9.8, 1.0)
    frame = Rigid((MotionPart(LAWS["swing"], RAMPED, AWAY, SKEW), MotionPart(LAWS["sinusoid"], RAMPED)))

    def seen(time):
        pose = frame.pose(time)
        free = np.array(POINT) + 0.3 * time * np.ones(3) + 0.5 * np.array(gravity) * time**2
        turn = np.reshape(pose.rotation, (3, 3))
        return turn.T @ (free - pose.translation) + pose.reference

    for time in MOMENTS:
        step = 1e-4
        before, now, after = (seen(time + way) for way in (-step, 0.0, step))
        by_place, by_velocity = inertia(frame.pose(time), gravity, 3)
        v = (after - before) / (2.0 * step)
        told = by_place[:, 0] + by_place[:, 1:] @ now + by_velocity[:, 1:] @ v + gravity
        assert told == pytest.approx((after - 2.0 * now + before) / step**2, abs=1e-5)
