"""What `explain` and `check` say of rheologies."""

import pytest
from drafts import CHANNEL, TANK, draft
from scene.test_units import checked

from psph.runs.explain import explain
from psph.scene import Scene

MUD = "fluids.water.rheology.bingham={yield_stress=%r, plastic_viscosity=1.0, largest_viscosity=%r}"
CONSTANT = "fluids.water.viscosity=0.0"


def said(folder, text, *overrides):
    """The lines of `explain` on the rheologies."""
    lines = list(explain(Scene(draft(folder, text, *overrides)), 1))
    heads = [n for n, line in enumerate(lines) if line == "Viscosities that depend on the rate of strain"]
    if not heads:
        return []
    found = []
    for line in lines[heads[0] + 1 :]:
        if not line.startswith("  ") or line.startswith("  expected"):
            break
        found.append(line.strip())
    return found


def test_explain_tells_yield_plug_bingham_number_creep_and_cost(tmp_path):
    """A tank of 0.5 m of mud that weighs 9800 Pa/m: 4900 Pa, of which 4890 Pa shear 1 Pa s."""
    head, *rest = said(tmp_path, TANK, MUD % (10.0, 2e5))
    assert head.startswith("fluids.water: bingham, at most 2e+05 Pa s: steps ")
    assert head.endswith(" times shorter than sound allows")
    assert rest == [
        "yield stress 10 Pa: a layer under 0.00102 m stands, even upright; between plates the plug is twice "
        "that",
        "Bingham number 0.002 at 4.89e+03 1/s, the most that moves it",
        "creeps below the yield at up to 5e-05 1/s, 1e-08 of that",
    ]
    assert said(tmp_path, TANK, MUD % (10.0, 100.0))[0].endswith("no shorter steps")
    assert said(tmp_path, TANK) == []


def test_explain_says_where_nothing_flows(tmp_path):
    *_, line, creep = said(tmp_path, TANK, MUD % (5000.0, 2e4))
    assert line == "does not flow: weight over 0.5 m brings about 4.9e+03 Pa at most"
    assert creep == "creeps under that at up to 0.98 1/s"  # −ln(1 − 0.98)/4 s


def test_a_cap_by_which_standing_mud_creeps_is_warned_of(tmp_path):
    """4900 Pa under 1e5 Pa: −ln(1 − 0.049) 1e5/1e5 = 0.0502 1/s, a strain of 0.1 in 2 s; the advice is quiet."""
    [line] = checked(tmp_path, TANK, MUD % (1e5, 2e4))
    assert line.endswith(
        "it is to stand, but its largest viscosity, 2e+04 Pa s, hides the yield: it creeps by a strain of 0.5 until time.end; "
        "give largest_viscosity = 1e+05 or more"
    )
    assert checked(tmp_path, TANK, MUD % (1e5, 1.01e5)) == []


def test_a_cap_that_hides_the_yield_is_warned_of(tmp_path):
    """1/20 of the 4400 1/s that 4900 Pa shear above 500 Pa: 500 Pa over 220 1/s is 2.3 Pa s."""
    [line] = checked(tmp_path, TANK, MUD % (500.0, 2.0))
    assert line == (
        "fluids.water.rheology: the largest viscosity, 2 Pa s, hides the yield: below that the fluid creeps "
        "at 2.5e+02 1/s, 0.057 of the rate of its flow; give largest_viscosity = 2.3 or more"
    )
    assert checked(tmp_path, TANK, MUD % (500.0, 2.3)) == []


SLOPE = CHANNEL.replace("upper = [1.0, 1.0] } }]", "upper = [1.0, 1.2] } }]")
"""The channel without its lid: a layer 1 m thick on a slope, 100 Pa/m along it."""


