"""What `check` says of solids: what cannot be, and what is likely a slip."""

import pytest
from drafts import draft

from psph.case import CaseError
from psph.fields import SOLID
from psph.scene import Scene, check
from psph.simulation.plan import make_plan

BEAM = """
space = { dimensions = 2, spacing = 0.01 }
time.end = 0.1
physics.gravity = [0.0, -2.0]
[solids.beam]
shape.box = { lower = [-0.1, 0.0], upper = [0.4, 0.05] }
clamped.box = { lower = [-0.1, 0.0], upper = [0.0, 0.05] }
density = 1000.0
young = 1.4e6
poisson = 0.4
"""

END = "solids.beam.clamps.end={shape={box={lower=[0.3,0.0],upper=[0.4,0.05]}},"

WATER = "fluids.water={shape={box={lower=[1.0,0.0],upper=[2.0,1.0]}}}"


def said(tmp_path, *overrides):
    """The lines of warnings, or of the error."""
    try:
        return "\n".join(check(Scene(draft(tmp_path, BEAM, *overrides))))
    except CaseError as error:
        return "\n".join(error.lines)


def test_a_sound_beam_is_good(tmp_path):
    assert said(tmp_path) == ""
    anvil, gauge = (
        "anvils.floor={at=[0.0,0.0],normal=[0.0,2.0]}",
        "gauges.a.displacement={of='beam',at=[0.4,0.05]}",
    )
    assert said(tmp_path, anvil, gauge, "physics.contact={}") == ""


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        (["solids.beam.poisson=0.5"], "solids.beam.poisson: 0.5 is out of range; it must be"),
        (["solids.beam.young=-1.0"], "solids.beam.young: -1.0 is out of range; it must be above 0"),
        (["solids.beam.hardening=1e6"], "solids.beam.hardening: 1000000.0: an elastic solid does not harden"),
        (
            ["solids.beam.yield_stress=1e4", "solids.beam.law=neo-hookean"],
            'solids.beam.law: "neo-hookean": a solid that yields has a law of its own',
        ),
        (
            ["solids.beam.yield_stress=1e4", "solids.beam.johnson_cook.yield_stress=1e4"],
            "solids.beam.yield_stress: 10000.0: johnson_cook has a yield_stress of its own",
        ),
        (
            ["anvils.wall={at=[0.0,-1.0],normal=[0.0,0.0]}"],
            "anvils.wall.normal: [0.0, 0.0]: has no direction",
        ),
        (["solids.beam.young=off"], "solids.beam.young: missing; add young"),
        (["solids.beam.law=hooke"], 'solids.beam.law: "hooke" is not known'),
        (
            ["solids.beam.clamped.box={lower=[5.0,0.0],upper=[6.0,1.0]}"],
            "solids.beam.clamped: holds no particle of the solid; let the shapes meet",
        ),
        (
            ["solids.beam.clamps.end={shape={box={lower=[5.0,0.0],upper=[6.0,1.0]}}}"],
            "solids.beam.clamps.end: holds no particle of the solid; let the shapes meet",
        ),
        (
            ["solids.beam.clamps.end={shape={box={lower=[-0.05,0.0],upper=[0.1,0.05]}}}"],
            "solids.beam.clamps.end: shares 25 particles with solids.beam.clamped; let each be in one clamp",
        ),
        (
            ["solids.beam.clamps.end={motion={translation=[1.0,0.0]}}"],
            "solids.beam.clamps.end.shape: missing; add shape",
        ),
        (["solids.beam.motion={translation=[1.0,0.0]}"], "solids.beam.motion"),
        (["solids.beam.clamped.motion={translation=[1.0,0.0]}"], "solids.beam.clamped"),
        (
            [END + "motion={rotation={speed=1.0}}}"],
            "solids.beam.clamps.end.motion.rotation: turns about a point; give center",
        ),
        (
            [END + "motion={translation=[1.0]}}"],
            "solids.beam.clamps.end.motion.translation: [1.0]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            [END + "motion={piston={height=0.1,period=1.0,depth=1.0,absorb={}}}}"],
            "solids.beam.clamps.end.motion: a wall may absorb waves, a clamp not; remove absorb",
        ),
        (
            [END + "motion={series={file='no.csv',displacement=['x','y']}}}"],
            "solids.beam.clamps.end.motion.series",
        ),
        (
            [END + "motion={rotation={speed=100.0,center=[0.0,0.0]}}}"],
            "solids.beam.clamps.end.motion.rotation.speed: 100 rad/s is 15.9 turns a second",
        ),
        (
            ["solids.beam.shape.box.upper=[0.4,0.02]"],
            "solids.beam.shape: 2 particles thick along y: it will bend too softly; give space.spacing = 0.005",
        ),
        (["solids.beam.shape.box.upper=[0.4,0.01]"], "solids.beam.shape: one particle thick along y"),
        (["solids.beam.young=1.0"], "solids.beam.young: waves of 0.0463 m/s"),
        (["solids.beam.young=1e15"], "solids.beam.young: 1e+15 Pa, and diamond has 1.2e12"),
        (
            ["solids.beam.velocity=[100.0,0.0]"],
            "guards.speed: 1, and the solids start at 1.83 speeds of sound",
        ),
        (["solids.beam.hourglass=0.0"], "solids.beam.hourglass: 0 leaves zigzags"),
        (
            ["solids.beam.loads.end={shape={box={lower=[7.0,0.0],upper=[8.0,1.0]}},force=[0.0,1.0]}"],
            "solids.beam.loads.end.shape: no particle of the solid lies in it",
        ),
        (
            ["solids.beam.loads.end={shape={box={lower=[0.3,0.0],upper=[0.4,1.0]}},force=[1.0]}"],
            "solids.beam.loads.end.force: [1.0]: 1 number in a case with space.dimensions = 2; give 2",
        ),
        (
            ["walls.floor={shape={box={lower=[0.0,-1.0],upper=[1.0,-0.5]}}}"],
            "walls.floor: solids do not feel walls without contact; give physics.contact = {}",
        ),
        (
            [
                "physics.contact={}",
                "walls.floor={shape={box={lower=[0.0,-1.0],upper=[1.0,-0.5]}},no_slip=true}",
            ],
            "walls.floor.no_slip: says what a fluid meets, and there is none",
        ),
        (["solids.beam.flaws=5.0"], "solids.beam.flaws: 5.0: without critical_stretch nothing cracks"),
        (["solids.beam.critical_stretch=0.0"], "solids.beam.critical_stretch: 0.0 is out of range"),
        (["physics.contact={damping=1.5}"], "physics.contact.damping: 1.5 is out of range"),
        (
            ["solids.end={shape={box={lower=[1.0,0.0],upper=[1.5,0.05]}},density=1e3,young=1e6,poisson=0.3}"],
            "solids: beam, end do not feel each other, and run through each other where they meet; give phys",
        ),
        (
            ["solids.beam.continues=water"],
            'solids.beam.continues: "water": there is no fluid to see the solid',
        ),
        (["solids.beam.poisson=0.495"], "solids.beam.poisson: 0.495: above 0.49 a solid hardly bends"),
        (
            ["solids.beam.clamped.box={lower=[-1.0,-1.0],upper=[1.0,1.0]}"],
            "solids.beam: its clamps hold all of it; leave a part of it free",
        ),
        (
            ["solids.beam.loads.end={shape={box={lower=[-0.1,0.0],upper=[0.0,1.0]}},force=[0.0,1.0]}"],
            "solids.beam.loads.end: all particles that it pulls are clamped",
        ),
        (
            [
                "solids.beam.yield_stress=1e4",
                "solids.beam.mie_gruneisen={slope=1.5,gruneisen=2.0,sound_speed=10.0}",
            ],
            "solids.beam.mie_gruneisen.sound_speed: 10 m/s, where young and poisson give 48.3 m/s to the bulk",
        ),
        (
            ["anvils.floor={at=[0.0,0.02],normal=[0.0,2.0]}"],
            "anvils.floor: solids.beam reaches 0.02 m behind it at the start, and will fly off",
        ),
        (
            ["gauges.a.displacement={of='beam',at=[0.4,0.2]}"],
            "gauges.a.displacement.at: [0.4, 0.2] lies off solids.beam; give a point in it or on its face",
        ),
        (["probes.p.position=[0.2,0.02]"], "probes.p: measures fluids, and there are none; give gauges"),
        (["precision=mixed"], 'precision: "mixed": solids are computed in double precision'),
        (["physics.sound_speed=10.0"], "physics.sound_speed: 10.0: solids have waves of their own"),
        (["gauges.a.displacement={of='bean',at=[0.4,0.0]}"], "gauges.a.displacement.of"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, overrides, says):
    assert says in said(tmp_path, *overrides)


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("solids.beam.shape.box.upper=[0.4,0.01]", "solids.beam.shape: one particle thick along y"),
        ("solids.beam.shape.box.upper=[0.4,0.02]", "solids.beam.shape: 2 particles thick along y"),
        ("solids.beam.young=1.0", "solids.beam.young: waves of 0.0463 m/s"),
        ("solids.beam.density=1e5", "solids.beam.density: 100000 kg/m3"),
        ("solids.beam.clamped.box.upper=[0.4,0.05]", "solids.beam: its clamps hold all of it"),
    ],
)
def test_of_updated_solids_too(override, says, tmp_path):
    updated = ('scheme="solid"', "solids.beam.description=updated")
    assert said(tmp_path, *updated) == ""
    assert says in said(tmp_path, *updated, override)


