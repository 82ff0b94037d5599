"""Units of what gauges measure."""

from psph.output.probes import FRONT, MEASURED

LENGTHS = ("level", "wetted", "run_up", "height", FRONT, "centre", "displacement")

PER_DEPTH = dict.fromkeys(("force", "tension", "anchor_tension", "reaction"), "N")
PER_DEPTH |= dict.fromkeys(("moment", "reaction_moment"), "N m")
"""In 2D per metre of depth."""

VOLUMES = {"volume": ("m", "m²", "m³"), "mass": ("kg/m²", "kg/m", "kg")}
"""By the number of dimensions: per square metre in 1D, per metre of depth in 2D."""

FLOWS = {"flow": ("m/s", "m²/s", "m³/s"), "mass_flow": ("kg/(m² s)", "kg/(m s)", "kg/s")}
"""By the number of dimensions: per square metre of area in 1D, per metre of depth in 2D."""

STRESSES = ("stress", "mean_stress", "von_mises")

OF_TWO_WORDS = ("anchor_tension", "mass_flow", "mean_stress", "reaction_moment", "run_up", "von_mises")
"""Quantities whose name is not the first word of their column."""


def quantity_of(column: str) -> tuple[str, str]:
    """``box.force_x`` → ``force`` and ``x``; ``box.tension_left`` → ``tension`` and ``left``."""
    quantity = column.rpartition(".")[2]
    for field in OF_TWO_WORDS:
        if quantity.startswith(field):
            return field, quantity.removeprefix(field).removeprefix("_")
    field, _, part = quantity.partition("_")
    return field, part


def unit_of(field: str, dimensions: int) -> str:
    """The unit of a quantity."""
    if field in LENGTHS:
        return "m"
    if field in STRESSES:
        return "Pa"
    if field in PER_DEPTH:
        return PER_DEPTH[field] + ("/m" if dimensions == 2 else "")
    if field in MEASURED:
        return MEASURED[field].unit
    if by_dimension := FLOWS.get(field) or VOLUMES.get(field):
        return by_dimension[dimensions - 1]
    return {"turn": "rad", "spin": "rad/s", "beyond": "m³/m"}[field]
