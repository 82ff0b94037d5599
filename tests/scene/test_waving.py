"""Paddles of a case: what is refused, and what `explain` and `check` say of their waves."""

import pytest
from drafts import draft, refusal

from psph.case import CaseError
from psph.scene import Scene, check
from psph.scene.waving import wave_lines, wave_warnings

FLUME = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 30.0
physics.gravity = [0.0, -9.81]
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [3.0, 0.3] }
[walls.floor]
shape.box = { lower = [-0.4, -0.06], upper = [3.0, 0.0] }
[walls.paddle]
shape.box = { lower = [-0.06, 0.0], upper = [0.0, 0.4] }
"""
PISTON = "height = 0.1, period = 1.2, depth = 0.3"
FLAP = f"{PISTON}, center = [0.0, 0.0]"


def told(motion, text=FLUME):
    return f"{text}motion = {motion}\n"


REFUSED = {
    "no gravity": (
        told(f"{{ piston = {{ {PISTON} }} }}", FLUME.replace("physics.gravity = [0.0, -9.81]", "")),
        "walls.paddle.motion.piston: waves need gravity down the last axis; give physics.gravity = [0.0, -9.81]",
    ),
    "no depth": (told("{ piston = { height = 0.1, period = 1.2 } }"), "piston.depth: missing; add depth"),
    "a third order": (
        told(f"{{ piston = {{ {PISTON}, order = 3 }} }}"),
        "piston.order: ",
    ),
    "upwards": (
        told(f"{{ piston = {{ {PISTON}, direction = [0.0, 1.0] }} }}"),
        "motion.piston: direction is no horizontal vector",
    ),
    "three numbers": (
        told(f"{{ piston = {{ {PISTON}, direction = [0.0, 1.0, 0.0] }} }}"),
        "motion.piston.direction: [0.0, 1.0, 0.0]: 3 numbers in a case with space.dimensions = 2",
    ),
    "a hinge in the air": (
        told(f"{{ flap = {{ {FLAP}, hinge = 0.3 }} }}"),
        "motion.flap: hinge, 0.3 m, is not below the surface at 0.3 m",
    ),
    "no hinge": (told(f"{{ flap = {{ {PISTON} }} }}"), "flap.center: missing; add center"),
    "a hinge of a piston": (
        told(f"{{ irregular = {{ {PISTON}, hinge = 0.1 }} }}"),
        "motion.irregular: hinge is of a flap, and nothing turns here",
    ),
    "a ramp of a solitary wave": (
        told("{ solitary = { height = 0.1, depth = 0.3 }, ramp = 1.0 }"),
        "motion.solitary: begins and ends by itself; remove ramp and end",
    ),
    "a frame": (
        told("[0.0]").replace("motion = [0.0]", f"[frame]\nmotion = {{ piston = {{ {PISTON} }} }}"),
        "frame.motion: a paddle makes waves as a wall in its tank; give it to a wall",
    ),
    "a flap that absorbs": (
        told(f"{{ irregular = {{ {FLAP}, absorb = {{}} }} }}"),
        "motion.irregular: a flap does not know how to absorb; remove center for a piston, or absorb",
    ),
    "a memory shorter than a wave": (
        told(f"{{ piston = {{ {PISTON}, absorb = {{ memory = 1.1 }} }} }}"),
        "motion.piston: absorb.memory is shorter than a wave, which it would forget; give five periods",
    ),
    "a paddle that absorbs on something that moves": (
        told(f"[{{ piston = {{ {PISTON}, absorb = {{}} }} }}, {{ translation = [0.1, 0.0] }}]"),
        "walls.paddle.motion[0].piston: moves by what it measures if it is to absorb; let it be the only part",
    ),
    "a body that absorbs": (
        told("0").replace("motion = 0", "")
        + "[bodies.box]\nshape.box = { lower = [1.0, 0.1], upper = [1.2, 0.2] }\ndensity = 500.0\n"
        + f'free = ["y"]\nmotion = {{ piston = {{ {PISTON}, absorb = {{}} }} }}\n',
        "bodies.box.motion: a wall may absorb waves, a body not; remove absorb",
    ),
    "a zone of no length": (
        "physics.damping_zone = { begin = 2.0, end = 2.0 }\n" + FLUME,
        "physics.damping_zone: begins where it ends; give another end",
    ),
    "a zone along z": (
        'physics.damping_zone = { begin = 2.0, end = 3.0, axis = "z" }\n' + FLUME,
        'physics.damping_zone.axis: "z": no axis in 2D; give one of x, y',
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(name, tmp_path):
    text, says = REFUSED[name]
    assert says in "; ".join(refusal(tmp_path, text))


def scene_of(motion, tmp_path):
    return Scene(draft(tmp_path, told(motion)))


def test_a_hinge_in_two_places_is_refused(tmp_path):
    """The water's foot is at 0: a center at 0.1 is a hinge at 0.1, which the shape of the stroke rests on."""
    high = FLAP.replace("center = [0.0, 0.0]", "center = [0.0, 0.1]")
    with pytest.raises(CaseError) as refused:
        check(scene_of(f"{{ flap = {{ {high} }} }}", tmp_path))
    [line] = refused.value.lines
    assert "motion.flap: hinge = 0 m over the bed, and center is 0.1 m over the foot of the water" in line
    check(scene_of(f"{{ flap = {{ {high}, hinge = 0.1 }} }}", tmp_path))
    check(scene_of(f"{{ flap = {{ {FLAP} }} }}", tmp_path))