def test_clamped_and_free_particles_share_the_solid(tmp_path):
    scene = Scene(draft(tmp_path, BEAM))
    assert scene.census.sizes.tolist() == [40 * 5, 10 * 5]
    assert [one.name for one in scene.species] == ["beam", "beam (clamped)"]
    assert [one.mobile for one in scene.species] == [True, False]
    assert [one.kind for one in scene.species] == [SOLID, SOLID] and not any(
        s.is_fluid for s in scene.species
    )
    plan = make_plan(scene)
    assert not plan.passes and plan.materials.bonded_to.tolist() == [0, 0] and plan.materials.free == 1
    assert "drawn" not in plan.arrays


def test_the_step_is_that_of_the_fastest_wave(tmp_path):
    plan = make_plan(Scene(draft(tmp_path, BEAM)))
    h = 0.01 * 2.0**0.5
    assert plan.longest_step(1.0, 0.0)[0] == pytest.approx(0.6 * h / (54.772 + 1.0), rel=1e-4)
    assert plan.longest_step(0.0, 1e9) == (pytest.approx(0.6 * (h / 1e9) ** 0.5), "force")


def test_the_copy_of_a_case_in_its_run_can_be_read_again(tmp_path):
    """It names all keys, those of a wall that solids alone meet too."""
    wall = "walls.floor={shape={box={lower=[0.0,-1.0],upper=[1.0,-0.5]}}}"
    case = draft(tmp_path, BEAM, "physics.contact={}", wall, END + "motion={translation=[1.0,0.0]}}")
    assert draft(tmp_path, case.to_toml()).as_tables() == case.as_tables()
