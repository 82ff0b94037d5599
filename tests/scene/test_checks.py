"""What is refused and what is warned of, and what is not."""

import re

import numpy as np
import pytest
from drafts import CHANNEL, TANK, WATER, draft

from psph.case import CaseError
from psph.scene import Scene, check
from psph.scene.fluid.checks import kernel_sums
from psph.scene.fluid.periodic_gravity import driven_speed

PERIODIC = ("space.periodic=['x']", "space.lower=[0.0, 0.0]", "space.upper=[1.0, 2.0]")
FALLING = re.compile("no wall holds 100% of the fluid: it falls for ever")
OIL = "\n[fluids.oil]\nshape.box = {{ lower = [0.0, {low}], upper = [1.0, 0.8] }}\n"


def checked(folder, text=TANK, *overrides):
    """The warnings on a text, without its folder; and without that of the water in free fall, which tests of
    units have, for many of these scenes are no more than water."""
    lines = check(Scene(draft(folder, text, *overrides)))
    return [line.replace(f"{folder}/", "") for line in lines if not FALLING.search(line)]


def refused(folder, text=TANK, *overrides):
    """The faults of a text, without its folder."""
    with pytest.raises(CaseError) as caught:
        checked(folder, text, *overrides)
    return [line.replace(f"{folder}/", "") for line in caught.value.lines]


@pytest.mark.parametrize("text", [WATER, TANK])
def test_a_good_scene_is_silent(tmp_path, text):
    assert checked(tmp_path, text) == []


@pytest.mark.parametrize(
    "text, sets, says",
    [
        (
            TANK,
            ("space.spacing=100",),
            "100 m is larger than the fluids: fluids.water is 0.5 m thick; give at most a tenth of that, 0.05",
        ),
        (TANK, ("space.spacing=1.2",), "1.2 m is larger than the fluids: fluids.water is 0.5 m"),
        (
            WATER + "[fluids.oil.shape.disc]\ncenter = [3.0, 3.0]\nradius = 0.4",
            ("space.spacing=30",),
            "30 m is larger than the fluids: fluids.oil is 0.8 m thick",
        ),
    ],
)
def test_a_huge_spacing_is_the_one_fault(tmp_path, text, sets, says):
    [line] = refused(tmp_path, text, *sets)
    assert line.startswith(f"case.toml: space.spacing: {says}")


def test_a_spacing_is_not_the_fault_of_one_small_shape(tmp_path):
    speck = WATER + "[fluids.oil.shape.disc]\ncenter = [3.0, 3.0]\nradius = 0.01"
    [line] = refused(tmp_path, speck)
    assert line.startswith("case.toml: fluids.oil.shape: no lattice site lies in it; make it larger")


def test_an_empty_shape_is_refused(tmp_path):
    text = TANK + "[walls.speck]\nshape.box = { lower = [0.01, 0.61], upper = [0.04, 0.64] }"
    [line] = refused(tmp_path, text)
    assert line == (
        "case.toml: walls.speck.shape: no lattice site lies in it; make it larger than "
        "space.spacing, or move it"
    )


def test_a_scene_without_any_site_is_refused(tmp_path):
    [line] = refused(tmp_path, WATER, "space.spacing=10.0")
    assert line.startswith("case.toml: space.spacing: 10 m is larger than the fluids: fluids.water is")


def test_a_width_that_is_no_multiple_of_the_spacing_is_warned_of(tmp_path):
    box = "fluids.water.shape.box.upper=[{}, 0.5]"
    [line] = checked(
        tmp_path, WATER, "space.spacing=0.03", box.format(0.25), "fluids.water.shape.box.lower=[0.0, 0.2]"
    )
    assert line == (
        "case.toml: fluids.water is 0.25 m wide along x, which is 8.333 spacings of 0.03 m: the "
        "lattice makes it 8; space.spacing = 0.025 fits"
    )
    assert checked(tmp_path, WATER, "space.spacing=0.03125", box.format(0.25)) == []
    lines = checked(
        tmp_path,
        TANK,
        "walls.tank.shape.difference.minus=[{ box = { lower = [0.0, 0.0], upper = [1.05, 0.7] } }]",
    )
    assert lines[0].startswith("case.toml: walls.tank is 1.05 m wide along x, which is 10.5 spacings")