def test_explain_says_what_the_paddle_makes(tmp_path):
    text = "\n".join(wave_lines(scene_of(f"{{ piston = {{ {PISTON} }} }}", tmp_path)))
    assert "walls.paddle.motion.piston: length 1.77 m, period 1.2 s, depth 0.3 m (kh 1.06)" in text
    assert "H/L 0.0565, HL²/h³ 11.6" in text and "H/h 0.333, H/dx 5" in text
    assert "stroke 0.0961 m at the surface" in text  # 0.1/1.0405
    text = "\n".join(wave_lines(scene_of(f"{{ flap = {{ {FLAP} }} }}", tmp_path)))
    assert "stroke 0.177 m at the surface" in text  # 0.1/0.5641
    text = "\n".join(wave_lines(scene_of("{ solitary = { height = 0.06, depth = 0.3 } }", tmp_path)))
    assert "speed 1.879 m/s, stroke 0.339 m in 3.61 s" in text


def test_explain_says_how_a_paddle_absorbs(tmp_path):
    text = "\n".join(wave_lines(scene_of(f"{{ piston = {{ {PISTON}, absorb = {{}} }} }}", tmp_path)))
    assert "waves that come back: 5.03 m/s for each m that the water at its face is too low" in text
    assert "at most 0.192 m from its stroke; forgets a level in 6 s" in text
    absorb = "absorb = { memory = 4.0, reach = 0.15 }"
    text = "\n".join(
        wave_lines(scene_of(f"{{ solitary = {{ height = 0.06, depth = 0.3, {absorb} }} }}", tmp_path))
    )
    assert "at most 0.15 m from its stroke; forgets a level in 4 s" in text
    assert "come back" not in "\n".join(wave_lines(scene_of(f"{{ piston = {{ {PISTON} }} }}", tmp_path)))


WARNED = {
    "steep": (
        "{ piston = { height = 0.2, period = 0.8, depth = 0.3 } }",
        "is above 0.142 tanh kh = 0.137 (Miche)",
    ),
    "high": ("{ solitary = { height = 0.24, depth = 0.3 } }", "H/h = 0.8 is above 0.78 (McCowan)"),
    "high for its theory": (
        "{ solitary = { height = 0.1, depth = 0.3 } }",
        'is above 0.3, where a wave by rayleigh changes as it runs; give theory = "grimshaw"',
    ),
    "long": (
        "{ piston = { height = 0.1, period = 2.2, depth = 0.3, order = 2 } }",
        "is not below 8π²/3 = 26.3 (Madsen)",
    ),
    "low": (
        "{ piston = { height = 0.099, period = 1.2, depth = 0.3 } }",
        "H/dx = 4.95 is below 5: such waves fade; give space.spacing = 0.0198",
    ),
    "deep": (
        "{ piston = { height = 0.1, period = 1.2, depth = 0.4 } }",
        "depth = 0.4 m, and the fluid is 0.3 m deep before the paddle",
    ),
    "shallow": (
        "{ piston = { height = 0.1, period = 1.2, depth = 0.26 } }",
        "depth = 0.26 m, and the fluid is 0.3 m deep before the paddle",
    ),
    "late": (
        '{ solitary = { height = 0.1, depth = 0.3, theory = "grimshaw" }, start = 30.0 }',
        "the paddle starts at 30 s, and the run ends at 30 s: no wave is made",
    ),
    "far": ("{ piston = { height = 0.1, period = 100.0, depth = 0.3 } }", "the paddle goes"),
}


@pytest.mark.parametrize("name", WARNED)
def test_warnings(name, tmp_path):
    motion, says = WARNED[name]
    found = list(wave_warnings(scene_of(motion, tmp_path)))
    assert [line for line in found if says in line] and len(found) == 1, found


def test_good_waves_warn_of_nothing(tmp_path):
    motion = f"{{ piston = {{ {PISTON}, order = 2 }}, ramp = 1.0 }}"
    scene = scene_of(motion, tmp_path)
    assert not list(wave_warnings(scene))
    assert not [line for line in check(scene) if "paddle.motion.piston" in line]


def test_the_depth_is_that_before_the_paddle(tmp_path):
    """A shelf below the paddle, 0.1 m high: the water over it is 0.2 m deep, farther on 0.3 m."""
    shelf = FLUME.replace(
        "shape.box = { lower = [0.0, 0.0], upper = [3.0, 0.3] }",
        "shape.union = [{ box = { lower = [0.0, 0.1], upper = [3.0, 0.3] } }, "
        "{ box = { lower = [1.0, 0.0], upper = [3.0, 0.3] } }]",
    )
    assert shelf != FLUME

    def warned(depth):
        motion = f"{{ piston = {{ height = 0.1, period = 1.2, depth = {depth} }} }}"
        return list(wave_warnings(Scene(draft(tmp_path, told(motion, shelf)))))

    assert warned(0.2) == []
    [line] = warned(0.3)
    assert "depth = 0.3 m, and the fluid is 0.2 m deep before the paddle" in line


@pytest.mark.parametrize("begin, said", [(0.5, 0), (1.0, 0), (9.0, 1), (-2.0, 1)])
def test_a_zone_that_begins_off_the_fluid_is_warned_of(tmp_path, begin, said):
    text = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, -9.81]
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
walls.bed.shape.box = { lower = [0.0, -0.3], upper = [1.0, 0.0] }
physics.damping_zone = { begin = 0.0, end = 1.0 }
"""
    if begin == 1.0:
        text = text.replace("end = 1.0 }", "end = 0.0 }")
    warned = check(Scene(draft(tmp_path, text, f"physics.damping_zone.begin={begin}")))
    lines = [line for line in warned if "damping_zone" in line]
    assert len(lines) == said
    says = f"physics.damping_zone.begin: {begin:g} m, and fluid stands from 0 to 1 m along x"
    assert all(says in line for line in lines)
