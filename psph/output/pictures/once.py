"""Frames of a run with finer regions (``space.refine``) as pictures have them: each bit of water once."""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from psph.fields import BUFFER
from psph.output.pictures.groups import spreading_of, standing_of
from psph.output.sizes import of_sizes, widths


def reads_of(case: Mapping, saved: tuple[str, ...]) -> set[str]:
    """The fields that :func:`once` reads of frames that hold those ``saved``."""
    return {"kind", *of_sizes(saved), *(("group",) if _finest(case) else ())}


def once(frame: Mapping[str, np.ndarray], case: Mapping) -> dict[str, np.ndarray]:
    """A frame with the ``width`` (n,) of its particles, m; of finer regions without those who follow others,
    and with walls, bodies and fluids of all sizes in one ``group`` each, as without such regions."""
    if not (finest := _finest(case)):
        return {**frame, "width": widths(frame, case["space"])}
    lead = frame["kind"] != BUFFER
    seen = {name: rows[lead] for name, rows in frame.items()}
    group, level = order(len(spreading_of(case)), len(standing_of(case)), finest)
    width = widths(seen, case["space"]) * 0.5 ** level[seen["group"]]
    return seen | {"group": group[seen["group"]], "width": width}


@lru_cache(maxsize=8)
def order(fluids: int, rigid: int, finest: int) -> tuple[np.ndarray, np.ndarray]:
    """Of each group of a run with so many ``fluids``, ``rigid`` walls and bodies, and levels up to the
    ``finest``: that which it is without finer regions, and its level (psph.scene.parts.order)."""
    water, still = [*range(fluids)], [*range(fluids, fluids + rigid)]
    found = [(one, level) for level in range(1 + finest) for one in water]
    found += [(one, 0) for one in still]
    found += [(one, level) for level in range(1 + finest) for one in (still if level else []) + water]
    group, level = np.array(found).T
    return group, level


def _finest(case: Mapping) -> int:
    """The finest level of sizes, 0 without finer regions."""
    refined = case["space"].get("refine", ())
    return max((one["factor"].bit_length() - 1 for one in refined), default=0)
