"""What is rigid stands where its pose has it, moves as its pose says, and is told to the step and the lists."""

import numpy as np
import pytest
from guests.rolling import Rolling
from guests.test_guests import begin, case  # noqa: F401 (a fixture)

from psph.physics.rigid.pose import Pose, maps, rotation
from psph.simulation.poses import Poses

SKEW = np.array([1.0, 2.0, -2.0]) / 3.0
POSE = Pose(
    reference=(0.3, -0.2, 0.5),
    translation=(1.0, 0.4, -0.7),
    rotation=rotation(tuple(SKEW), 0.8),
    velocity=(0.5, -1.5, 0.25),
    angular_velocity=(0.7, -0.4, 1.1),
    acceleration=(-2.0, 0.6, 3.0),
    angular_acceleration=(0.2, 0.9, -1.3),
)
POINT = (0.9, 0.1, -0.4)


def test_maps_are_the_pose():
    found = maps(POSE, 3)
    for one, told in zip(found, (POSE.place(POINT), POSE.velocity_of(POINT), POSE.acceleration_of(POINT))):
        assert one[:, 0] + one[:, 1:] @ POINT == pytest.approx(told, rel=1e-14)
    r = np.array(POSE.place(POINT)) - POSE.translation
    w = np.array(POSE.angular_velocity)
    assert POSE.velocity_of(POINT) == pytest.approx(POSE.velocity + np.cross(w, r))
    whirl = np.cross(POSE.angular_acceleration, r) + np.cross(w, np.cross(w, r))
    assert POSE.acceleration_of(POINT) == pytest.approx(POSE.acceleration + whirl)


def test_a_rotation_turns_about_its_axis_and_keeps_lengths():
    turn = np.reshape(POSE.rotation, (3, 3))
    assert turn @ SKEW == pytest.approx(SKEW, rel=1e-15)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15) and np.linalg.det(turn) == pytest.approx(1.0)
    assert np.trace(turn) == pytest.approx(1.0 + 2.0 * np.cos(0.8))


def test_particles_stand_where_the_pose_has_them_and_move_so(case):  # noqa: F811
    simulation = begin(case("rolling"))
    motion = Rolling(0.4, 10.0, (1.5, 0.9))
    for _ in range(7):
        simulation.step()
    store, pose = simulation.store, motion.pose(simulation.time)
    own = store.shown("group") == 1
    anchors = np.column_stack([store.shown("anchor"), np.zeros(store.owned)])[own]
    for name, told in (("position", pose.place), ("velocity", pose.velocity_of)):
        wanted = np.array([told(tuple(anchor)) for anchor in anchors.tolist()])[:, :2]
        assert store.shown(name)[own] == pytest.approx(wanted, rel=1e-13, abs=1e-14)
    rates = np.linalg.norm([pose.acceleration_of(tuple(anchor)) for anchor in anchors.tolist()], axis=1)
    speeds = np.linalg.norm(store.shown("velocity")[own], axis=1)
    assert simulation.speed == pytest.approx(max(speeds.max(), simulation.fluid_speed), rel=1e-12)
    assert simulation.acceleration >= rates.max() * (1.0 - 1e-12) > 100.0


class Jump:
    """At rest before, at 3 m/s from 1 s on."""

    def pose(self, time):
        """The pose at a time, s."""
        moving = time >= 1.0
        return Pose(translation=(3.0 * max(time - 1.0, 0.0), 0.0, 0.0), velocity=(3.0 * moving, 0.0, 0.0))


def test_a_jump_of_the_velocity_is_told_before_the_step_that_it_happens_in():
    poses = Poses([Jump()], np.zeros((1, 4, 2)), None, (0.0, 0.0))
    poses.turn_to(0.9)
    assert poses.advance(0.95, 0.05) == 0.0
    assert poses.advance(1.05, 0.1) == pytest.approx(3.0 / 0.1)
    assert poses.advance(1.06, 0.01) == pytest.approx(0.0, abs=1e-10)
    assert Poses([], np.zeros((0, 4, 2)), None, (0.0, 0.0)).maps is None
