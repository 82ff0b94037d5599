"""Where particles appear and where they vanish.

A region is a typed value, as an effect is, with one or more of these methods, of plain numpy arrays:

    vanish(position, velocity, time)  → True (n,) for the particles that leave the simulation
    appear(begun, ended)              → position, velocity (n, dim) of those that come in between two
                                        times, m and m/s, the same on every rank
    next_time(time)                   → when it has to be asked again, s; else only when lists are made

It is asked after a drift, before new lists are made.  ``into`` names the fluid that comes.
"""

import math
from typing import Any


def is_source(region: Any) -> bool:
    """Whether particles appear in a region."""
    return hasattr(region, "appear")


def is_sink(region: Any) -> bool:
    """Whether particles vanish in a region."""
    return hasattr(region, "vanish")


def next_time(regions, time: float) -> float:
    """When the first of some regions has to be asked again, s; infinite where none says."""
    times = (region.next_time(time) for region in regions if hasattr(region, "next_time"))
    return min(times, default=math.inf)