def test_an_open_rim_may_have_any_height(tmp_path):
    assert checked(tmp_path, TANK.replace("0.7]", "0.73]")) == []


def test_overlapping_fluids_are_refused(tmp_path):
    [line] = refused(tmp_path, WATER + OIL.format(low=0.4))
    assert line == (
        "case.toml: fluids.oil.shape: overlaps fluids.water at [0.05, 0.45]; subtract "
        "one from the other: shape = { difference = { from = ..., minus = [...] } }"
    )
    assert checked(tmp_path, WATER + OIL.format(low=0.5)) == []


def test_a_wall_in_a_fluid_is_refused(tmp_path):
    text = WATER + "[walls.post]\nshape.box = { lower = [0.4, 0.0], upper = [0.7, 0.5] }"
    [line] = refused(tmp_path, text)
    assert line.startswith("case.toml: walls.post.shape: overlaps fluids.water at [0.45, 0.05]; ")
    assert line.endswith(
        "subtract one from the other: shape = { difference = { from = ..., minus = [...] } }, or let the wall take "
        "its place: walls.post.displaces = true"
    )
    assert checked(tmp_path, text + "\ndisplaces = true") == []
    [line] = refused(tmp_path, TANK, "walls.tank.displaces=true", "walls.tank.condition=mirror")
    assert line.endswith(
        "walls.tank: displaces is of a wall with particles, which a mirror has not; remove it"
    )


def test_walls_may_overlap(tmp_path):
    text = TANK + "[walls.lid]\nshape.box = { lower = [-0.3, 0.5], upper = [1.3, 0.8] }"
    assert checked(tmp_path, text) == []


@pytest.mark.parametrize(
    ("upper", "says"),
    [
        (
            1.05,
            "space.upper: the domain is 1.05 m = 10.5 spacings long along the periodic axis x; "
            "make it a whole number, for example up to 1",
        ),
        (
            1.0001,
            "space.upper: the domain is 1.0001 m = 10.001 spacings long along the periodic axis x",
        ),
    ],
)
def test_a_period_that_is_no_multiple_of_the_spacing_is_refused(tmp_path, upper, says):
    [line] = refused(tmp_path, WATER, *PERIODIC, f"space.upper=[{upper}, 2.0]")
    assert line.startswith(f"case.toml: {says}")


def test_a_short_period_is_refused(tmp_path):
    [line] = refused(tmp_path, WATER, *PERIODIC, "space.smoothing=1.6")
    assert line == (
        "case.toml: space.upper: the domain is 1 m long along the periodic axis x, the kernel "
        "needs 1.0368; make it longer or space.spacing smaller"
    )
    assert checked(tmp_path, WATER, *PERIODIC) == []


def test_particles_outside_the_domain_are_refused(tmp_path):
    [line] = refused(tmp_path, WATER, *PERIODIC, "space.lower=[-1.0, 0.1]")
    assert line == (
        "case.toml: fluids.water.shape: a particle at y = 0.05 m outside the domain from 0.1 to 2; "
        "make the shape smaller, or change space.lower and space.upper"
    )
    [line] = refused(tmp_path, WATER, *PERIODIC, "fluids.water.shape.box.upper=[1.1, 0.5]")
    assert "a particle at x = 1.05 m outside the domain from 0 to 1; make the shape" in line


def test_a_probe_outside_the_domain_is_refused(tmp_path):
    probe = "probes.P1.position=[0.5, 7.0]"
    assert refused(tmp_path, TANK, probe) == [
        "case.toml: probes.P1.position: [0.5, 7] lies outside the domain [-0.3, -0.3] to "
        "[1.3, 0.7]; move it inside"
    ]
    assert checked(tmp_path, TANK, "probes.P1.position=[0.5, 0.7]") == []


def test_a_gauge_of_a_crest_or_a_region_outside_the_domain_is_warned_of(tmp_path):
    crest, region = 'gauges.o.overtopping={{at={},towards="+x"}}', 'gauges.h.highest={{axis="x",shape={}}}'
    near, far = (f"{{box={{lower=[{x}, 0.0],upper=[{x + 1}, 1.0]}}}}" for x in (1.2, 5.0))
    assert checked(tmp_path, TANK, crest.format(0.5), region.format(near)) == []
    one, other = checked(tmp_path, TANK, crest.format(9.0), region.format(far))
    assert "gauges.o.overtopping.at: 9 m lies outside the domain [-0.3, -0.3] to [1.3, 0.7]" in one
    assert "gauges.h.highest.shape: lies outside the domain" in other


