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


def solids_of(case: dict) -> list[dict]:
    """The tables of walls and bodies that have particles, in the order in which ``group`` counts them."""
    rigid = (table for table, of in PLACED.items() if of.rigid)
    solids = [one for table in rigid for one in case.get(table, {}).values()]
    return [one for one in solids if one.get("condition") != MIRROR]


def first_wall(case: dict) -> int:
    """The ``group`` of the first wall, or body: below are fluids, soils, solids, and clamps."""
    matter = [one for _, one in matter_of(case)]
    clamps = sum(len(one.get("clamps", ())) + ("clamped" in one) for one in matter)
    return len(matter) + clamps


def first_body(case: dict) -> int:
    """The ``group`` of the first body, if there are any: those of walls are below."""
    return first_wall(case) + len(solids_of(case)) - len(case.get("bodies", ()))
