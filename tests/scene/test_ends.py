"""What is found of open ends before a run: where they stand, what is refused, what is warned of."""

import numpy as np
import pytest
from cases.test_open_ends import CHANNEL, NOZZLE, PLATES, STREAM
from drafts import draft
from gauging import start

from psph.case import CaseError
from psph.scene import Scene
from psph.scene.checks import check
from psph.scene.end_checks import end_faults, end_warnings
from psph.scene.ends import faces_of

CLOSED = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
pressure = "hydrostatic"
[walls.plates]
shape.difference.from.box = { lower = [-0.6, -FLOOR], upper = [1.6, 1.4] }
shape.difference.minus = [{ box = { lower = [-0.6, 0.0], upper = [1.6, 1.0] } }]
[ends.one]
at = 0.0
inward = "+x"
velocity = 0.0
[ends.two]
at = 1.0
inward = "-x"
pressure = 4905.0
"""


@pytest.mark.parametrize("floor", ["0.4", "2.0"])
def test_a_pressure_is_that_in_the_middle_of_the_fluid(tmp_path, floor):
    """However thick the walls are: not in the middle of all."""
    faces = faces_of(Scene(draft(tmp_path, CLOSED.replace("FLOOR", floor))))
    assert [face.middle[1] for face in faces] == pytest.approx([0.5, 0.5])


def test_who_is_near_a_plane_is_told_by_where_lists_were_made(tmp_path):
    """So that a resumed run finds the same: places have moved since."""
    simulation = start(draft(tmp_path, CHANNEL))
    buffers, store = simulation.engine.of("ends"), simulation.store
    for _ in range(40):
        simulation.step()
    before = buffers.front
    assert abs(np.array(store["position"]) - np.array(store["listed_position"])).max() > 0.0
    buffers.settle()
    for now, then in zip(buffers.front, before):
        np.testing.assert_array_equal(now, then)


LIGHT = "fluids.air={density=1.2,sound_speed=50.0,shape={box={lower=[0.0,0.5],upper=[1.0,1.0]}}}"


def two(folder, *more):
    """A stream of water under air."""
    text = STREAM.format(
        dim=2,
        across=["y"],
        low=[-0.4, 0.0],
        high=[1.4, 1.0],
        zeros=[0.0, 0.0],
        ones=[1.0, 0.5],
        velocity=[1.0, 0.0],
        first=0.0,
        second=1.0,
        way="+x",
        back="-x",
    )
    return draft(folder, text, LIGHT, "fluids.air.velocity=[1.0, 0.0]", *more)


def test_waves_come_back_where_one_answer_would_tear_a_light_fluid(tmp_path):
    """Water and air flow through both ends as they stand; who asks for more is told."""
    case = two(tmp_path)
    assert [face.settle for face in faces_of(Scene(case))] == [None, None]
    simulation = start(case)
    for _ in range(60):
        simulation.step()
    assert abs(simulation.store.shown("velocity") - [1.0, 0.0]).max() < 1e-3
    [line] = end_warnings(Scene(two(tmp_path, 'ends.inlet.waves="out"')))
    assert line.startswith("ends.inlet.waves: out: densities times speeds of sound")


@pytest.mark.parametrize(
    "text, keys, says",
    [
        (NOZZLE, ("ends.nozzle.span.y=[0.2, 0.3]",), "ends.nozzle.span: no lattice site lies behind it"),
        (PLATES, ("ends.inlet.at=-1.0",), "ends.inlet: no fluid stands in front of its plane"),
        (PLATES, ("ends.inlet.layers=2",), "ends.inlet.layers: 2: the kernel reaches over 3 rows"),
        (PLATES, ('ends.inlet={at=0.0,inward="+x",pump="outlet"}',), "ends.inlet.pump: gives a speed and no"),
    ],
)
def test_what_cannot_let_anything_in_is_a_fault(tmp_path, text, keys, says):
    """Control: the same without it."""
    [line] = end_faults(Scene(draft(tmp_path, text, *keys)))
    assert line.startswith(says)
    assert not [*end_faults(Scene(draft(tmp_path, text)))]


BESIDE = """
space = { dimensions = 3, spacing = 0.1, lower = [-0.4, -0.4, 0.0], upper = [1.0, 1.0, 1.0], periodic = ["z"] }
time.end = 1.0
physics.gravity = [0.0, -9.81, 0.0]
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 0.5, 0.5] }
[fluids.oil]
density = 800.0
shape.box = { lower = [0.0, 0.0, 0.5], upper = [1.0, 0.5, 1.0] }
[walls.floor]
shape.box = { lower = [-0.4, -0.4, 0.0], upper = [1.0, 0.0, 1.0] }
[ends.sea]
at = 0.0
inward = "+x"
level = 0.5
"""


def test_fluids_beside_each_other_have_no_column(tmp_path):
    """They are refused.  Controls: of one density, and where a velocity is given."""
    [line] = end_faults(Scene(draft(tmp_path, BESIDE)))
    assert line.startswith("ends.sea.level: is that of layers, and fluids of different density stand beside")
    assert not [*end_faults(Scene(draft(tmp_path, BESIDE, "fluids.oil.density=1000.0")))]
    velocity = 'ends.sea={at=0.0,inward="+x",velocity=0.1}'
    assert not [*end_faults(Scene(draft(tmp_path, BESIDE, velocity)))]


def test_an_end_in_3d_reaches_as_far_as_its_span(tmp_path):
    """Two numbers along each axis across it are no point in space."""
    [face] = faces_of(Scene(draft(tmp_path, BESIDE, "ends.sea.span.z=[0.0, 0.5]")))
    assert (face.lower[2], face.upper[2]) == pytest.approx((0.0, 0.5))


@pytest.mark.parametrize("values, fine", [((0.0, 0.0), False), ((-1.0, 1.0), False), ((0.5, 1.0), True)])
def test_a_profile_needs_a_mean(tmp_path, values, fine):
    """Its shape is told by that."""
    (tmp_path / "prof.csv").write_text("place,u\n0.0,{}\n1.0,{}\n".format(*values))
    profile = 'ends.inlet.profile={file="prof.csv",along="y",place="place",value="u"}'
    found = [*end_faults(Scene(draft(tmp_path, PLATES, profile)))]
    assert (not found) if fine else found[0].startswith("ends.inlet.profile: prof.csv has a mean of")


@pytest.mark.parametrize(
    "text, key, says",
    [
        (CHANNEL, "ends.upstream.at=1.0", "ends.upstream: fluid stands behind its buffer at"),
        (PLATES, "ends.inlet.span.y=[0.3, 0.6]", "ends.inlet: nothing holds what stands behind its plane at"),
        (
            CHANNEL,
            "ends.downstream.span.y=[1.0, 1.4]",
            "ends.downstream.span: begins at a height of 1 m, and",
        ),
        (CHANNEL, "ends.downstream.level=-0.1", "ends.downstream.level: -0.1 m is below the bed"),
        (
            CHANNEL,
            'ends.downstream={at=9.0,inward="-x",pressure=0.0}',
            "ends.downstream.at: 9 m, and fluids and",
        ),
    ],
)
def test_what_is_likely_not_meant_is_said(tmp_path, text, key, says):
    """Control: the same without it."""
    [line] = end_warnings(Scene(draft(tmp_path, text, key)))
    assert line.startswith(says)
    assert not [*end_warnings(Scene(draft(tmp_path, text)))]


@pytest.mark.parametrize("key, moves", [("motion", True), ("no_slip", False)])
def test_a_plane_does_not_ride_on_a_wall(tmp_path, key, moves):
    """Who lets the wall move that holds what stands behind is told, for each end."""
    more = f"walls.plates.{key}=" + ("[{translation={velocity=[0.2, 0.0]}}]" if moves else "false")
    found = [*end_warnings(Scene(draft(tmp_path, PLATES, more)))]
    assert len(found) == 2 * moves
    assert all("walls.plates holds what stands behind its plane and moves" in line for line in found)


@pytest.mark.parametrize(
    "text, keys, says",
    [
        (PLATES, ("ends.inlet.pressure=1.0",), "ends.inlet: velocity and pressure are given"),
        (PLATES, ('ends.inlet.inward="+z"',), 'ends.inlet.inward: "+z": there are 2 axes'),
        (PLATES, ("ends.inlet.span.x=[0.0, 1.0]",), "ends.inlet.span.x"),
        (PLATES, ("ends.inlet.span.y=[1.0, 0.0]",), "ends.inlet.span.y"),
        (PLATES, ('ends.inlet.filled="wine"',), 'ends.inlet.filled: "wine": no fluid has this name'),
        (PLATES, ('ends.outlet={at=2.0,inward="-x",level=1.0}',), "ends.outlet.level: 1.0: a level needs"),
        (PLATES, ('ends.inlet={at=0.0,inward="+x",pump="outle"}',), "ends.inlet.pump"),
        (PLATES, ('ends.inlet.profile="pipe"',), "ends.inlet.profile"),
        (PLATES, ('ends.inlet.on="plate"',), 'ends.inlet.on: "plate": no wall has this name; did you mean'),
        (CHANNEL, ("ends.downstream.ramp=1.0",), "ends.downstream.ramp: 1.0: would let the level grow"),
        (
            CHANNEL,
            ("ends.downstream.pressure=1.0",),
            "ends.downstream: pressure and level are given; give one of",
        ),
        (PLATES, ('ends.inlet.velocity="fast"',), 'ends.inlet.velocity: "fast" is not a number'),
        (CHANNEL, ('ends.downstream.level="fond"',), "\"fond\" is not known; did you mean 'found'?"),
        (
            PLATES,
            ('ends.inlet.profile={file="no.csv",along="y"}',),
            "no.csv: No such file or directory; give a file",
        ),
        (CHANNEL, ("frame.motion.translation.velocity=[1.0, 0.0]",), "ends: stand in a frame that rests"),
    ],
)
def test_what_contradicts_itself_is_refused_in_a_line(tmp_path, text, keys, says):
    """By file, key, value and cure."""
    with pytest.raises(CaseError) as refused:
        draft(tmp_path, text, *keys)
    [line] = refused.value.lines
    assert says in line


def test_ends_that_overlap_are_moved(tmp_path):
    """An end has no shape from which another could be subtracted."""
    both = draft(tmp_path, PLATES, "ends.outlet.at=0.2", 'ends.outlet.inward="+x"')
    with pytest.raises(CaseError) as refused:
        check(Scene(both))
    assert any("ends.outlet: overlaps ends.inlet at" in line for line in refused.value.lines)


DUCT = """
space = {{ dimensions = 3, spacing = 0.1, lower = [-0.5, -0.4, 0.0], upper = [1.5, 1.4, 1.0], {} }}
time.end = 1.0
physics.sound_speed = 15.0
[fluids.oil]
shape.box = {{ lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] }}
[walls.plates]
shape.difference.from.box = {{ lower = [-0.5, -0.4, 0.0], upper = [1.5, 1.4, 1.0] }}
shape.difference.minus = [{{ box = {{ lower = [-0.5, 0.0, 0.0], upper = [1.5, 1.0, 1.0] }} }}]
[ends.inlet]
at = 0.0
inward = "+x"
velocity = 1.0
profile = "parabola"
"""


@pytest.mark.parametrize(
    "key, across",
    [
        ("periodic = ['z']", [1.0, 1.0, 1.0]),
        ("symmetry = ['z.lower', 'z.upper']", [1.0, 1.0, 1.0]),
        ("symmetry = ['z.lower']", [1.5, 1.125, 0.0]),
        ("symmetry = ['z.upper']", [0.0, 1.125, 1.5]),
        ("periodic = []", [0.0, 1.5, 0.0]),
    ],
)
def test_a_parabola_has_sides_where_the_fluid_has(tmp_path, key, across):
    """It repeats with its axis, and goes on behind a plane of symmetry.  The last is the control."""
    [face] = faces_of(Scene(draft(tmp_path, DUCT.format(key))))
    z = np.array([[0.0, 0.5, 0.0], [0.0, 0.5, 0.5], [0.0, 0.5, 1.0]])
    assert face.shape(z) == pytest.approx(1.5 * np.array(across))


def test_a_profile_runs_across_the_end(tmp_path):
    """In 2D not along z."""
    (tmp_path / "prof.csv").write_text("place,value\n0.0,1.0\n1.0,1.0\n")
    for axis in "xz":
        with pytest.raises(CaseError, match="is no axis across the end; give y"):
            draft(tmp_path, PLATES, f'ends.inlet.profile={{file="prof.csv",along="{axis}"}}')


RIDES = 'ends.inlet.on="plates"', 'ends.outlet.on="plates"'


@pytest.mark.parametrize(
    "motion, fine",
    [
        ("[{translation={velocity=[0.2, 0.0]}}]", True),
        ("[{translation={velocity=[0.2, 0.1]}}]", False),
        ("[{rotation={speed=1.0,center=[0.0,0.0]}}]", False),
    ],
)
def test_a_plane_rides_along_its_axis(tmp_path, motion, fine):
    """On a wall that goes along it, which is then no fault and no warning; on another it is a fault."""
    case = draft(tmp_path, PLATES, f"walls.plates.motion={motion}", *RIDES)
    faults = [*end_faults(Scene(case))]
    assert len(faults) == (0 if fine else 2)
    assert all("plates: the motion of this wall is not one along x" in line for line in faults)
    assert not fine or not [*end_warnings(Scene(case))]
    rests = draft(tmp_path, PLATES, *RIDES)
    assert len([*end_faults(Scene(rests))]) == 2


FLUME = """
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, 0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.5, 0.5, 0.5] }
pressure = "hydrostatic"
[walls.flume]
shape.difference.from.box = { lower = [-0.5, -0.4, -0.4], upper = [1.9, 0.9, 0.8] }
shape.difference.minus = [{ box = { lower = [-0.5, 0.0, 0.0], upper = [1.5, 0.5, 0.8] } }]
[ends.sea]
at = 0.0
inward = "+x"
level = 0.5
"""


def test_a_level_above_the_walls_beside_it_is_warned_of(tmp_path):
    assert not [*end_warnings(Scene(draft(tmp_path, FLUME, "ends.sea.level=0.78")))]
    [line] = end_warnings(Scene(draft(tmp_path, FLUME, "ends.sea.level=0.95")))
    assert line.startswith(
        "ends.sea.level: 0.95 m is above what holds the fluid behind its plane towards -y, at"
    )
    higher = FLUME.replace("0.8]", "1.1]")
    assert not [*end_warnings(Scene(draft(tmp_path, higher, "ends.sea.level=0.95")))]


def test_a_level_above_the_span_is_warned_of_where_nothing_lies_upon_it(tmp_path):
    span = "ends.sea.span={y=[0.0, 0.5], z=[0.0, 0.6]}"
    assert not [*end_warnings(Scene(draft(tmp_path, FLUME, span, "ends.sea.level=0.6")))]
    [line] = end_warnings(Scene(draft(tmp_path, FLUME, span, "ends.sea.level=0.75")))
    assert line.startswith("ends.sea.level: 0.75 m is above what the end reaches, to 0.6 m")
    lid = "walls.lid={shape={box={lower=[-0.5, 0.0, 0.6], upper=[1.5, 0.5, 0.8]}}}"
    assert not [*end_warnings(Scene(draft(tmp_path, FLUME, span, lid, "ends.sea.level=0.75")))]


def test_a_body_that_starts_in_a_buffer_is_warned_of(tmp_path):
    raft = "bodies.raft={{density=500.0, shape={{box={{lower=[{}, 0.1, 0.3], upper=[{}, 0.4, 0.5]}}}}}}"
    [line] = end_warnings(Scene(draft(tmp_path, FLUME, raft.format(-0.4, -0.1))))
    assert line.startswith("ends.sea: bodies.raft starts behind its plane")
    assert not [*end_warnings(Scene(draft(tmp_path, FLUME, raft.format(0.5, 0.8))))]