def test_a_gauge_may_end_at_the_rim_whatever_rounding_makes_of_it(tmp_path):
    """54 cells of 0.0075 m are less than 0.405 in binary numbers."""
    rim = TANK.replace("spacing = 0.1", "spacing = 0.0075").replace("0.7]", "0.405]")
    rim = rim.replace("[1.0, 0.5]", "[0.15, 0.0525]").replace("-0.3", "-0.0225").replace("[1.3,", "[0.1725,")
    rim = rim.replace("[1.0, 0.405]", "[0.15, 0.405]")
    line = "gauges.wave.level={ foot = [0.075, 0.0], top = [0.075, 0.405] }"
    assert checked(tmp_path, rim, line) == []
    assert 54 * 0.0075 < 0.405


def test_a_section_outside_the_domain_is_refused(tmp_path):
    """All of it; one that reaches beyond the domain is cut there."""
    section = "gauges.through.flow={{ lower = [{0}, {1}], upper = [{0}, {2}] }}"
    for outside in ((9.0, 0.0, 0.5), (-0.4, 0.0, 0.5), (0.5, 0.8, 0.9), (0.5, -0.9, -0.4)):
        [line] = refused(tmp_path, TANK, section.format(*outside))
        x, low, up = outside
        assert line == (
            f"case.toml: gauges.through.flow: a section from [{x:g}, {low:g}] to [{x:g}, {up:g}] lies outside the "
            "domain [-0.3, -0.3] to [1.3, 0.7]; move it inside"
        )
    assert checked(tmp_path, TANK, section.format(0.5, -0.9, 0.9)) == []


@pytest.mark.parametrize(
    ("state", "pressure"), [("linear", -25000.0), ("linear", -30000.0), ("tait", -4000.0)]
)
def test_a_pressure_without_a_density_is_refused(tmp_path, state, pressure):
    overrides = (f"physics.equation_of_state={state}", "physics.sound_speed=5")
    [line] = refused(tmp_path, WATER, *overrides, f"fluids.water.pressure={pressure}")
    assert line == (
        f"case.toml: fluids.water.pressure: {pressure:g} Pa leaves no density at a speed of sound "
        "of 5 m/s; raise the pressure or physics.sound_speed"
    )


def test_an_unknown_sound_speed_is_refused(tmp_path):
    text = WATER.replace("gravity = [0.0, -9.8]", "")
    [line] = refused(tmp_path, text)
    assert line.startswith("case.toml: physics.sound_speed: missing, and it cannot be derived")
    assert "give ten times the largest speed" in line
    assert checked(tmp_path, text, "physics.sound_speed=10") == []


def test_a_spacing_larger_than_what_moves_is_told_without_ado(tmp_path, recwarn):
    """No place is sought for a wall that holds no site."""
    gate = (
        "walls.gate={{ shape.box = {{ lower = [0.5, 0.5], upper = [0.6, 0.7] }}, motion.translation = {} }}"
    )
    [line] = refused(tmp_path, TANK, gate.format([0.0, 0.1]), "space.spacing=20.0")
    assert line.startswith("case.toml: space.spacing: 20 m is larger than the fluids")
    assert not recwarn.list


def test_all_faults_of_place_are_found_at_once(tmp_path):
    text = WATER + OIL.format(low=0.4) + "[probes.P1]\nposition = [5.0, 5.0]"
    lines = refused(tmp_path, text, *PERIODIC, "space.smoothing=2.0")
    keys = [line.split(": ")[1] for line in lines]
    assert keys == ["space.upper", "fluids.oil.shape", "probes.P1.position"]


THIN = TANK.replace("lower = [-0.3, -0.3]", "lower = [-0.3, -0.2]")


def test_a_thin_wall_is_warned_of(tmp_path):
    assert checked(tmp_path, THIN) == [
        "case.toml: walls.tank.shape: 2 layers of particles at [0.05, -0.05], the kernel reaches "
        "over 2.6; make the wall at least 3 spacings (0.3 m) thick"
    ]


@pytest.mark.parametrize("override", ["space.smoothing=1.0", "space.smoothing=0.9"])
def test_a_wall_as_thick_as_the_support_is_silent(tmp_path, override):
    assert checked(tmp_path, THIN, override) == []


