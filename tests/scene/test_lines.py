"""Lines of bodies: what cannot be is refused in one line, and what `explain` and `check` say of them."""

import math

import pytest
from drafts import draft, refusal
from gauging import start

from psph.runs.explain import explain
from psph.scene import Scene, check
from psph.scene.lines import line_warnings, lines_of

MOORED = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.gravity = [0.0, -10.0]
physics.sound_speed = 30.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.5] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [2.2, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 0.8] } }]
[bodies.raft]
shape.box = { lower = [0.8, 0.4], upper = [1.2, 0.6] }
density = 500.0
[bodies.raft.lines.port]
at = [0.8, 0.4]
anchor = [0.0, 0.0]
length = 1.0
chain = { mass = 1.0, diameter = 0.01, axial_stiffness = 1.0e4, bed.at = [0.0, 0.0] }
"""
PORT, CHAIN = "bodies.raft.lines.port.", "bodies.raft.lines.port.chain."

WRONG = {
    f"{PORT}to='tonk'": ('lines.port.to: "tonk"', "did you mean 'tank'"),
    f"{PORT}pretension=30.0": ("lines.port.pretension: 30.0", "remove one of the two"),
    f"{PORT}stiffness=30.0": ("lines.port", "give either stiffness, of a spring, or chain"),
    f"{PORT}damping=3.0": ("lines.port.damping", "a chain has chain.damping_ratio"),
    f"{PORT}pulls_only=true": ("lines.port.pulls_only", "never pushes"),
    f"{PORT}length=0.0": ("lines.port.length", "give more"),
    f"{PORT}break_load=2.0": ("lines.port.break_load: 2 N, and it is pulled with more", "give more"),
    f"{PORT}at=[0.7, 0.4]": ("lines.port.at: lies 0.1 m off raft", "move it there"),
    f"{PORT}anchor=[0.0, -0.1]": ("lines.port.anchor: is 0.1 m below chain.bed", "move it up"),
    f"{CHAIN}bed.at=[0.0, 0.45]": ("lines.port.at: is 0.05 m below chain.bed", "move it up"),
    f"{CHAIN}bed.normal=[0.0, 0.0]": ("chain.bed.normal", "has no direction"),
    f"{CHAIN}mass=-1.0": ("lines.port.chain.mass", "-1"),
    f"{CHAIN}pieces=1": ("lines.port.chain.pieces", "2"),
    f"{CHAIN}bed.friction=-0.1": ("lines.port.chain.bed.friction", "-0.1"),
}


@pytest.mark.parametrize("override", WRONG)
def test_a_line_that_cannot_be_is_refused_in_one_line(tmp_path, override):
    text = MOORED.replace("length = 1.0\n", "") if "length=0.0" in override else MOORED

    def told():
        try:
            check(Scene(draft(tmp_path, text, override)))
        except ValueError as error:
            return str(error).splitlines()
        return []

    lines = told()
    assert any(all(says in line for says in WRONG[override]) for line in lines), lines


def test_what_no_length_bears_is_told_with_the_least(tmp_path):
    text = MOORED.replace("length = 1.0", "pretension = 3.0")
    with pytest.raises(
        ValueError, match=r"port\.pretension: 3 N, but its weight pulls with 3\.\d+ N at least"
    ):
        check(Scene(draft(tmp_path, text)))
    spring = MOORED.replace("length = 1.0", "pretension = 30.0").replace("chain = {", "stiffness = 20.0 #")
    with pytest.raises(
        ValueError, match="all of it is stretch at 17.89 N; give less, or a greater stiffness"
    ):
        check(Scene(draft(tmp_path, spring)))


def test_a_pretension_is_that_at_the_start(tmp_path):
    for text in (MOORED, MOORED.replace("chain = {", "stiffness = 100.0 #")):
        simulation = start(draft(tmp_path, text.replace("length = 1.0", "pretension = 30.0")))
        assert simulation.engine.of("bodies").lines.tensions[0] == pytest.approx(30.0, rel=1e-9)


def test_check_warns_of_a_line_that_is_far_too_short_or_stiff(tmp_path):
    stiff = check(Scene(draft(tmp_path, MOORED, f"{CHAIN}axial_stiffness=1e11")))
    assert any(
        "port.chain: takes 1.63e+04 steps of its own" in line and "give fewer pieces" in line
        for line in stiff
    ), stiff
    found = [line for line in check(Scene(draft(tmp_path, MOORED, f"{PORT}length=0.7"))) if "port" in line]
    assert len(found) == 1 and "length: 0.7 m, and its ends are 27.8 % farther apart" in found[0]
    assert not [line for line in check(Scene(draft(tmp_path, MOORED))) if "port" in line]


def test_explain_lists_lines_and_periods(tmp_path):
    """A spring along x of 500 N/m under 40 kg, ρgA = 4000 N/m, a slack chain lifted with its weight."""
    spring = """
