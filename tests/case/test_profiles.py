"""Profiles: what they fill in, what gives way to what, and what a run writes of them."""

import pytest
from drafts import SQUARE, draft, refusal

from psph.case import load
from psph.case.profiles import CLOSED as OF_CLOSED
from psph.case.profiles import OFF, PROFILES, choices
from psph.case.schemes import SCHEMES, STABLE

CLOSED = SQUARE.replace(
    "spacing = 0.1", 'spacing = 0.1\nperiodic = ["x", "y"]\nlower = [0.0, 0.0]\nupper = [1.0, 1.0]'
)


BARE, SHUT = (text.replace('scheme = "sph"\n', "") for text in (SQUARE, CLOSED))
"""Both under the default scheme."""


def named(profile, text):
    return f'profile = "{profile}"\n{text}'


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("text", [BARE, SHUT])
def test_a_profile_changes_its_keys_of_the_default_scheme_and_no_others(tmp_path, profile, text):
    case = draft(tmp_path, named(profile, text))
    wanted = choices(profile, 2, case.space.periodic)
    assert wanted and all(case.preset(key) == f"profile {profile}" for key in wanted)
    rest = SCHEMES[STABLE].keys() - wanted.keys()
    assert all(case.preset(key) == f"scheme {STABLE}" for key in rest)
    absent = {key for key, value in wanted.items() if value == OFF}
    assert all(getattr(case.physics, key.removeprefix("physics.")) is None for key in absent)


def test_profiles_are_few_keys_and_each_another():
    tables = [choices(name, 2, axes) for name in PROFILES for axes in ((), ("x", "y"))]
    assert len({repr(table) for table in tables}) == 3  # quick is the same in both
    assert all(0 < len(table) < 4 for table in tables) and OF_CLOSED.keys() == PROFILES.keys()


def test_what_the_file_says_wins_over_its_profile(tmp_path):
    text = named("reference", BARE).replace("sound_speed", "local_potential = 0.01\nsound_speed")
    case = draft(tmp_path, text)
    assert case.physics.local_potential.strength == 0.01
    assert not case.preset("physics.local_potential") and case.preset("time.cfl") == "scheme stable"


def test_a_profile_on_the_command_line_wins_over_the_file(tmp_path):
    text = BARE.replace("sound_speed", "local_potential = 0.01\nsound_speed")
    case = draft(tmp_path, text, "space.smoothing=1.9", "profile=reference")
    assert case.space.smoothing == 1.9 and case.physics.local_potential is None
    assert case.physics.sound_speed is not None  # a profile has no say in it


def test_a_key_within_a_table_of_the_scheme_is_changed_alone(tmp_path):
    """A table that the file or the command line gives whole is that."""
    inner, whole = "physics.local_potential.threshold=0.1", "physics.local_potential={threshold=0.1}"
    written = BARE.replace("sound_speed", "local_potential = { strength = 0.01 }\nsound_speed")
    found = {
        (text, key): draft(tmp_path, text, key).physics.local_potential
        for text in (BARE, written)
        for key in (inner, whole)
    }
    for text in ("local_potential = { threshold = 0.3 }", "local_potential = {}"):
        given = BARE.replace("sound_speed", f"{text}\nsound_speed")
        assert draft(tmp_path, given, inner).physics.local_potential.strength == 0.008
    assert (
        draft(tmp_path, BARE, "physics.local_potential={}", inner).physics.local_potential.strength == 0.008
    )
    of_scheme = SCHEMES[STABLE]["physics.local_potential"]["strength"]
    strengths = [found[text, key].strength for text, key in ((BARE, inner), (BARE, whole), (written, inner))]
    assert strengths == [of_scheme, 0.008, 0.01]
    assert {one.threshold for one in found.values()} == {0.1}


def test_an_effect_of_a_profile_can_be_left_out(tmp_path):
    whole = named("reference", SHUT)
    written = whole.replace("sound_speed", 'particle_shifting = "off"\nsound_speed')
    for text, sets in ((written, ()), (whole, ("physics.particle_shifting=off",))):
        physics = draft(tmp_path, text, *sets).physics
        assert physics.particle_shifting is None and physics.gradient_correction is not None


@pytest.mark.parametrize(
    "sets",
    [(), ("physics.particle_shifting=off",), ("profile=quick", "time.cfl=0.1"), ("profile=off",)],
)
def test_the_resolved_case_reads_back_equal(tmp_path, sets):
    case = draft(tmp_path, named("reference", SHUT), *sets)
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
        (named("referenc", SHUT), "profile: \"referenc\" is not known; did you mean 'reference'?"),
        (
            named("reference", SHUT.replace("sound", 'pressure_gradient = "minimum"\nsound')),
            "physics.gradient_correction: does not work",
        ),
        (
            named("quick", SQUARE),
            'profile: "quick": it changes the default scheme, and scheme = "sph" is another; remove one of',
        ),
        ("profile = 3\n" + SHUT, "profile: 3 is not known"),
        ('profile = "quick"\nspace = 3\n[time]\nend = 1.0', "space: 3 is not a table"),
        (named("quick", SHUT.replace('["x", "y"]', "3")), "space.periodic: 3 is not a list"),
    ],
)
def test_what_is_wrong_with_a_profile_or_under_it_is_said(tmp_path, text, says):
    assert any(says in line for line in refusal(tmp_path, text))


MIRRORED = """
space = { dimensions = 2, spacing = 0.1, lower = [0.0, 0.0], upper = [2.0, 2.0], symmetry = ["x.lower"] }
time.end = 1.0
physics.sound_speed = 10.0
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
"""


def test_a_profile_that_sets_what_another_key_cannot_have_is_named(tmp_path):
    says = 'precision: "mixed": mirrors do not work in single precision; use "double"'
    by_profile = refusal(tmp_path, 'profile = "quick"\n' + MIRRORED)
    assert by_profile == [f"case.toml with profile quick: {says}"]
    assert refusal(tmp_path, 'precision = "mixed"\n' + MIRRORED) == [f"case.toml: {says}"]
    assert draft(tmp_path, 'profile = "quick"\nprecision = "double"\n' + MIRRORED).precision == "double"
