"""The stages of a step, and those that kinds of matter add."""

from types import SimpleNamespace

import pytest

from psph.errors import Refused
from psph.kinds import Kind
from psph.simulation import stages
from psph.work import Stage

OWN = Stage(stages.nothing, stages.nothing)


def plan_with(before: str):
    """A plan with a kind of matter that has a stage before that of this name."""

    class Other(Kind):
        name = "other"

        def stages(self):
            return {before: OWN}

    return SimpleNamespace(matter=(Other(None),))


def test_the_stage_of_a_kind_comes_before_that_which_it_names():
    found = list(stages.stages_of(plan_with("kick")))
    assert (
        found[found.index(stages.OF_EVERY_STEP["kick"]) - 1] is OWN
        and len(found) == len(stages.OF_EVERY_STEP) + 1
    )


def test_a_stage_before_one_that_there_is_not_is_refused():
    """It would never run, and nothing would say so."""
    with pytest.raises(Refused, match="other: stages: kik: no such stage; give one of predict, "):
        list(stages.stages_of(plan_with("kik")))
