"""Whose particles a gauge of what flows counts."""

import numpy as np

from psph.fields import FLUID, GAS

ALL: tuple[int, ...] = ()
"""In place of groups: all that flows."""


def counted(kinds: np.ndarray, of: tuple[int, ...]) -> np.ndarray:
    """Which groups count, by their ``kinds`` (groups,): those ``of`` these numbers, or ALL that flows."""
    flows = np.isin(kinds, (FLUID, GAS))
    return flows & np.isin(np.arange(len(kinds)), of) if of else flows
