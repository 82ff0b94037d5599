"""How many particles fill a cell of the lattice: one, or more in a solid of a finer spacing."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.physics.facts import Facts


class OneEach(NamedTuple):
    """Every particle fills a cell."""

    def sharing(self, i):
        """1."""
        return 1.0


class Shared(NamedTuple):
    """Particles of solids with a finer spacing share cells."""

    def sharing(self, i):
        """How many particles fill the cell of particle i."""
        return i.cell_count


Cells = OneEach | Shared

sharing = call_by_type("sharing")
"""(cells, i) → how many particles fill the cell of i: see :class:`Shared`."""


def cells_of(scene: Facts) -> Cells:
    """Whether particles of a scene share cells."""
    return Shared() if any(one.cell_count > 1 for one in scene.species) else OneEach()