@pytest.mark.parametrize(("text", "stress"), [(SLOPE, 100.0), (CHANNEL, 50.0)])
@pytest.mark.parametrize("across", [0.0, -9.8])
def test_the_cap_advised_is_that_of_the_stress_along_the_slope_or_the_channel(tmp_path, text, stress, across):
    """With 1 Pa s, 40 Pa of yield: (stress − 40) 1/s at the plates, of which a creep of 1/20 is allowed."""
    tilted = f"physics.gravity=[0.1, {across}]"
    quiet, hidden = 0.05 * (stress - 40.0) / 0.999, 0.05 * (stress - 40.0) / 0.9
    told = {}
    for creep in (quiet * 0.99, hidden * 1.01):
        lines = checked(
            tmp_path, text, CONSTANT, MUD % (40.0, 40.0 / creep), tilted, "physics.sound_speed=99.0"
        )
        told[creep] = [line for line in lines if "hides the yield" in line]
    assert list(map(len, told.values())) == [0, 1]
    [line] = told[hidden * 1.01]
    assert line.endswith(f"give largest_viscosity = {40.0 / (0.05 * (stress - 40.0)):.2g} or more")


GRAINS = """
space = { dimensions = 2, spacing = 0.001, periodic = ["x"], lower = [0.0, -0.003], upper = [0.01, 0.03] }
time.end = 0.5
physics.gravity = [%r, -9.0]
[fluids.grains]
shape.box = { lower = [0.0, 0.0], upper = [0.01, 0.01] }
density = 1500.0
pressure = "hydrostatic"
[fluids.grains.rheology.granular]
friction = 0.4
fast_friction = 0.6
inertial_number = 0.3
diameter = 0.001
grain_density = 2500.0
largest_viscosity = %r
[walls.floor]
shape.box = { lower = [0.0, -0.003], upper = [0.01, 0.0] }
no_slip = true
"""


def test_a_cap_that_hides_the_friction_of_grains_is_warned_of(tmp_path):
    """Under 135 Pa they bear 54 Pa: 40 Pa let them creep by 40/100 0.5 = 0.2 of strain at a cap of 100 Pa s,
    and 67 Pa flow at I√(p/ρ_s)/d = 65.7 1/s, I = 0.283."""
    [line] = checked(tmp_path, GRAINS % (8.0 / 3.0, 100.0))
    assert (
        "hides the friction: it creeps by a strain of 0.2 until time.end; give largest_viscosity = 2e+02"
        in line
    )
    assert checked(tmp_path, GRAINS % (8.0 / 3.0, 210.0)) == []
    [line] = checked(tmp_path, GRAINS % (4.5, 0.5))
    assert "hides the friction: below that the fluid creeps at 1.1e+02 1/s" in line
    assert checked(tmp_path, GRAINS % (4.5, 2.0)) == []


def test_a_layer_of_some_length_on_a_slope_is_sheared_by_its_front_too(tmp_path):
    """1 m long, 0.5 m thick: 0.98 m/s² along it and half of 9.75 across it, 2.93 kPa over its thickness."""
    tilted = "physics.gravity=[0.98, -9.75]"
    lines = said(tmp_path, TANK, MUD % (5000.0, 2e4), tilted)
    assert lines[-2] == "does not flow: weight over 0.5 m brings about 2.93e+03 Pa at most"


@pytest.mark.parametrize(("tau", "warned"), [(10.0, True), (49.0, False)])
def test_a_flow_between_plates_is_expected_at_what_its_paste_allows(tmp_path, tau, warned):
    """100 Pa/m along 1 m: 50 Pa at the plates, against the yield; the 2 m/s by the end are too fast for sound."""
    lines = checked(tmp_path, CHANNEL, CONSTANT, MUD % (tau, 1000.0), "physics.sound_speed=9.0")
    assert (
        any(line.startswith("physics.sound_speed") and "a rheology allows" in line for line in lines)
        == warned
    )


def test_a_long_run_names_the_cap(tmp_path):
    from psph.runs.forecast import long_run
    from psph.simulation.plan import make_plan

    scene = Scene(draft(tmp_path, TANK, MUD % (10.0, 1e9)))
    [line] = long_run(scene, make_plan(scene), 1)
    assert "fluids.water.rheology.bingham sets the step by its largest viscosity, 1e+09 Pa s" in line
