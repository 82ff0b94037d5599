"""What is exported of a frame: its fields, what the particles are, and what frames do not hold."""

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from psph.case.loader import load_to_read
from psph.output.checkpoint import COPY
from psph.output.errors import NotThere
from psph.output.reader import Run
from psph.scene import Scene
from psph.scene.parts.part import LOOKS

PARTS = LOOKS
"""What ``part`` counts.  ``kind`` of the frames does not tell walls from bodies."""


class Exported:
    """The run in ``folder`` with what its case says of the particles; frames near ``times`` s, or all."""

    def __init__(self, folder: Path, times: Sequence[float] | None):
        self.run = Run(folder)
        self.times = self.run.times
        if not len(self.times):
            raise NotThere(f"{self.run.path}: no frame yet; wait for the first one")
        self.chosen = range(len(self.times)) if times is None else self.run.nearest(times)
        self.units = {"mass": "kg"} | {name: self.run.unit(name) for name in self.run.fields}

    @cached_property
    def scene(self) -> Scene:
        """The scene of the run, without what a script gave it."""
        case, _ = load_to_read(self.run.folder / COPY)
        return Scene(case)

    @property
    def stem(self) -> str:
        """The name of the run, with which its files begin."""
        return self.run.path.stem

    @property
    def names(self) -> tuple[str, ...]:
        """Of fluids, solids, walls and bodies, in the order of ``group``."""
        return tuple(species.name for species in self.scene.species)

    @cached_property
    def masses(self) -> np.ndarray:
        """Mass of a particle of each group where frames do not tell it, kg; per m of depth in 2D, per m² in
        1D."""
        return np.array([species.mass for species in self.scene.species])

    @cached_property
    def levels(self) -> np.ndarray:
        """How many times the spacing is halved of a particle of each group (psph.scene.levels)."""
        return np.array([species.level for species in self.scene.species])

    @cached_property
    def support(self) -> float:
        """Radius in m beyond which the kernel is zero."""
        return self.scene.support

    def parts(self, group: np.ndarray) -> np.ndarray:
        """Which of PARTS each particle is of, uint8 (n,), by its ``group`` (n,)."""
        return np.array([PARTS.index(part.looks) for part in self.scene.layout.parts], np.uint8)[group]


def in_space(rows: np.ndarray, dimensions: int) -> np.ndarray:
    """Vectors (n, dim) with three components, those that are missing 0; other fields as they are."""
    if rows.ndim == 2 and rows.shape[1] == dimensions:
        return np.pad(rows, ((0, 0), (0, 3 - dimensions)))
    return rows
