"""The particles of a scene before it runs, as pictures of a run have them."""

from typing import NamedTuple

import numpy as np

from psph.errors import Refused
from psph.fields import FLUID, WALL
from psph.scene.layout import NONE, Layout
from psph.scene.levels import Levels
from psph.scene.parts.part import Part

MOST = 20_000_000
"""Particles that are drawn."""


class AtStart(NamedTuple):
    """What a picture of the start shows: ``frame`` has ``position`` (n, dim) m, ``kind``, ``group``, ``id``
    (n,), ``width``, m, and, as ``values``, the group, the number of one of ``parts``; ``count`` are all
    particles, also those that follow others and are not shown."""

    frame: dict[str, np.ndarray]
    parts: tuple[Part, ...]
    count: int

    @property
    def apart(self) -> str:
        """How far particles are from the next, m: ``"0.04"``, or ``"0.04 to 0.02"`` where that differs."""
        wide = [f"{width:g}" for width in (self.frame["width"].max(), self.frame["width"].min())]
        return " to ".join(dict.fromkeys(wide))


def start_of(layout: Layout) -> AtStart:
    """The sites that parts hold, those behind an open end of their fluid, and particles that are on none; of
    finer regions those that lead.  Raises Refused: too many."""
    parts = tuple(part for part in layout.parts[: layout.parts.ends.start] if part.origin == part.number)
    shown = {part.number: n for n, part in enumerate(parts)}
    places = [*layout.placed.values()]
    found = [np.full(len(x), number) for number, x in layout.placed.items()]
    count, off_sites = sum(map(len, places)), [*layout.placed]
    for begin, end in layout.lattice.chunks():
        held = layout.materials(begin, end)
        sites = (held != NONE) & ~np.isin(held, off_sites)
        count += int(sites.sum())
        if count > MOST:
            raise Refused(
                f"check --draw: {layout.case.file} has more than {MOST:,} particles; draw it coarser, with "
                f"--set space.spacing={2.0 * layout.spacing:g}"
            )
        grid = layout.lattice.grid(begin, end)
        places.append(np.stack([np.broadcast_to(x, held.shape)[sites] for x in grid], axis=1))
        found.append(held[sites])
    held = np.concatenate(found) if found else np.empty(0, int)
    position = np.concatenate(places) if places else np.empty((0, layout.dimensions))
    lead = _lead(layout, held, position)
    held, position = held[lead], position[lead]
    groups = np.array([_of(part, shown) for part in layout.parts], int)[held]
    finer = np.array([part.finer * 2.0**part.level for part in layout.parts])
    free = np.array([part.flows or part.moves_freely for part in parts])
    frame = {
        "position": position,
        "kind": np.where(free[groups], FLUID, WALL) if len(groups) else groups,
        "group": groups,
        "id": np.arange(len(groups)),
        "values": groups.astype(float),
        "width": layout.spacing / finer[held],
    }
    return AtStart(frame, parts, count)


def _of(part: Part, shown: dict[int, int]) -> int:
    """Where the part that is shown for this one stands: that of an open end for its fluid."""
    return shown.get(part.origin, part.source)


def _lead(layout: Layout, held: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Which particles, of the parts ``held`` (n,) and at ``position`` (n, dim), m, follow no others (n,)."""
    levels, parts = Levels(layout), layout.parts
    if levels.count == 1:
        return np.ones(len(held), bool)
    coarse = np.array([part.flows and not part.level for part in parts])[held]
    lead = ~np.array([part.follows for part in parts])[held]
    lead[coarse] = levels.active(0, position[coarse])
    return lead
