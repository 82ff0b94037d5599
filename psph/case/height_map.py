"""Ground by its heights over a grid, from a file: ``shape.height_map``."""

from functools import cache
from pathlib import Path
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from pydantic import Strict

from psph.case.columns import cells_of, numbers_of
from psph.case.drawing import Drawing
from psph.case.files import Found, Unfit
from psph.case.keys import Text, key
from psph.errors import LONGEST_QUOTE, shortened

MOST_HEIGHTS = 4_000_000
"""Of a map: 2000 by 2000."""

GRID = ".asc"
"""The ending of an ESRI ASCII grid, which programs for maps write."""

HEAD = ("ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "nodata_value")


class Heights(NamedTuple):
    """Heights over a grid: ``sides``, the rising coordinates, m, along each horizontal axis; ``level`` an
    array with as many axes, m."""

    sides: tuple[np.ndarray, ...]
    level: np.ndarray


class HeightMap(Drawing):
    """All below a ground whose heights stand in a file, straight between its points; in 2D and 3D."""

    kind: ClassVar[str] = "a CSV file or an ESRI ASCII grid (.asc)"
    instead: ClassVar[str] = "a file with as many columns"
    endings: ClassVar[tuple[str, ...]] = (".csv", ".txt", ".dat", GRID)

    file: Text = key(
        "CSV file of points on a grid, in any order, with a line of names, or ESRI ASCII grid (.asc, in "
        "3D), in the case's folder or below"
    )
    bottom: float = key("height at which the shape ends below", unit="m")
    columns: Annotated[tuple[Text, ...], Strict(False)] | None = key(
        "names of the columns of a CSV file: x, in 3D y, and the height, all in m",
        None,
        otherwise="all, in their order",
        min_length=2,
        max_length=3,
    )

    @property
    def heights(self) -> Heights:
        """What stands in the file.  Raises Unfit."""
        return heights_of(self.found, self.columns)

    @property
    def only_in(self) -> int:
        """The dimension of space that the file is made for."""
        return len(self.heights.sides) + 1

    def read(self) -> None:
        """Look at what stands in the file.  Raises Unfit."""
        highest = float(self.heights.level.max())
        if not highest > self.bottom:
            raise Unfit(
                f"{self.found.path}: no height is above bottom = {self.bottom:g} m, the largest is "
                f"{highest:g} m; give a lower bottom"
            )


@cache
def heights_of(found: Found, columns: tuple[str, ...] | None) -> Heights:
    """The heights in a file.  Raises Unfit, with file, line and value."""
    if found.path.suffix.lower() == GRID:
        if columns:
            raise Unfit(f"{found.path} is an ASCII grid, which has no columns; remove columns")
        return _of_grid(found.path)
    names, lines, rows = _points(found.path, columns)
    *places, level = rows.T
    sides, number = zip(*(np.unique(x, return_inverse=True) for x in places))
    shape = tuple(map(len, sides))
    cell = np.ravel_multi_index(number, shape)
    order = np.argsort(cell, kind="stable")
    twice = np.flatnonzero(np.diff(cell[order]) == 0)
    if len(twice):
        line = lines[order[twice[0] + 1]]
        raise Unfit(f"{found.path}: line {line}: this point was given before; give each once")
    if min(shape) < 2:
        which = names[int(np.argmin(shape))]
        raise Unfit(f"{found.path}: all points have one {which}; give two at least along each axis")
    if len(cell) < np.prod(shape):
        free = np.setdiff1d(np.arange(np.prod(shape)), cell)[0]
        at = ", ".join(
            f"{name} = {x[k]:g}" for name, x, k in zip(names, sides, np.unravel_index(free, shape))
        )
        gaps = int(np.prod(shape)) - len(cell)
        raise Unfit(
            f"{found.path}: a grid of {' x '.join(map(str, shape))} points has {gaps:,} gaps, the first at "
            f"{at}; fill them"
        )
    whole = np.empty(shape)
    whole.ravel()[cell] = level
    return Heights(sides, whole)


def _points(path: Path, columns: tuple[str, ...] | None) -> tuple[list[str], list[int], np.ndarray]:
    """Names of the columns, numbers of the lines, and the points (n, 2 or 3) of a CSV file."""
    names, cells = cells_of(path, MOST_HEIGHTS)
    wanted = list(columns or names)
    if len(wanted) not in (2, 3):
        raise Unfit(
            f"{path} has {len(wanted)} columns, and a map has x, in 3D y, and the height; name those in "
            "columns"
        )
    return wanted, [n for n, _ in cells], numbers_of(path, names, cells, wanted)


def _of_grid(path: Path) -> Heights:
    """An ESRI ASCII grid: six lines of a name and a number, then rows of heights from north to south."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise Unfit(f"{path} is no text in UTF-8; give an ESRI ASCII grid") from None
    except OSError as error:
        raise Unfit(f"{path}: {error.strerror or error}; give a file that can be read") from None
    head: dict[str, float] = {}
    first = 0
    for first, line in enumerate(lines):
        words = line.split()
        if len(words) != 2 or words[0].lower() not in HEAD:
            break
        head[words[0].lower()] = _number(path, first + 1, words[1])
    for name in ("ncols", "nrows", "cellsize"):
        if name not in head:
            raise Unfit(f"{path} has no {name} at its beginning; give an ESRI ASCII grid")
    counts, size = (int(head["ncols"]), int(head["nrows"])), head["cellsize"]
    if min(counts) < 2 or counts[0] * counts[1] > MOST_HEIGHTS or not size > 0.0:
        raise Unfit(
            f"{path}: a grid of {counts[0]} x {counts[1]} cells of {size:g} m; give two at least along each "
            f"axis, {MOST_HEIGHTS:,} at most in all, and a size above 0"
        )
    rows = []
    for n, line in enumerate(lines[first:], first + 1):
        words = line.split()
        if words and len(words) != counts[0]:
            raise Unfit(f"{path}: line {n} has {len(words)} heights, and ncols is {counts[0]}; fill the hole")
        row = [_number(path, n, word) for word in words]
        if (none := head.get("nodata_value")) in row:
            raise Unfit(f"{path}: line {n}: {none:g} stands for no data; fill the gaps")
        rows += [row] if row else []
    if len(rows) != counts[1]:
        raise Unfit(f"{path} has {len(rows)} rows of heights, and nrows is {counts[1]}; give them all")
    corners = [
        head.get(f"{axis}llcenter", head.get(f"{axis}llcorner", 0.0) + 0.5 * size) for axis in ("x", "y")
    ]
    sides = tuple(low + size * np.arange(count) for low, count in zip(corners, counts))
    return Heights(sides, np.array(rows)[::-1].T.copy())


def _number(path: Path, line: int, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not abs(value) < 1e30:
        raise Unfit(f"{path}: line {line}: {shortened(word, LONGEST_QUOTE)}; give a number")
    return value
