"""What others bring from outside the package, without editing it: it computes, and it is parallel."""

import json
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from gauging import start
from jobs import mpirun
from long import long_but_for

from psph.case import CaseError, load
from psph.case.extensions import versions
from psph.runs.resume import case_digest

HERE = Path(__file__).parent

SCENE = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, -0.5], upper = [4.0, 1.5] }
time.end = 1.0
parallel.axis = "x"
physics.sound_speed = 20.0
physics.gravity = [0.0, -9.8]
physics.artificial_viscosity = 0.1
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [3.0, 0.6] }, jitter = 0.1 }
walls.floor.shape.box = { lower = [0.0, -0.3], upper = [4.0, 0.0] }
"""

GUESTS = {
    "elastic": "physics.elasticity = 1e4",
    "curvature": "physics.curvature = 0.5",
    "swinging": "walls.floor.motion.swinging = { amplitude = [0.03, 0.0], frequency = 20.0 }",
    "rolling": "walls.side = { shape.box = { lower = [1.0, 0.7], upper = [2.0, 0.9] }, "
    "motion.rolling = { amplitude = 0.4, frequency = 10.0, center = [1.5, 0.9] } }",
    "passing": """regions.sink.drain = { lower = [1.2, 0.3], upper = [1.6, 0.7] }
regions.source.spring = { start = [3.6, 0.8], end = [3.6, 1.1], spacing = 0.1, speed = 30.0 }""",
    "dust": "dust.silt = { shape.box = { lower = [0.5, 0.1], upper = [2.5, 0.5] }, density = 200.0, "
    "stopping_time = 0.02 }",
}
"""Of each file what a case says to use it."""


@pytest.fixture
def case(tmp_path):
    """A function: names of guests, further lines → the path of a case that uses them."""

    def make(*names, more=""):
        for name in names:
            shutil.copy(HERE / f"{name}.py", tmp_path)
        path = tmp_path / "guests.toml"
        used = [f"{name}.py" for name in names]
        lines = "\n".join([f"use = {json.dumps(used)}", *(GUESTS[name] for name in names), more])
        path.write_text(f"{lines}\n{SCENE}")
        return path

    return make


def begin(path):
    return start(load(path))


STEPS = 24


@pytest.mark.landing
@pytest.mark.parametrize(
    "guests",
    long_but_for((tuple(GUESTS),), [tuple(GUESTS), *((name,) for name in GUESTS)], tuple),
)
def test_the_same_bits_on_1_to_4_ranks_and_with_a_restart(guests, case):
    search = os.pathsep.join(sys.path)
    job = mpirun(4, [HERE / "together.py", case(*guests), STEPS], timeout=170, env={"PYTHONPATH": search})
    assert job.returncode == 0, job.stderr
    found = json.loads(job.stdout.splitlines()[-1])
    digests = {way: value for way, value in found.items() if " on " in way}
    assert len(digests) == 8 and len(set(digests.values())) == 1, digests
    if "passing" in guests:
        assert found["next id"] > found["particles"]  # some came, some went


def test_a_wall_that_swings_is_where_it_belongs_after_any_number_of_steps(case):
    simulation = begin(case("swinging"))
    store = simulation.store
    for _ in range(STEPS):
        simulation.step()
    wall = store.shown("kind") == 1
    turn = 2.0 * np.pi * 20.0 * simulation.time
    away = store.shown("position")[wall] - store.shown("anchor")[wall]
    away[:, 0] -= 4.0 * np.rint(away[:, 0] / 4.0)
    assert away[:, 0] == pytest.approx(0.03 * np.sin(turn), rel=1e-12) and not away[:, 1].any()
    speed = 2.0 * np.pi * 20.0 * 0.03 * np.cos(turn)
    assert store.shown("velocity")[wall][:, 0] == pytest.approx(speed, rel=1e-12)
    assert simulation.speed > 0.999 * abs(speed)  # the time step and the lists know of it


def test_sums_of_the_same_step_come_in_a_pass_of_their_own(case):
    simulation = begin(case("curvature"))
    first, last = simulation.plan.passes
    assert first.effects == () and first.stores == ("normal",) and last.brought == ("normal",)
    simulation.step()
    store, normal = simulation.store, simulation.store.owned_rows("normal")
    simulation.engine.sum_columns(first, store.low, store.low + store.owned)
    assert np.array_equal(normal, store.owned_rows("normal"))  # nothing has moved since
    assert normal.any()


def test_without_guests_a_scene_has_one_pass_and_no_stage_for_them(tmp_path, case):
    path = case()
    plan = begin(path).plan
    assert (
        len(plan.passes) == 1 and not plan.materials.motions and not plan.of("regions") and not plan.evolving
    )
    assert len(begin(case("passing")).stages) == len(begin(case()).stages) + 1


def test_a_sheared_solid_swings_back_where_a_fluid_flows_on(case):
    """The control: without stiffness the shear stays."""

    def shear(stiffness):
        path = case("elastic")
        text = path.read_text().replace("= 1e4", f"= {stiffness}").replace("-9.8", "0.0")
        text = text.replace("jitter = 0.1", "velocity_gradient = [[0.0, 5.0], [0.0, 0.0]]")
        text = text.replace("walls.floor", "# walls.floor")
        path.write_text(text)
        simulation = begin(path)
        for _ in range(STEPS):
            simulation.step()
        place, u = simulation.store.owned_rows("position"), simulation.store.owned_rows("velocity")
        return np.polyfit(place[:, 1], u[:, 0], 1)[0], simulation.store.owned_rows("stress")

    stiff, stress = shear(2e5)
    soft, none = shear(0.0)
    assert soft > 4.0 and stiff < 0.7 * soft
    assert np.median(stress[:, 1]) > 0.0 and not none.any()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x = 1", "has no CATALOGUE"),
        ("def f(:", "SyntaxError"),
        ("raise KeyError(3)", "KeyError: 3"),
    ],
)
def test_a_file_that_brings_nothing_is_refused_in_one_line(text, says, tmp_path, case):
    path = case()
    (tmp_path / "mine.py").write_text(text)
    path.write_text(path.read_text().replace("use = []", 'use = ["mine.py"]'))
    with pytest.raises(CaseError, match=says) as refused:
        load(path)
    assert len(str(refused.value).splitlines()) == 1 and "use" in str(refused.value)


def test_a_checkpoint_and_a_study_know_what_a_file_said(tmp_path, case):
    path = case("curvature")
    before = load(path)
    assert case_digest(load(path)) == case_digest(before)
    mine = tmp_path / "curvature.py"
    mine.write_text(mine.read_text().replace("-self.strength", "-2.0 * self.strength"))
    assert case_digest(load(path)) != case_digest(before)
    assert versions(load(path).catalogue) != versions(before.catalogue) != []
    assert versions(load(case()).catalogue) == []


@pytest.mark.parametrize("name", ["../mine.py", "/etc/mine.py", "mine.toml", "none.py"])
def test_only_python_files_of_the_case_s_folder_are_used(name, case):
    path = case()
    path.write_text(path.read_text().replace("use = []", f'use = ["{name}"]'))
    with pytest.raises(CaseError, match="use: "):
        load(path)


def test_a_used_file_that_leaves_the_program_is_refused(case):
    path = case()
    (path.parent / "leaves.py").write_text("raise SystemExit(3)\n", encoding="utf-8")
    path.write_text(path.read_text().replace("use = []", 'use = ["leaves.py"]'))
    with pytest.raises(CaseError, match="leaves.py: SystemExit: 3"):
        load(path)
