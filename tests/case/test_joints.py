"""Joints of a case: what cannot be is refused in one line."""

import pytest
from drafts import draft, refusal
from gauging import readings, started

from psph.scene import Scene
from psph.scene.joints import joint_words

ARM = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.gravity = [0.0, -9.8]
physics.sound_speed = 30.0
[fluids.water]
shape.box = { lower = [0.0, -1.0], upper = [0.3, -0.8] }
[walls.floor]
shape.box = { lower = [0.0, -1.2], upper = [0.3, -1.0] }
[bodies.upper]
shape.box = { lower = [0.5, 0.3], upper = [1.0, 0.5] }
density = 1300.0
[bodies.lower]
shape.box = { lower = [1.0, 0.3], upper = [1.5, 0.5] }
density = 700.0
[joints.shoulder]
of = ["upper"]
hinge = { at = [0.5, 0.4] }
[joints.elbow]
of = ["lower", "upper"]
fixed = {}
[gauges.shoulder.joint]
of = "shoulder"
"""

WRONG = {
    "no body": ('of = ["upper"]', 'of = ["uper"]', "joints.shoulder.of[0]", "did you mean 'upper'"),
    "no other": ('["lower", "upper"]', '["lower", "roof"]', "joints.elbow.of[1]", "no body or wall"),
    "itself": ('["lower", "upper"]', '["lower", "lower"]', "joints.elbow.of", "name two"),
    "a paddle": (
        'of = ["lower", "upper"]\nfixed = {}',
        'of = ["lower", "floor"]\nfixed = {}\n[walls.floor.motion.piston]\nheight = 0.05\nperiod = 1.0\ndepth = 0.5\n'
        "absorb = {}",
        "joints.elbow.of[1]",
        "absorbs waves and holds no line and no joint",
    ),
    "two kinds": ("fixed = {}", "fixed = {}\nball = { at = [1.0, 0.4] }", "joints.elbow", "ball and fixed"),
    "no kind": ("fixed = {}", "", "joints.elbow", "give one of hinge, slider, ball, fixed, rod"),
    "an axis": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], axis = [0.0, 1.0]",
        "joints.shoulder.hinge",
        "turn about z",
    ),
    "no rod": (
        "fixed = {}",
        "rod = { at = [1.0, 0.4], anchor = [1.0, 0.4] }",
        "joints.elbow.rod.anchor",
        "is where the rod begins",
    ),
    "no way": ("fixed = {}", "slider = { along = [0.0, 0.0] }", "joints.elbow.slider.along", "no direction"),
    "limits": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], limits = [10.0, 20.0]",
        "joints.shoulder.hinge.limits",
        "0",
    ),
    "a rest": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], rest = 5.0",
        "joints.shoulder.hinge.rest",
        "there is no spring",
    ),
    "a latch": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], latch = true",
        "joints.shoulder.hinge.latch",
        "needs limits",
    ),
    "bounces": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], restitution = 0.5",
        "joints.shoulder.hinge.restitution",
        "needs limits",
    ),
    "bounces and latches": (
        "at = [0.5, 0.4]",
        "at = [0.5, 0.4], limits = [-9.0, 9.0], latch = true, restitution = 0.5",
        "joints.shoulder.hinge.restitution",
        "does not bounce",
    ),
    "a gauge": ('of = "shoulder"', 'of = "sholder"', "gauges.shoulder.joint.of", "did you mean 'shoulder'"),
}


@pytest.mark.parametrize("was, now, where, says", WRONG.values(), ids=WRONG)
def test_a_joint_that_cannot_be_is_refused(was, now, where, says, tmp_path):
    assert was in ARM
    lines = refusal(tmp_path, ARM.replace(was, now))
    assert any(where in line and says in line for line in lines), lines


def test_a_joint_is_told_with_its_numbers(tmp_path):
    text = ARM.replace(
        "at = [0.5, 0.4]", "at = [0.5, 0.4], limits = [-9.0, 9.0], latch = true, damping = 2.0"
    )
    [line, *_] = joint_words(Scene(draft(tmp_path, text)))
    assert line.endswith(", at [0.5, 0.4], limits [-9, 9], latch true, damping 2.0")
    [line, *_] = joint_words(Scene(draft(tmp_path, ARM)))
    assert line.endswith(", at [0.5, 0.4]")


def test_a_joint_with_a_mirror_stays_where_it_is(tmp_path):
    """A mirror has no particles; it stands still."""
    text = ARM.replace('of = ["upper"]', 'of = ["upper", "floor"]').replace(
        "[walls.floor]", '[walls.floor]\ncondition = "mirror"'
    )
    simulation, _ = started(draft(tmp_path, text), 2)
    assert simulation.engine.of("bodies").joints.widest()[0] < 1e-12


def test_a_hinge_bears_what_hangs_on_it(tmp_path):
    """At the first moment of a fall from level: of a uniform rod a quarter of its weight, here of two densities by
    R = M g (1 − M c²/I), about the hinge."""
    simulation, scene = started(draft(tmp_path, ARM), 3)
    bodies = simulation.engine.of("bodies").bodies
    mass, arm = bodies.mass[:, 0], bodies.centre[:, 0] - 0.5
    about = [bodies.inertia[k, 2, 2] + mass[k] * arm[k] ** 2 for k in (0, 1)]
    whole, centre = mass.sum(), (mass * arm).sum() / mass.sum()
    expected = whole * 9.8 * (1.0 - whole * centre**2 / sum(about))
    assert readings(simulation, scene)["shoulder.force_y"] == pytest.approx(expected, rel=1e-3)
