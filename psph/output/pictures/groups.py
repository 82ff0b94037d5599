"""How ``group`` counts what is not fluid in a case: walls and bodies."""

from psph.physics.walls.conditions import MIRROR

SOLIDS = ("walls", "bodies")
"""Tables of a case whose shapes have particles that are no fluid, in the order of ``group``."""


def solids_of(case: dict) -> list[dict]:
    """The tables of walls and bodies that have particles, in the order in which ``group`` counts them."""
    solids = [one for table in SOLIDS for one in case.get(table, {}).values()]
    return [one for one in solids if one.get("condition") != MIRROR]


def first_body(case: dict) -> int:
    """The ``group`` of the first body, if there are any: those of fluids and walls are below."""
    return len(case.get("fluids", ())) + len(solids_of(case)) - len(case.get("bodies", ()))
