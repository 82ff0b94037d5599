"""Whose particles a gauge of what flows counts."""

from collections.abc import Iterator

import numpy as np

from psph.fields import FLUID, GAS

ALL: tuple[int, ...] = ()
"""In place of groups: all that flows."""


def counted(kinds: np.ndarray, of: tuple[int, ...]) -> np.ndarray:
    """Which groups count, by their ``kinds`` (groups,): those ``of`` these numbers, or ALL that flows."""
    flows = (kinds == FLUID) | (kinds == GAS)
    if not of:
        return flows
    among = np.zeros(len(kinds), bool)
    among[list(of)] = True
    return flows & among


def groups_named(scene, name: str) -> Iterator[int]:
    """The groups of what has a name: of what keeps its neighbours the clamped parts among them, of a fluid, a
    wall or a body those of other sizes."""
    parts = scene.layout.parts
    for part in parts:
        whole = parts[part.whole]
        if name in (part.name, parts[part.origin].name) or whole.keeps_neighbours and name == whole.name:
            yield part.number
