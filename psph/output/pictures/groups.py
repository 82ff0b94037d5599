"""How ``group`` counts what holds its form in a case: walls and bodies."""

from psph.physics.walls.conditions import MIRROR

MATTER = ("fluids", "soils", "solids")
"""Tables of a case whose particles forces move, and which may be clamped."""

SOLIDS = ("walls", "bodies")
"""Tables of a case whose shapes have particles that are no fluid, in the order of ``group``."""


def solids_of(case: dict) -> list[dict]:
    """The tables of walls and bodies that have particles, in the order in which ``group`` counts them."""
    solids = [one for table in SOLIDS for one in case.get(table, {}).values()]
    return [one for one in solids if one.get("condition") != MIRROR]


def first_wall(case: dict) -> int:
    """The ``group`` of the first wall, or body: below are fluids, soils, solids, and clamps."""
    matter = [one for table in MATTER for one in case.get(table, {}).values()]
    clamps = sum(len(one.get("clamps", ())) + ("clamped" in one) for one in matter)
    return len(matter) + clamps


def first_body(case: dict) -> int:
    """The ``group`` of the first body, if there are any: those of walls are below."""
    return first_wall(case) + len(solids_of(case)) - len(case.get("bodies", ()))
