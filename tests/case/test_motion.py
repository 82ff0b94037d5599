"""Motions in a case: what is taken, and what is refused in one line before anything starts."""

import json

import numpy as np
import pytest
from drafts import draft, refusal

from psph.case.motion import motion_of
from psph.scene import Scene, check
from psph.scene.motion_checks import motion_lines

SCENE = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 2.0
physics.gravity = [0.0, -9.8]
fluids.water.shape.box = { lower = [0.0, 0.0], upper = [3.0, 0.6] }
[walls.floor]
shape.box = { lower = [0.0, -0.3], upper = [3.0, 0.0] }
"""
TURN = "{ rotation = { speed = 1.0, center = [0.0, 0.0] }"
ROWS = ["time,x,y,angle", "0.0,0.1,0.2,0.0", "0.5,0.2,0.1,0.1", "1.5,0.4,0.1,0.3", "2.0,0.3,0.1,0.2"]


def series(**keys):
    told = {"file": "path.csv", "displacement": ["x", "y"]} | keys
    return f"{{ series = {{ {', '.join(f'{k} = {json.dumps(v)}' for k, v in told.items())} }} }}"


@pytest.fixture
def path(tmp_path):
    """A function: rows of path.csv → writes them."""

    def write(rows):
        (tmp_path / "path.csv").write_text("\n".join(rows) + "\n")

    write(["# measured by hand", *ROWS])
    return write


REFUSED = {
    "no way": ("{}", "walls.floor.motion: does not say how it moves; give one of: translation, "),
    "two ways": (f"{TURN}, translation = [1.0, 0.0] }}", "a part moves in one way, not in 2"),
    "a second part with none": (f"[{TURN} }}, {{}}]", "walls.floor.motion[1]: does not say how it moves"),
    "no point": ("{ rotation = { speed = 1.0 } }", "motion.rotation: turns about a point; give center"),
    "an axis in 2D": (
        "{ rotation = { speed = 1.0, center = [0.0, 0.0], axis = [0.0, 1.0] } }",
        "motion.rotation: turns about z in 2D; remove axis",
    ),
    "a point of nothing": (
        "{ sinusoid = { amplitude = [1.0, 0.0], period = 1.0, center = [0.0, 0.0] } }",
        "motion.sinusoid: center is of a turn, and nothing turns here",
    ),
    "period and frequency": (
        "{ sinusoid = { amplitude = [1.0, 0.0], period = 1.0, frequency = 1.0 } }",
        "motion.sinusoid: give either period or frequency",
    ),
    "neither way nor angle": ("{ sinusoid = { period = 1.0 } }", "give either amplitude, of a displacement"),
    "too many numbers": (
        "{ translation = [1.0, 0.0, 0.0] }",
        "3 numbers in a case with space.dimensions = 2",
    ),
    "an end before the start": (
        f"{TURN}, start = 1.0, end = 0.5 }}",
        "motion.end: is no later than the start",
    ),
    "ramps that do not fit": (f"{TURN}, end = 0.5, ramp = 0.4 }}", "the start and two ramps"),
    "a start before time": (
        f"{TURN}, start = -1.0 }}",
        "motion.start: -1.0 is out of range; it must be at least 0",
    ),
    "a misspelt part": ("{ rotatin = { speed = 1.0 } }", "did you mean 'rotation'?"),
    "no file": (series(file="none.csv"), "none.csv: No such file"),
    "a file elsewhere": (series(file="../path.csv"), "is not a CSV file in the case's folder"),
    "no such column": (series(displacement=["x", "z"]), "has no column 'z', only time, x, y, angle"),
    "one column too few": (
        series(displacement=["x"]),
        "displacement names 1 columns; give one per dimension, 2",
    ),
    "a unit of no angle": (series(angle_unit="degrees"), "angle_unit is of a column of angles; give angle"),
    "no column at all": ("{ series = { file = 'path.csv' } }", "give displacement or angle"),
}

BAD_ROWS = {
    "a hole": ([*ROWS[:2], "0.5,0.2,,0.1", *ROWS[3:]], "line 3: y is nothing; give a number"),
    "a row too short": ([*ROWS[:2], "0.5,0.2", *ROWS[3:]], "line 3 has 2 values for 4 names; fill the hole"),
    "a word": ([*ROWS[:3], "1.5,up,0.1,0.3"], "line 4: x is up; give a number"),
    "not a number": ([*ROWS[:3], "1.5,nan,0.1,0.3"], "line 4: x is nan; give a number"),
    "time that runs backwards": (
        [ROWS[0], ROWS[2], ROWS[1]],
        "line 3: the time 0 s follows 0.5 s; let times rise",
    ),
    "a time twice": ([*ROWS[:3], ROWS[2]], "line 4: the time 0.5 s follows 0.5 s"),
    "one row": (ROWS[:2], "has 1 row; give two at least"),
    "no row": (ROWS[:1], "has 0 rows"),
    "nothing": ([], "is empty"),
    "a file of bytes": (["\0\1\2" * 500], "line 1 is no text; give a CSV file"),
    "a line as long as a file": (["a" * 5000, "1", "2"], "aaa ...; name one of its columns"),
    "a column twice": (["time,x,x", "0,1,2", "1,2,3"], "has more than one column 'x'"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_motion_that_cannot_be_is_refused_in_one_line(name, tmp_path, path):
    motion, says = REFUSED[name]
    [line] = refusal(tmp_path, f"{SCENE}\nmotion = {motion}")
    assert says in line and "walls.floor.motion" in line


@pytest.mark.parametrize("name", BAD_ROWS)
def test_a_series_that_cannot_be_is_refused_in_one_line(name, tmp_path, path):
    rows, says = BAD_ROWS[name]
    path(rows)
    [line] = refusal(tmp_path, f"{SCENE}\nmotion = {series()}")
    assert says in line and "walls.floor.motion.series" in line


def test_a_series_goes_through_its_rows_from_where_the_wall_stands(tmp_path, path):
    case = draft(tmp_path, f"{SCENE}\nmotion = {series(angle='angle', center=[1.0, 0.0])}")
    motion = motion_of(case.walls["floor"].motion)
    for row in ROWS[1:]:
        time, x, y, _ = map(float, row.split(","))
        pose = motion.pose(time)
        assert pose.translation == pytest.approx((1.0 + x - 0.1, y - 0.2, 0.0))
    assert np.arctan2(pose.rotation[3], pose.rotation[0]) == pytest.approx(0.2)
    assert case.versions and not draft(tmp_path, SCENE).versions  # another file is another case


def test_angles_of_a_series_may_be_in_degrees(tmp_path, path):
    motions = {}
    for unit, times in (("radians", 1.0), ("degrees", 180.0 / np.pi)):
        path(["time,angle", "0.0,0.0", *(f"{t},{times * angle}" for t, angle in ((0.5, -0.1), (2.0, 0.25)))])
        told = f"{{ series = {{ file = 'path.csv', angle = 'angle', angle_unit = '{unit}', center = [1.0, 0.0] }} }}"
        given = Scene(draft(tmp_path, f"{SCENE}\nmotion = {told}", "time.end=3.0"))
        motions[unit] = given.case.walls["floor"].motion
        lines = "\n".join(motion_lines(given))
        assert "turns by at most 0.25 rad (14.3 degrees), at 0.3" in lines
        assert ("angle_unit degrees" in lines) == (unit == "degrees")
    poses = [motion_of(motion).pose(1.3).rotation for motion in motions.values()]
    assert poses[0] == pytest.approx(poses[1], abs=1e-14) and abs(poses[0][1]) > 0.05


def test_the_times_of_a_series_count_from_the_start_of_its_part(tmp_path, path):
    """A record whose first time is 1.0: the wall rests before, and is where the rows say at their times."""
    path(["time,x,y,angle", "1.0,0.1,0.2,0.0", "1.5,0.2,0.1,0.1", "2.0,0.4,0.3,0.3"])
    case = draft(tmp_path, f"{SCENE}\nmotion = {series()[:-1]}, start = 0.25 }}")
    motion = motion_of(case.walls["floor"].motion)
    for time, way in ((0.0, (0.0, 0.0)), (1.2, (0.0, 0.0)), (1.75, (0.1, -0.1)), (2.25, (0.3, 0.1))):
        pose = motion.pose(time)
        assert pose.translation == pytest.approx((*way, 0.0)), time
    assert motion.pose(1.2).velocity == (0.0, 0.0, 0.0) != motion.pose(1.5).velocity


def test_a_case_with_motions_reads_back_what_it_wrote(tmp_path, path):
    case = draft(
        tmp_path, f"{SCENE}\nmotion = [{TURN}, ramp = 0.1 }}, {series()}]\n[frame]\nmotion = {TURN} }}"
    )
    again = draft(tmp_path, case.to_toml())
    assert again == case and motion_of(again.frame.motion) == motion_of(case.frame.motion)


WARNED = {
    "through a wall": (
        "{ translation = [0.0, 0.5] }\n[walls.lid]\nshape.box = { lower = [0.0, 0.8], upper = [3.0, 1.0] }",
        "it is in walls.lid",
    ),
    "nearly as fast as sound": (
        "{ translation = [40.0, 0.0] }\n[physics]\nsound_speed = 50.0",
        "0.8 of the speed",
    ),
}


@pytest.mark.parametrize("name", WARNED)
def test_check_warns_of_a_wall_that_runs_through_another_or_is_fast(name, tmp_path):
    motion, says = WARNED[name]
    scene = SCENE.replace("physics.gravity = [0.0, -9.8]\n", "") if "physics" in motion else SCENE
    lines = check(Scene(draft(tmp_path, f"{scene}\nmotion = {motion}")))
    assert sum(says in line and "walls.floor.motion" in line for line in lines) == 1
    assert not any(
        "motion" in line for line in check(Scene(draft(tmp_path, f"{SCENE}\nmotion = {TURN}, end = 0.01 }}")))
    )


def test_check_warns_of_a_series_whose_smooth_curve_leaves_its_rows(tmp_path, path):
    """A jump between rows close together makes the next interval swing; four rows a period of a sine do not."""
    told = f"{SCENE}\nmotion = {series(displacement=['x', 'y'], angle='angle', center=[0.0, 0.0])}"
    rows = [
        "time,x,y,angle",
        "0.0,0.0,0.0,0.0",
        "0.01,0.1,0.0,0.001",
        "0.8,0.1,0.0,0.002",
        "1.2,0.1,0.0,0.002",
    ]
    path(rows)
    [line] = (line for line in check(Scene(draft(tmp_path, told))) if "motion.series" in line)
    assert "walls.floor.motion.series: between its rows at 0.01 and 0.8 s the smooth curve" in line
    path([*rows[:2], *(f"{0.01 + 0.02 * k},0.1,0.0,0.001" for k in range(1, 40))])  # what the line asks for
    near = check(Scene(draft(tmp_path, told)))
    times = np.arange(0.0, 2.01, 0.25)
    path(["time,x,y,angle", *(f"{t},{0.1 * np.sin(np.pi * (2.0 * t - 0.25))},0,0" for t in times)])
    assert not any("motion.series" in line for line in near + check(Scene(draft(tmp_path, told))))


BRICK = """
[bodies.brick]
shape.box = { lower = [1.0, 0.7], upper = [1.4, 1.0] }
density = 500.0
"""


def test_the_motion_of_a_body_is_told_and_warned_of(tmp_path):
    text = f"{SCENE}\n{BRICK}free = []\nmotion = {{ translation = [0.0, -0.5] }}"
    given = Scene(draft(tmp_path, text, "physics.sound_speed=4.0"))
    lines = "\n".join(motion_lines(given))
    assert "motion      bodies.brick: translation velocity [0, -0.5]" in lines
    assert "at most 1 m from its start, 0.5 m/s (0.12 c)" in lines
    fast, through = (line for line in check(given) if "bodies.brick.motion" in line)
    assert "0.5 m/s is 0.12 of the speed of sound" in fast and "it is in walls.floor" in through


def test_a_body_that_moves_freely_is_not_run_through(tmp_path):
    """A floor that rises to where a body is at the start: the body is no longer there; a fixed one is."""
    rising = f"{SCENE}\nmotion = {{ translation = [0.0, 0.5] }}\n{BRICK}"
    assert not any("it is in" in line for line in check(Scene(draft(tmp_path, rising))))
    [line] = (line for line in check(Scene(draft(tmp_path, f"{rising}free = []"))) if "it is in" in line)
    assert "walls.floor.motion: at" in line and "it is in bodies.brick" in line


FRAMES = {
    "a frame that turns over a period": (
        'periodic = ["x"]\nlower = [0.0, -0.3]\nupper = [3.0, 1.0]',
        f"{TURN} }}",
        "a frame that turns has no periodic axis",
    ),
    "a frame beside a mirror": (
        'symmetry = ["x.lower"]\nlower = [0.0, -0.3]\nupper = [3.0, 1.0]',
        "{ translation = [1.0, 0.0] }",
        "does not work with mirrors",
    ),
}


@pytest.mark.parametrize("name", FRAMES)
def test_frames_that_cannot_be_are_refused(name, tmp_path):
    space, motion, says = FRAMES[name]
    text = SCENE.replace("space = { dimensions = 2, spacing = 0.1 }\n", "")
    [line] = refusal(
        tmp_path, f"{text}\n[frame]\nmotion = {motion}\n[space]\ndimensions = 2\nspacing = 0.1\n{space}"
    )
    assert says in line and "frame.motion" in line


def test_a_mirror_stands_still_and_a_belt_has_no_motion_beside(tmp_path):
    for key, says in (
        ("velocity = [1.0, 0.0]", "of a wall that stands"),
        ('condition = "mirror"', "a mirror moves before gases alone"),
    ):
        [line] = refusal(tmp_path, f"{SCENE}\nmotion = {TURN} }}\n{key}")
        assert says in line
