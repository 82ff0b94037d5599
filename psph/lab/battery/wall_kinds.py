"""Walls of every condition in the same trials."""

from pathlib import Path

from psph.lab.battery import command
from psph.lab.battery.comparison import Comparison, judging
from psph.lab.battery.tables import SECONDS
from psph.lab.battery.trials import BATTERY, Bound, Trial
from psph.physics.walls.conditions import CONDITIONS, STICKING

SHOWN = {
    "tank": ("probe_error", "probe_spread", "noise", "energy", SECONDS),
    "dam break": ("front_begun_later", "front_error", "speed", "lost", "energy", SECONDS),
    "sloshing": ("noise", "speed", "energy", SECONDS),
    "cavity": ("ghia_error", "near_5", "voids", "speed", SECONDS),
}
"""Trials and the measures shown of each, the main one first."""


def _of_case(case: str) -> Trial:
    return next(trial for trial in BATTERY if trial.case == case)


def _walls(*names: str) -> dict[str, tuple[str, ...]]:
    """The keys that give all walls of a case one condition, by the condition; no_slip where it works."""
    found = {}
    for kind in CONDITIONS:
        keys = [f"condition={kind}", *([] if kind in STICKING else ["no_slip=false"])]
        found[kind] = tuple(f"walls.{name}.{key}" for name in names for key in keys)
    return found


def _judging(name: str, case: str, end: float, *walls: str, holds=()) -> Trial:
    trial = _of_case(case)
    return judging(trial, name, _walls(*walls), shown=SHOWN[name][0], end=end, holds=holds or trial.holds)


TRIALS = (
    _judging("tank", "tank", 10.0, "tank"),
    _judging("dam break", "dam_break", 2.0, "tank", holds=(Bound("speed", most=2.0),)),
    _judging("sloshing", "sloshing", 10.0, "tank"),
    _judging("cavity", "cavity", 20.0, "basin", "lid"),
)

WALLS = Comparison("walls", "condition", TRIALS, SHOWN, measures_down=True)


def walls(comm, out: Path | None) -> None:
    """Run them into the folder ``out``; collective."""
    command.compare(comm, WALLS, out)