[bodies.raft.lines.side]
at = [1.2, 0.45]
anchor = [2.0, 0.45]
stiffness = 500.0
"""
    said = list(explain(Scene(draft(tmp_path, MOORED + spring, f"{PORT}length=1.6")), 1))
    [port] = [line for line in said if "raft.port" in line]
    assert "1.6 m in 20 pieces, 9.215 N/m in water" in port and "N at its anchor" in port
    [surge] = [line for line in said if "raft along x" in line]
    [heave] = [line for line in said if "raft along y" in line]
    assert f"period {2.0 * math.pi * math.sqrt(40.0 / 500.0):.3g}" in surge
    assert "9.21 N/m and buoyancy with 4e+03" in heave
    assert f"period {2.0 * math.pi * math.sqrt(40.0 / 4009.2):.3g}" in heave


AIR = "fluids.air={shape={box={lower=[0.0,0.5],upper=[2.0,0.8]}},density=1.2}"
SAND = "soils.sand={shape={box={lower=[0.0,0.0],upper=[2.0,0.3]}},density=1600.0,young=1e6,poisson=0.3,friction_angle=30.0}"


def test_a_chain_hangs_in_the_heaviest_fluid_and_in_no_soil(tmp_path):
    """Whatever fluid its body continues; w = (m − ρπd²/4) g."""
    for keys, density in (
        ((), 1000.0),
        ((AIR,), 1000.0),
        ((AIR, "bodies.raft.continues=air"), 1000.0),
        (("fluids=off", SAND, "physics.sound_speed=off"), 0.0),
    ):
        scene = Scene(draft(tmp_path, MOORED, *keys))
        [line] = lines_of(scene, ["raft"])
        assert line.chain.displaced == pytest.approx(density * 0.25 * math.pi * 0.01**2)
        told = any("hangs in water everywhere; give water_level" in one for one in line_warnings(scene))
        assert told == (AIR in keys)


def test_a_line_holds_to_a_wall_that_moves(tmp_path):
    text = MOORED.replace("density = 500.0", 'density = 500.0\nfree = ["turn_z"]') + "[walls.arm]\n"
    text += "shape.box = { lower = [2.4, 0.9], upper = [2.6, 1.1] }\nmotion.translation = [0.3, 0.1]\n"
    simulation = start(
        draft(tmp_path, text, f"{PORT}to='arm'", f"{PORT}anchor=[2.5, 1.0]", f"{PORT}length=2.0")
    )
    for _ in range(20):
        simulation.step()
    lines = simulation.engine.of("bodies").lines
    place = next(lines.shapes(simulation.engine.of("bodies").bodies, simulation.time)).points[-1]
    assert place[:2] == pytest.approx([2.5 + 0.3 * simulation.time, 1.0 + 0.1 * simulation.time], abs=1e-12)


def test_an_unknown_key_of_a_chain_is_refused(tmp_path):
    assert "did you mean" in refusal(tmp_path, MOORED.replace("diameter", "diametre"))[0]
