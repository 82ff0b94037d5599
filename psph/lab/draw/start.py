"""The particles of a scene before it runs, as pictures of a run have them."""

from typing import NamedTuple

import numpy as np

from psph.errors import Refused
from psph.fields import FLUID, WALL
from psph.scene.layout import NONE, Layout

MOST = 20_000_000
"""Particles that are drawn."""


class AtStart(NamedTuple):
    """What a picture of the start shows: ``frame`` has ``position`` (n, dim) m, ``kind``, ``group``, ``id``
    (n,), ``width``, m, and, as ``values``, the group; ``names`` are those of the groups."""

    frame: dict[str, np.ndarray]
    names: tuple[str, ...]


def start_of(layout: Layout) -> AtStart:
    """The sites that parts hold, those behind an open end of their fluid, and particles that are on none.
    Raises Refused: too many."""
    first_end = layout.parts.ends.start
    group = np.arange(NONE + 1)
    group[first_end : len(layout.parts)] = [part.source for part in layout.parts[first_end:]]
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
        found.append(group[held[sites]])
    groups = np.concatenate(found) if found else np.empty(0, int)
    finer = np.array([part.finer for part in layout.parts[:first_end]], float)
    free = np.array([part.flows or part.moves_freely for part in layout.parts[:first_end]])
    frame = {
        "position": np.concatenate(places) if places else np.empty((0, layout.dimensions)),
        "kind": np.where(free[groups], FLUID, WALL) if len(groups) else groups,
        "group": groups,
        "id": np.arange(len(groups)),
        "values": groups.astype(float),
        "width": layout.spacing / finer[groups],
    }
    return AtStart(frame, layout.names[:first_end])