def test_a_longer_kernel_needs_a_thicker_wall(tmp_path):
    [line] = checked(tmp_path, TANK, "space.kernel=quintic")
    assert "3 layers of particles" in line
    assert "reaches over 3.9; make the wall at least 4 spacings (0.4 m) thick" in line


def test_two_walls_behind_each_other_count_together(tmp_path):
    text = THIN + "[walls.floor]\nshape.box = { lower = [-0.3, -0.3], upper = [1.3, -0.2] }"
    assert checked(tmp_path, text) == []


WEIGHTLESS = ("physics.gravity=off", "physics.sound_speed=10")
"""Else the fluid falls past a wall that does not hold it, and is warned of."""


def test_a_round_body_in_the_fluid_is_not_thin(tmp_path):
    disc = "disc = { center = [2.0, 2.0], radius = 0.96 }"
    text = WATER.replace(
        "shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }",
        "shape.difference.from.box = { lower = [0.0, 0.0], upper = [4.0, 4.0] }\n"
        f"shape.difference.minus = [{{ {disc} }}]",
    )
    assert checked(tmp_path, text + f"[walls.pile]\nshape.{disc}", *WEIGHTLESS) == []


def test_a_plate_between_fluids_is_thin(tmp_path):
    text = (
        WATER.replace(
            "shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }",
            """
shape.union = [
    { box = { lower = [0.0, 0.0], upper = [1.0, 2.0] } },
    { box = { lower = [1.2, 0.0], upper = [2.0, 2.0] } },
]
""",
        )
        + "[walls.plate]\nshape.box = { lower = [1.0, 0.0], upper = [1.2, 2.0] }"
    )
    [line] = checked(tmp_path, text, *WEIGHTLESS)
    assert line.startswith("case.toml: walls.plate.shape: 2 layers of particles at [1.05, 0.05]")


def test_a_wall_goes_on_across_a_periodic_edge(tmp_path):
    text = """
scheme = "sph"
[space]
dimensions = 2
spacing = 0.1
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [2.0, {height}]
[time]
end = 1.0
[physics]
sound_speed = 10.0
[fluids.water]
shape.box = {{ lower = [0.0, 0.2], upper = [2.0, 1.9] }}
[walls.plate]
shape.union = [
    {{ box = {{ lower = [0.0, 0.0], upper = [2.0, 0.2] }} }},
    {{ box = {{ lower = [0.0, 1.9], upper = [2.0, 2.0] }} }},
]
"""
    assert checked(tmp_path, text.format(height=2.0)) == []
    assert checked(tmp_path, text.format(height=2.0), "parallel.axis=y") == []
    [line] = checked(tmp_path, text.format(height=3.0))  # the seam lies beyond a gap
    assert "1 layer of particles at [0.05, 1.95]" in line


# Of the method's notes: square lattice, hyperbolic kernel.
@pytest.mark.parametrize(
    ("smoothing", "interior", "surface"),
    [(1.0, None, 0.998), (1.2, 1.083, 0.882), (1.3, 1.065, 0.843)],
)
def test_kernel_sums_on_the_square_lattice(tmp_path, smoothing, interior, surface):
    found = kernel_sums(Scene(draft(tmp_path, WATER, f"space.smoothing={smoothing}")))
    assert found[1] == pytest.approx(surface, abs=5e-4)
    assert interior is None or found[0] == pytest.approx(interior, abs=5e-4)


@pytest.mark.parametrize("smoothing", [1.2, 1.3])
def test_a_threshold_between_the_sums_is_silent(tmp_path, smoothing):
    overrides = (f"space.smoothing={smoothing}", "physics.free_surface=0.9")
    assert checked(tmp_path, WATER, *overrides) == []


def test_a_threshold_that_sees_no_surface_is_warned_of(tmp_path):
    [line] = checked(tmp_path, WATER, "space.smoothing=1.0", "physics.free_surface=0.9")
    assert line == (
        "case.toml: physics.free_surface: 0.9 detects no surface, the kernel sum is 1.146 inside and "
        "0.998 in the surface row; give a value between 0.998 and 1.146, or another space.smoothing"
    )


