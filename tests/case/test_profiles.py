"""Profiles: what they fill in, what gives way to what, and what a run writes of them."""

import pytest
from drafts import SQUARE, TANK, draft, refusal

from psph.case import load
from psph.case.profiles import OFF, PERIODIC, PROFILES, choices
from psph.case.schemes import SCHEMES

CLOSED = SQUARE.replace(
    "spacing = 0.1", 'spacing = 0.1\nperiodic = ["x", "y"]\nlower = [0.0, 0.0]\nupper = [1.0, 1.0]'
)


def named(profile, text):
    return f'profile = "{profile}"\n{text}'


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("text", [SQUARE, CLOSED])
def test_a_profile_fills_in_every_key_that_the_case_leaves_out(tmp_path, profile, text):
    case = draft(tmp_path, named(profile, text))
    wanted = choices(profile, 2, case.space.periodic)
    assert all(case.preset(key) == f"profile {profile}" for key in wanted)
    assert case.space.smoothing == wanted["space.smoothing"] and case.time.cfl == wanted["time.cfl"]
    assert case.physics.density_diffusion.delta == wanted["physics.density_diffusion"]
    absent = {key for key, value in wanted.items() if value == OFF}
    assert all(getattr(case.physics, key.removeprefix("physics.")) is None for key in absent)


def test_profiles_differ_in_every_pair_and_name_the_same_keys():
    tables = [choices(name, 2, axes) for name in PROFILES for axes in ((), ("x", "y"))]
    assert all(table.keys() == tables[0].keys() for table in tables)
    assert len({repr(table) for table in tables}) == 2 * len(PROFILES)
    assert PERIODIC.keys() == PROFILES.keys()


def test_what_the_file_says_wins_over_its_profile(tmp_path):
    text = named("reference", TANK)
    case = draft(tmp_path, text)
    assert (case.space.kernel, case.space.smoothing) == ("hyperbolic", 1.3)
    assert case.physics.density_diffusion is not None
    assert not case.preset("space.smoothing") and case.preset("time.cfl") == "profile reference"


def test_a_profile_on_the_command_line_wins_over_the_file(tmp_path):
    text = TANK.replace("gravity", "gradient_correction = 0.5\ngravity")
    case = draft(tmp_path, text, "space.smoothing=1.9", "profile=quick")
    assert (case.space.kernel, case.space.smoothing) == ("wendland-c2", 1.9)
    assert case.physics.gradient_correction is None
    assert case.physics.gravity is not None  # a profile has no say in it


def test_an_effect_of_a_profile_can_be_left_out(tmp_path):
    whole = named("reference", CLOSED)
    written = whole.replace("sound_speed", 'particle_shifting = "off"\nsound_speed')
    for text, sets in ((written, ()), (whole, ("physics.particle_shifting=off",))):
        physics = draft(tmp_path, text, *sets).physics
        assert physics.particle_shifting is None and physics.gradient_correction is not None


@pytest.mark.parametrize(
    "sets",
    [(), ("physics.particle_shifting=off",), ("profile=quick", "time.cfl=0.1"), ("profile=off",)],
)
def test_the_resolved_case_reads_back_equal(tmp_path, sets):
    case = draft(tmp_path, named("reference", CLOSED), *sets)
    written = case.to_toml()
    (tmp_path / "case.toml").write_text(written, encoding="utf-8")
    again = load(tmp_path / "case.toml")
    assert again == case and again.to_toml() == written


def test_no_profile_is_no_difference(tmp_path):
    case = draft(tmp_path, CLOSED)
    assert case.profile is None and case.presets.keys() == SCHEMES["sph"].keys()
    assert case.space.smoothing == 1.2 and case.physics.density_diffusion is None
    assert "off" not in case.to_toml()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (named("referenc", CLOSED), "profile: \"referenc\" is not known; did you mean 'reference'?"),
        (
            named("reference", CLOSED.replace("sound", 'pressure_gradient = "minimum"\nsound')),
            "case.toml with profile reference: physics.gradient_correction: does not work",
        ),
        ("profile = 3\n" + CLOSED, "profile: 3 is not known"),
        ('profile = "quick"\nspace = 3\n[time]\nend = 1.0', "space: 3 is not a table"),
        (named("quick", CLOSED.replace('["x", "y"]', "3")), "space.periodic: 3 is not a list"),
    ],
)
def test_what_is_wrong_with_a_profile_or_under_it_is_said(tmp_path, text, says):
    assert any(says in line for line in refusal(tmp_path, text))
