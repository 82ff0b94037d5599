"""Mirrors in pictures of a plane, planes of symmetry and walls: they have no particles to be seen by."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from psph.case.keys import AXES
from psph.case.shapes import Shape
from psph.output.pictures.groups import spreading_of
from psph.physics.walls.conditions import MIRROR
from psph.scene.lattice import TOLERANCE
from psph.scene.mirrors import around, faces_before
from psph.scene.shapes import bounds


def mirrors_of(case: dict, folder: Path | None = None) -> list[tuple[int, float]]:
    """Axis and place, m, of each mirror of a ``case`` in 2D, its files in ``folder``; of others none."""
    space = case["space"]
    return [*_symmetric(space), *_walls(case, folder)] if space["dimensions"] == 2 else []


def with_mirrors(box: np.ndarray, mirrors: list[tuple[int, float]]) -> np.ndarray:
    """The corners (2, dim) of a box, m, made so large that all mirrors are in it."""
    larger = box.copy()
    for axis, at in mirrors:
        larger[:, axis] = min(at, larger[0, axis]), max(at, larger[1, axis])
    return larger


def _symmetric(space: dict) -> Iterator[tuple[int, float]]:
    for side in space.get("symmetry", ()):
        axis = AXES.index(side[0])
        yield axis, space[side[2:]][axis]


def _walls(case: dict, folder: Path | None) -> Iterator[tuple[int, float]]:
    walls = [wall for wall in case.get("walls", {}).values() if wall.get("condition") == MIRROR]
    if not walls:
        return
    held = around(
        [bounds(Shape.model_validate(one["shape"], context=folder)) for _, one in spreading_of(case)]
    )
    for wall in walls:
        shape, slack = (
            Shape.model_validate(wall["shape"], context=folder),
            TOLERANCE * case["space"]["spacing"],
        )
        yield from ((axis, at) for axis, _, at in faces_before(shape, held, slack))
