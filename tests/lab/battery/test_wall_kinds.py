"""The same trials with walls of every condition."""

import pytest

from psph.case import load
from psph.lab.battery.command import CASES
from psph.lab.battery.wall_kinds import TRIALS
from psph.physics.walls.conditions import CONDITIONS, STICKING


@pytest.mark.parametrize("trial", TRIALS, ids=lambda trial: trial.case)
def test_every_condition_fits_every_trial_and_what_can_stick_does(trial):
    sticks = any(wall.no_slip for wall in load(CASES / f"{trial.case}.toml").walls.values())
    assert sticks == (trial.case == "cavity")
    for condition in CONDITIONS:
        walls = load(CASES / f"{trial.case}.toml", trial.overrides(condition)).walls.values()
        assert {wall.condition for wall in walls} == {condition}
        assert all(wall.no_slip == (sticks and condition in STICKING) for wall in walls)
