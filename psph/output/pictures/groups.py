"""How ``group`` counts what holds its form in a case: walls and bodies."""

from psph.case import Case
from psph.case.placed import Placed
from psph.physics.walls.conditions import MIRROR

PLACED = Case.tables_of(Placed)
"""Tables of a case whose entries have particles, in the order of ``group``."""


def matter_of(case: dict) -> list[tuple[str, dict]]:
    """Name and table of all that forces move particle by particle, and that may be clamped."""
    tables = (case.get(table, {}) for table, of in PLACED.items() if not of.rigid)
    return [one for named in tables for one in named.items()]


def spreading_of(case: dict) -> list[tuple[str, dict]]:
    """The same of what keeps no form: it comes first."""
    tables = (case.get(table, {}) for table, of in PLACED.items() if not of.keeps_form)
    return [one for named in tables for one in named.items()]


def standing_of(case: dict) -> list[dict]:
    """The tables of what is rigid and has particles, in the order in which ``group`` counts them."""
    rigid = (table for table, of in PLACED.items() if of.rigid)
    found = [one for table in rigid for one in case.get(table, {}).values()]
    return [one for one in found if one.get("condition") != MIRROR]


def wholes_of(case: dict) -> dict[str, dict]:
    """The tables of what forces move as a whole, by name: ``group`` counts it last."""
    return {name: one for table in _of_wholes() for name, one in case.get(table, {}).items()}


def wholes_called(case: dict) -> str:
    """These in one word: the name of the only one, or of their table; empty where there is none."""
    found = [*wholes_of(case)]
    return found[0] if len(found) == 1 else next((one for one in _of_wholes() if case.get(one)), "")


def first_wall(case: dict) -> int:
    """The ``group`` of the first that is rigid: below is what forces move particle by particle, and what is
    held of it."""
    held = (of.held_parts(one) for table, of in PLACED.items() for one in case.get(table, {}).values())
    return len(matter_of(case)) + sum(held)


def first_whole(case: dict) -> int:
    """The ``group`` of the first that forces move as a whole, if there are any: those of walls are below."""
    return first_wall(case) + len(standing_of(case)) - len(wholes_of(case))


def _of_wholes() -> list[str]:
    return [table for table, of in PLACED.items() if of.whole]
