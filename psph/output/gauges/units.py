"""Units of what gauges measure."""

from psph.output.probes import FRONT, MEASURED

LENGTHS = ("level", "wetted", FRONT, "centre", "displacement")

PER_DEPTH = {"force": "N", "tension": "N", "moment": "N m"}
"""In 2D per metre of depth."""


def quantity_of(column: str) -> tuple[str, str]:
    """``box.force_x`` → ``force`` and ``x``; ``box.tension_left`` → ``tension`` and ``left``."""
    quantity = column.rpartition(".")[2]
    if quantity == "mass_flow":
        return quantity, ""
    field, _, part = quantity.partition("_")
    return field, part


def unit_of(field: str, dimensions: int) -> str:
    """The unit of a quantity."""
    if field in LENGTHS:
        return "m"
    if field in PER_DEPTH:
        return PER_DEPTH[field] + ("/m" if dimensions == 2 else "")
    if field in MEASURED:
        return MEASURED[field].unit
    others = {"turn": "rad", "spin": "rad/s", "flow": ("m/s", "m²/s", "m³/s"), "mass_flow": "kg/s"}
    unit = others[field]
    return unit[dimensions - 1] if isinstance(unit, tuple) else unit
