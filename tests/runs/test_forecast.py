"""How long a run will take is guessed, and warned of where it is hopeless."""

import re
from pathlib import Path

import pytest
from drafts import TANK, draft

from psph.case import load
from psph.runs.explain import explain
from psph.runs.forecast import forecast, long_run
from psph.scene import Scene, check
from psph.simulation.plan import make_plan

CASES = Path(__file__).parents[2] / "run" / "cases"


def warned(folder, *overrides, ranks=1):
    """The warning on a tank."""
    scene = Scene(draft(folder, TANK, *overrides))
    return [line.replace(f"{folder}/case.toml: ", "") for line in long_run(scene, make_plan(scene), ranks)]


def test_a_viscosity_that_takes_billions_of_steps_is_warned_of(tmp_path):
    [line] = warned(tmp_path, "fluids.water.viscosity=7000", "space.spacing=0.01", "time.end=10.0")
    assert re.match(
        r"time\.end: 10 s takes about 3\.3e\+09 steps and, at a guess, \d+ d \d\d h on 1 rank; ", line
    )
    assert line.endswith(
        "fluids.water.viscosity = 7000 m²/s sets the step: it is the kinematic viscosity, 1e-6 for water "
        "and 0.01 for honey"
    )
    assert warned(tmp_path, "fluids.water.viscosity=0.01") == []


def test_a_long_run_of_few_particles_is_warned_of(tmp_path):
    [line] = warned(tmp_path, "time.end=1e5")
    assert "sound (CFL) limits the step: take a larger space.spacing, an earlier time.end" in line


def test_explain_says_how_long_a_run_takes(tmp_path):
    scene = Scene(draft(tmp_path, TANK, "space.spacing=0.01", "time.end=60.0"))
    one, two = (forecast(scene, make_plan(scene), ranks) for ranks in (1, 2))
    assert one.steps == two.steps and 1.5 < one.seconds / two.seconds <= 2.0
    text = "\n".join(explain(scene, 2))
    assert re.search(r"run time            about \d+ min \d\d s on 2 ranks, a guess by the pace", text)


MEASURED = {"dam_break": 11.0, "dam_break_3d": 21.0, "hydrostatic": 210.0}
"""Seconds on two ranks, the first two of 30 November 2026."""


@pytest.mark.parametrize("name", MEASURED)
def test_the_guess_is_within_a_factor_of_what_was_measured(name):
    scene = Scene(load(CASES / f"{name}.toml"))
    found = forecast(scene, make_plan(scene), 2)
    assert 0.5 < found.seconds / MEASURED[name] < 2.0


def test_levels_of_longer_steps_take_less_of_each():
    """The slot: about a minute on one core, of 14,836 particles with steps four times as long, 3,024 twice."""
    scene = Scene(load(CASES / "refined/slot.toml"))
    plan = make_plan(scene)
    assert sum(kind.waiting(plan) for kind in plan.matter) == 0.75 * 14_836 + 0.5 * 3_024
    assert 0.5 < forecast(scene, plan, 1).seconds / 60.0 < 2.0


def test_a_gas_that_falls_together_is_expected_to_be_heated_by_that():
    """The run has 249 steps; 21 as hot as it starts, which without a pull is all that is known."""
    scene = Scene(load(CASES / "gravity/collapse.toml"))
    assert 80 < forecast(scene, make_plan(scene), 1).steps < 250
    weak = Scene(load(CASES / "gravity/collapse.toml", ["physics.self_gravity.constant=1e-9"]))
    assert forecast(weak, make_plan(weak), 1).steps == 21
    text = "\n".join(explain(scene, 1))
    assert "after a fall at 1.42 m/s" in text


WARNED = {
    "thrown": "physics.sound_speed: 20 is below ten times the expected speed",
    "heaving_sphere": "physics.sound_speed: 25 is below ten times the expected speed",
    "pile_in_waves": "physics.sound_speed: 25 is below ten times the expected speed",
    "submerged_slide": "but it touches soils.wedge of 1950 kg/m3 too",
    "overtopped_dam": "but it touches fluids.water of 1000 kg/m3 too",
    "cone": "bodies.cone.shape: 2 layers of particles at [0.0125, 0.0125, 0.2625]",
}
"""A particle that is thrown far faster than the speed of sound allows for, on purpose; deep water
that nothing makes fall, twice; sand that slides along the wall of the water, wherever it starts; water that comes to
stand where the bed bears sand; and the tip of a cone, which is thin."""


@pytest.mark.parametrize("file", sorted(CASES.rglob("*.toml")), ids=lambda file: file.stem)
def test_no_shipped_case_is_warned_of(file):
    scene = Scene(load(file))
    lines = [*check(scene), *long_run(scene, make_plan(scene), 1)]
    if file.stem in WARNED:
        assert len(lines) == 1 and WARNED[file.stem] in lines[0]
    else:
        assert lines == []
