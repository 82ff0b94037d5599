"""What the elastic solids of a case are made of, and the planes that they may hit."""

import math

from psph.physics.solid.material import MADE_OF, Solid, solid_of


def solids_of(case) -> tuple[Solid, ...]:
    """The elastic solids of a case, in its order."""
    return tuple(
        solid_of(
            name,
            **{key: getattr(table, key) for key in MADE_OF},
            johnson_cook=table.johnson_cook and dict(table.johnson_cook),
        )
        for name, table in case.solids.items()
    )


def anvils_of(case) -> tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]:
    """A point of each anvil of a case in m, and the unit vector out of it."""
    tables = case.anvils.values()
    return tuple((one.at, tuple(n / math.hypot(*one.normal) for n in one.normal)) for one in tables)
