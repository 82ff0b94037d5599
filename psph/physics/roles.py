"""Roles that one effect of a case can have at most."""

from typing import NamedTuple


class Role(NamedTuple):
    """What an effect does that no second one may do: ``does`` in words, as of that other effect."""

    name: str
    does: str


ORDER = Role("order", "shifts particles too")
"""Shifts particles into order."""

CARRIER = Role("carrier", "moves particles too")
"""Moves particles with another velocity than that of the fluid."""

FRICTION = Role("friction", "takes the place of the viscous stress too")
"""Takes the place of the viscous stress of fluids."""

ROLES = (ORDER, CARRIER, FRICTION)
