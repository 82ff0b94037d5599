"""What the supports of solids bear: clamps hold a bar, an anvil a block that is pressed on it."""

import pytest
from drafts import draft, refusal
from gauging import readings, started

BAR = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.05 }
physics.gravity = [0.0, -10.0]
[solids.bar]
shape.box = { lower = [-0.2, 0.0], upper = [0.6, 0.2] }
density = 1200.0
young = 1e5
poisson = 0.3
damping = 200.0
[solids.bar.clamps.left]
shape.box = { lower = [-0.2, 0.0], upper = [0.0, 0.2] }
[solids.bar.clamps.right]
shape.box = { lower = [0.4, 0.0], upper = [0.6, 0.2] }
[solids.bar.loads.middle]
shape.box = { lower = [0.1, 0.0], upper = [0.3, 0.2] }
force = [7.0, -50.0]
[gauges.left.reaction]
of = ["solids.bar.clamps.left"]
[gauges.right.reaction]
of = ["solids.bar.clamps.right"]
[gauges.both.reaction]
of = ["solids.bar.clamps.left", "solids.bar.clamps.right"]
about = [0.2, 0.3]
"""
"""A bar between two clamps, its weight and a load: 0.8 by 0.2 m."""

BLOCK = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.05 }
[solids.block]
shape.box = { lower = [0.0, 0.0], upper = [0.4, 0.2] }
density = 1000.0
young = 1e5
poisson = 0.0
damping = 400.0
[solids.block.loads.push]
shape.box = { lower = [0.0, 0.15], upper = [0.4, 0.2] }
force = [0.0, -300.0]
[anvils.floor]
at = [0.0, 0.0]
normal = [0.0, 2.0]
[anvils.far]
at = [0.0, -1.0]
normal = [0.0, 1.0]
[gauges.floor.reaction]
of = ["anvils.floor"]
[gauges.far.reaction]
of = ["anvils.far"]
"""

WEIGHT = 0.8 * 0.2 * 1200.0 * 10.0


def settled(path, text, steps, *sets):
    return readings(*started(draft(path, text, *sets), steps))


def test_clamps_bear_the_weight_of_a_bar_and_its_load(tmp_path):
    found = settled(tmp_path, BAR, 3000)
    assert found["both.reaction_x"] == pytest.approx(7.0, abs=0.01 * WEIGHT)
    assert found["both.reaction_y"] == pytest.approx(-WEIGHT - 50.0, rel=1e-3)
    assert found["both.reaction_moment_z"] == pytest.approx(7.0 * 0.2, abs=1e-3 * WEIGHT)
    for axis in "xy":
        parts = found[f"left.reaction_{axis}"] + found[f"right.reaction_{axis}"]
        assert found[f"both.reaction_{axis}"] == pytest.approx(parts, rel=1e-12, abs=1e-9)


def test_moments_do_not_jump_where_clamps_cross_a_seam(tmp_path):
    """A bar under way, with the domain ending before it and without an end."""
    on_way = "{translation={velocity=[2.0,0.0]}}"
    sets = (
        *(f"solids.bar.clamps.{end}.motion={on_way}" for end in ("left", "right")),
        "solids.bar.velocity=[2.0,0.0]",
        "solids.bar.loads=off",
    )
    seam = ("space.periodic=['x']", "space.lower=[-0.25,-0.5]", "space.upper=[0.75,0.5]")
    found, whole = settled(tmp_path, BAR, 200, *sets, *seam), settled(tmp_path, BAR, 200, *sets)
    assert found == pytest.approx(whole, rel=1e-6, abs=1e-6)


def test_an_anvil_bears_what_presses_a_block_on_it(tmp_path):
    found = settled(tmp_path, BLOCK, 3000)
    assert found["floor.reaction_y"] == pytest.approx(-300.0, rel=5e-3)
    assert found["floor.reaction_moment_z"] == pytest.approx(-300.0 * 0.2, rel=5e-3)
    assert found["floor.reaction_x"] == 0.0 and found["far.reaction_y"] == 0.0


def test_a_clamp_that_moves_bears_no_inertia_of_its_own(tmp_path):
    """A clamp around the whole bar, hurried along and turned: no more than its weight is borne."""
    moves = "{acceleration=[3.0,1.0]}"
    sets = (
        f"solids.bar.clamps.left.motion={moves}",
        "solids.bar.clamps.left.shape.box.upper=[0.6,0.2]",
        "solids.bar.clamps.right=off",
        "solids.bar.loads=off",
        "gauges.right=off",
        "gauges.both=off",
    )
    found = settled(tmp_path, BAR, 3, *sets)
    mass = WEIGHT / 10.0
    assert found["left.reaction_x"] == pytest.approx(-3.0 * mass)
    assert found["left.reaction_y"] == pytest.approx(-11.0 * mass)


@pytest.mark.parametrize(
    ("key", "says"),
    [
        ("solids.bar.clamps.lift", "no clamp or anvil has this key; did you mean 'solids.bar.clamps.left'?"),
        ("bar", "no clamp or anvil has this key"),
    ],
)
def test_a_support_that_is_not_there_is_refused(tmp_path, key, says):
    [line] = refusal(tmp_path, BAR, f"gauges.left.reaction.of=['{key}']")
    assert "gauges.left.reaction.of" in line and says in line