def test_a_threshold_that_takes_all_for_surface_is_warned_of(tmp_path):
    [line] = checked(tmp_path, WATER, "physics.free_surface=1.1")
    assert line.startswith(
        "case.toml: physics.free_surface: 1.1 treats every particle as surface, the kernel sum is "
        "1.065 inside and 0.843 in the surface row; give a value between 0.843 and 1.065"
    )


def test_a_slow_sound_is_warned_of(tmp_path):
    [line] = checked(tmp_path, WATER, "physics.sound_speed=20")
    assert line == (
        "case.toml: physics.sound_speed: 20 is below ten times the expected speed, 3.13 m/s, so "
        "density will vary by more than 1 %; raise it to 31.3"
    )
    assert checked(tmp_path, WATER, "physics.sound_speed=31.4") == []


def test_a_smoothing_length_at_which_water_boils_is_warned_of(tmp_path):
    """Under the default scheme, where the case does not say how else particles are to be held."""
    bare = WATER.replace('kernel = "hyperbolic"\n', "")
    [line] = checked(tmp_path, bare, "scheme=stable", "space.smoothing=1.1")
    assert line == (
        "case.toml: space.smoothing: still water does not come to rest at 1.1 under the default scheme, since "
        "its particles leave their lattice; give 1.4, or 1.3 for fewer neighbours"
    )
    for more in (
        "space.smoothing=1.2",
        "space.kernel=quintic",
        "scheme=sph",
        "physics.local_potential.strength=0.03",
    ):
        assert checked(tmp_path, bare, "scheme=stable", "space.smoothing=1.1", more) == []
    weightless = ("physics.gravity=[0.0, 0.0]", "physics.sound_speed=10.0")
    assert checked(tmp_path, bare, "scheme=stable", "space.smoothing=1.1", *weightless) == []


def test_a_large_jitter_is_warned_of(tmp_path):
    assert checked(tmp_path, WATER, "fluids.water.jitter=0.6") == [
        "case.toml: fluids.water.jitter: 0.6 spacings let neighbours change places; give at most 0.5"
    ]
    assert checked(tmp_path, WATER, "fluids.water.jitter=0.5") == []


