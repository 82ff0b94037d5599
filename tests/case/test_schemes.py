"""Schemes: what they fill in, and what gives way to what."""

from drafts import SQUARE, draft, refusal

from psph.case.profiles import OFF
from psph.case.schemes import SCHEMES

CUBE = """
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, 0.0, -9.8]
fluids.water.shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 0.5, 0.5] }
"""

BARE = SQUARE.replace('scheme = "sph"\n', "")


def of(case, key):
    """The value of a key as a person would write it."""
    table, _, name = key.partition(".")
    value = getattr(getattr(case, table), name)
    return (
        OFF
        if value is None
        else getattr(
            value,
            type(value).__annotations__ and next(iter(type(value).model_fields))
            if hasattr(type(value), "model_fields")
            else "",
            value,
        )
    )


def test_stable_is_the_default(tmp_path):
    case = draft(tmp_path, BARE)
    assert case.scheme == "stable"
    firsts = {k: next(iter(v.values())) if isinstance(v, dict) else v for k, v in SCHEMES["stable"].items()}
    assert {key: of(case, key) for key in SCHEMES["stable"]} == firsts
    assert case.physics.reconstructed_damping.in_disorder == 0.2 and case.time.gather_every == 8


def test_what_the_file_says_wins(tmp_path):
    case = draft(tmp_path, BARE.replace("[physics]", "[physics]\nimpact_damping = 0.1"))
    assert case.physics.impact_damping.beta == 0.1 and case.preset("physics.impact_damping") is None
    assert case.physics.local_potential is not None


def test_a_part_can_be_left_out(tmp_path):
    for text, sets in (
        (BARE, ("physics.local_potential=off",)),
        (BARE.replace("[physics]", '[physics]\nlocal_potential = "off"'), ()),
    ):
        case = draft(tmp_path, text, *sets)
        assert case.physics.local_potential is None and case.physics.position_shift is not None
        assert draft(tmp_path, case.to_toml()) == case


def test_a_scheme_on_the_command_line_wins(tmp_path):
    text = BARE.replace("[time]", 'kernel = "quintic"\n[time]')
    assert draft(tmp_path, text).space.kernel == "quintic"
    assert draft(tmp_path, text, "scheme=ssph").space.kernel == "hyperbolic"


def test_ssph_has_the_pressure_gradient_that_the_paper_has_for_the_case(tmp_path):
    ssph = 'scheme = "ssph"\n' + BARE
    assert draft(tmp_path, ssph).physics.pressure_gradient == "minimum"
    surface = draft(tmp_path, ssph.replace("[physics]", "[physics]\nfree_surface = 0.9"))
    assert surface.physics.pressure_gradient == "symmetric"


def test_two_shifts_are_refused(tmp_path):
    [line] = refusal(tmp_path, BARE.replace("[physics]", "[physics]\nparticle_shifting = 0.1"))
    assert "physics.particle_shifting" in line and 'set it to "off"' in line


def test_the_default_scheme_is_fitted_to_the_smoothing_length(tmp_path):
    """Where the case gives no other kernel; what it says of the potential wins."""
    text = BARE.replace('kernel = "hyperbolic"\n', "")
    potential, kernel = "physics.local_potential", "space.kernel"
    usual = draft(tmp_path, text, "space.smoothing=1.4")
    for ratio, key, strength, threshold in (
        (1.0, "wendland-c2", 0.016, 0.03),
        (1.1, "wendland-c2", 0.004, 0.2),
        (1.2, "cubic", 0.004, 0.05),
        (1.25, "hyperbolic", 0.004, 0.2),
        (1.3, "hyperbolic", 0.004, 0.2),
        (1.5, "wendland-c2", 0.004, 0.01),
        (1.8, "wendland-c2", 0.004, 0.2),
    ):
        case = draft(tmp_path, text, f"space.smoothing={ratio}")
        found = case.physics.local_potential
        assert (case.space.kernel, found.strength, found.threshold) == (key, strength, threshold)
        assert case.preset(potential) == case.preset(kernel) == "scheme stable"
        assert draft(tmp_path, case.to_toml()) == case
        given = draft(tmp_path, text, f"space.smoothing={ratio}", "space.kernel=quintic")
        assert given.physics.local_potential == usual.physics.local_potential
        assert given.preset(potential) == "scheme stable" and given.preset(kernel) is None
        said = draft(tmp_path, text, f"space.smoothing={ratio}", f"{potential}.strength=0.1")
        assert said.physics.local_potential.strength == 0.1
        assert said.physics.local_potential.threshold == threshold
    plain = draft(tmp_path, text, "space.smoothing=1.3", "scheme=sph")
    assert plain.space.kernel == "cubic" and plain.physics.local_potential is None


def test_in_3d_another_kernel_is_enough(tmp_path):
    """And nothing else helps at other ratios."""
    for ratio, kernel in (
        (1.0, "wendland-c2"),
        (1.2, "wendland-c2"),
        (1.3, "hyperbolic"),
        (1.35, "hyperbolic"),
    ):
        case = draft(tmp_path, CUBE, f"space.smoothing={ratio}")
        assert case.space.kernel == kernel and case.preset("space.kernel") == "scheme stable"
        assert case.physics.local_potential.threshold == 0.2