CLOSED = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.1, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [2.0, 2.0] }
time.end = 1.0
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 2.0] }
"""


def test_minimum_pressure_with_a_free_surface_is_warned_of(tmp_path):
    [line] = checked(tmp_path, TANK, "physics.pressure_gradient=minimum")
    assert line.startswith('case.toml: physics.pressure_gradient: "minimum" is unstable at a free')


@pytest.mark.parametrize(
    "text, override",
    [
        (TANK, "physics.pressure_gradient=symmetric"),
        (CLOSED, "physics.pressure_gradient=minimum"),
    ],
)
def test_minimum_pressure_without_one_is_silent(tmp_path, text, override):
    assert checked(tmp_path, text, override) == []


def test_minimum_pressure_without_friction_is_warned_of_where_particles_start_in_disorder(tmp_path):
    sets = "physics.pressure_gradient=minimum", "fluids.water.jitter=0.1"
    [line] = checked(tmp_path, CLOSED, *sets)
    assert "fluid starts disordered and without friction" in line
    assert checked(tmp_path, CLOSED, *sets, "fluids.water.viscosity=1e-3") == []


def test_a_background_pressure_at_a_free_surface_is_warned_of(tmp_path):
    [line] = checked(tmp_path, TANK, "physics.background_pressure=100.0")
    assert line.startswith("case.toml: physics.background_pressure: blows a free surface apart")
    assert checked(tmp_path, CLOSED, "physics.background_pressure=100.0") == []
    assert checked(tmp_path, TANK, "physics.background_pressure=auto") == []


@pytest.mark.parametrize("text, why", [(TANK, ""), (CLOSED, "the fluid has no free surface")])
def test_a_potential_in_tension_that_cannot_act_is_warned_of(tmp_path, text, why):
    told = checked(tmp_path, text, "scheme=stable", "physics.local_potential.in_tension=3")
    beyond = [line for line in told if "in_tension" in line]
    says = f"case.toml: physics.local_potential: in_tension = 3 has no effect here, since {why}; leave it out"
    assert beyond == ([says] if why else [])


def test_a_transport_velocity_at_a_free_surface_is_warned_of(tmp_path):
    use = 'use=["transport.py"]'
    [line] = checked(tmp_path, TANK, use, "physics.transport_velocity=1.0")
    assert line.startswith("case.toml: physics.transport_velocity: moves a free surface outwards")
    assert checked(tmp_path, CLOSED, use, "physics.transport_velocity=1.0") == []
    assert checked(tmp_path, TANK, use, "physics.generalised_transport_velocity=1.0") == []


def test_a_slip_in_the_units_is_refused_at_once(tmp_path):
    assert refused(tmp_path, TANK, "space.spacing=1e-8") == [
        "case.toml: space.spacing: 1e-08 m makes a lattice of 1.6e+16 sites, more than 1e+11; "
        "make it larger, or the shapes smaller"
    ]


def test_a_time_that_cannot_tell_its_steps_is_refused(tmp_path):
    [line] = refused(tmp_path, TANK, "time.end=1e9")
    assert line.startswith(
        "case.toml: time.end: 1e+09 s takes more than 9e+09 steps of at most 0.00083 s (by this "
        "spacing and speed of sound), lost in the rounding of the time; give less than "
    )
    proposed = line.rsplit(" ", 1)[1]
    assert checked(tmp_path, TANK, f"time.end={proposed}") == []
    assert checked(tmp_path, TANK, "time.end=1e9", "time.step=0.2") == []  # it has another limit


SLOW = ("physics.sound_speed=4.47",)


@pytest.mark.parametrize(
    ("sets", "speed", "give"),
    [
        ((), "1.25", "12.5"),
        (("time.end=10",), "1", "10"),
        (("fluids.water.viscosity=1e-4",), "2", "20"),
    ],
)
def test_a_channel_that_gravity_drives_beyond_its_sound_is_warned_of(tmp_path, sets, speed, give):
    [line] = checked(tmp_path, CHANNEL, *SLOW, *sets)
    assert line.startswith("case.toml: physics.sound_speed: 4.47 m/s is less than ten times ")
    assert f" the {speed} m/s that gravity along a periodic axis" in line and f"; give {give}," in line


@pytest.mark.parametrize(
    "sets", [("physics.sound_speed=12.5",), ("fluids.water.viscosity=0.1",), ("time.end=5",)]
)
def test_a_channel_within_its_sound_is_silent(tmp_path, sets):
    assert checked(tmp_path, CHANNEL, *SLOW, *sets) == []


def test_the_derived_speed_of_sound_is_that_of_the_driven_flow(tmp_path):
    """Along a period nothing falls: the length of the channel is no height."""
    for text in (CHANNEL, CHANNEL.replace("[1.0, ", "[2.0, ")):
        scene = Scene(draft(tmp_path, text))
        assert scene.speeds.undriven == 0.0 and scene.layout.up == (0.0, 0.0)
        assert scene.sound_speed == pytest.approx(10 * 0.1 / (8 * 0.01))
    assert checked(tmp_path, CHANNEL) == []
    creeping = Scene(draft(tmp_path, CHANNEL, "fluids.water.viscosity=1.0"))
    assert creeping.expected_speed == pytest.approx(0.0125)
    assert creeping.sound_speed == pytest.approx(10 * (0.1 * 1.0) ** 0.5)


HALF = ("fluids.water.shape.box.upper=[1.0, 0.5]", "space.upper=[1.0, 0.5]", 'space.symmetry=["y.upper"]')
BED = "walls.plates.shape={ box = { lower = [0.0, -0.2], upper = [1.0, 0.0] } }"
FREE = ("walls.plates.condition=mirror", "walls.plates.no_slip=false")


def test_surface_tension_asks_for_its_speed_of_sound(tmp_path):
    """That of the edge of a film of four spacings, √(2σ/ρe); without a tension a drop at rest has none."""
    drop = """
    space = { dimensions = 2, spacing = 0.1 }
    time.end = 1.0
    [fluids.water]
    shape.disc = { center = [0.0, 0.0], radius = 1.0 }
    density = 2.0
    """
    assert Scene(draft(tmp_path, drop, "fluids.water.surface_tension=4.0")).sound_speed == pytest.approx(
        10.0 * (2.0 * 4.0 / (2.0 * 0.4)) ** 0.5
    )
    with pytest.raises(CaseError, match="physics.sound_speed: missing"):
        Scene(draft(tmp_path, drop)).speeds.sound_speed


@pytest.mark.parametrize(
    ("sets", "speed"),
    [
        ((), 1.25),  # g H²/(8ν)
        (HALF, 1.25),  # the same flow
        (("walls.plates.condition=mirror",), 1.25),
        ((*HALF, BED, "walls.plates.condition=mirror"), 1.25),
        (FREE, 2.0),  # g t
        ((*HALF, BED, *FREE), 2.0),
        (("fluids.water.shape.box.upper=[1.0, 0.6]",), 0.45),  # between the plates still, but for a gap
        ((BED, "time.end=60.0"), 5.0),
        (("fluids.water.viscosity=0.0", "walls.plates.no_slip=false"), 2.0),
    ],
)
def test_how_fast_a_flow_between_what_holds_it_back_can_be(tmp_path, sets, speed):
    scene = Scene(draft(tmp_path, CHANNEL, *sets))
    assert driven_speed(scene.census) == pytest.approx(speed)
    assert scene.expected_speed == pytest.approx(speed)


def test_a_slope_has_a_height_across_its_flow_alone(tmp_path):
    """Gravity across and along: the water is as deep as it is, and its pressure is that of its depth."""
    slope = ("physics.gravity=[0.5, -9.8]", "fluids.water.pressure=hydrostatic", "fluids.water.viscosity=0.1")
    scene = Scene(draft(tmp_path, CHANNEL, *slope))
    assert scene.layout.up == (0.0, 1.0) and scene.speeds.undriven == pytest.approx((2 * 9.8 * 1.0) ** 0.5)
    density = scene.starts.states[0].density(np.array([[0.1, 0.5], [0.9, 0.5]]))
    assert density[0] == density[1] == pytest.approx(1000.0 + 4900.0 / scene.sound_speed**2)


def test_nothing_is_hydrostatic_along_a_period(tmp_path):
    with pytest.raises(
        CaseError, match="gravity pulls along periodic axes alone, where nothing has a height"
    ):
        draft(tmp_path, CHANNEL, "fluids.water.pressure=hydrostatic")


POST = "\n[walls.post]\nshape.box = {{ lower = [0.0, 0.0], upper = [{}, 0.7] }}\n"


@pytest.mark.parametrize(("thick", "layers"), [(0.1, 1), (0.2, 2), (0.3, None)])
def test_a_thin_wall_that_is_dry_at_the_start_is_warned_of(tmp_path, thick, layers):
    """A post that the water comes to later."""
    away = TANK.replace("[1.0, 0.5]", "[0.4, 0.5]")
    post = POST.format(0.6 + thick).replace("[0.0, 0.0]", "[0.6, 0.0]")
    lines = checked(tmp_path, away + post)
    if layers is None:
        assert lines == []
    else:
        [line] = lines
        assert line.startswith(f"case.toml: walls.post.shape: {layers} layer")
        assert "make the wall at least 3 spacings (0.3 m) thick" in line


@pytest.mark.parametrize(
    ("place", "told"),
    [
        ("[0.5, -0.1]", True),
        ("[-0.25, 0.3]", True),
        ("[0.5, 0.0]", False),  # on the face
        ("[0.5, -0.04]", False),
        ("[0.5, 0.6]", False),
    ],
)
def test_a_probe_in_a_wall_is_warned_of(tmp_path, place, told):
    for key in (f"probes.P1.position={place}", f"gauges.P1.point.position={place}"):
        lines = checked(tmp_path, TANK, key)
        assert len(lines) == told
        assert all("lies in a wall, where there is no fluid to measure" in line for line in lines)
    foot = "gauges.H.level={ foot = [0.5, -0.2], top = [0.5, 0.7] }"
    assert checked(tmp_path, TANK, foot) == []  # a line may begin in the floor


def test_a_run_up_off_every_slope_is_warned_of(tmp_path):
    gauge = "gauges.tongue.run_up={{foot=[0.2, {}], top=[0.9, 0.6]}}"
    says = "gauges.tongue.run_up.foot: [0.2, 0.5] lies off every wall, body and bed"
    assert any(says in line for line in check(Scene(draft(tmp_path, TANK, gauge.format(0.5)))))
    assert not any("lies off" in line for line in check(Scene(draft(tmp_path, TANK, gauge.format(0.0)))))
    shelf = "walls.shelf={displaces=true, shape={box={lower=[0.1, 0.3], upper=[0.5, 0.5]}}}"
    assert not any(
        "lies off" in line for line in check(Scene(draft(tmp_path, TANK, gauge.format(0.5), shelf)))
    )
