"""Where particles are finer: levels of sizes, each with half the spacing of the one before.

Level 0 fills the scene.  Level l fills its region R_l and a margin around it, REACHES supports wide.  In R_l,
and outside R_{l+1}, its particles move by their own forces; elsewhere they follow those of another level.
A particle of level l is a corner of the cell of a coarser one, and counts to R_l by the middle of that cell:
so the corners change sides with it, and what is there once stays there once, wherever the border is.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import Any, NamedTuple

import numpy as np

from psph.case.keys import AXES
from psph.fields import VECTOR, Field, Same, Turned
from psph.moments import normalised
from psph.physics.motion import is_prescribed
from psph.scene.forms.form import Faces, Form, chosen
from psph.scene.forms.make import form_of
from psph.scene.level_ways import way_of
from psph.scene.shapes import Corner, bounds
from psph.smoothing import kernel

LENGTH, DIVIDED, CORNER = "own_length", "divided", "corner"
"""Names of the fields: the smoothing length of its level; 1 where finer ones stand in its place; which corner
of a coarser particle's cell it is."""

SHARE = Field("share", "1", "share of its level of sizes in what presses on the nearest face", image=Same)
SLOPE = Field("share_slope", "1/m", "gradient of that share along the face", VECTOR, image=Turned)

REACHES = 3.0
"""Supports of a level between its region and the end of its margin: a particle at the border has neighbours
all around, and so have these.  The third leaves those who are born time to find their order before they lead:
with two, a wave through borders stirs eddies of twice the energy."""

LASTS = 0.5
"""Spacings of the coarser level beyond a margin at which particles die, and the coarser one may divide once
more: where it went that far, they went with it.  Two distances would lose or double whoever turns between."""

STRAYS = 0.5
"""Supports of the finest level by which what carries a region may have gone on before new lists are made."""

TIE = 1e-3
"""Spacings about a border within which particles go on as they are, and half of it inside of which a row has
to begin so as to count to the region: where one stands on the border, rounding would let the coarse ones
change sides without their corners."""

BAND = 4.0
"""Spacings of the coarser level, about a border, within which both push on walls and bodies: with 2, and
shares that have kinks, it would count by up to 1 % of the pressure how rows lie to it."""

WIDE, FADES = 6.0, 2.0
"""Spacings of the coarser level.  Both sides of a gap narrower than WIDE - FADES have one share, those of one
wider than WIDE have each its own; between the two widths the one passes into the other."""

AROUND = 3.0
"""Supports of a level by which its region is larger than that of the next: a margin, and who is followed."""


class Gaps(NamedTuple):
    """What is across from some faces: the place of another ``beyond`` a gap (n, dim), m, the ``width`` of the
    gap (n,), m, and how far both are ``facing`` each other, 1 where they do and 0 where not (n,)."""

    beyond: np.ndarray
    width: np.ndarray
    facing: np.ndarray

    def of(self, rows: np.ndarray) -> "Gaps":
        """Those of some rows alone."""
        return Gaps(*(array[rows] for array in self))


@dataclass(frozen=True, eq=False)
class Levels:
    """The levels of sizes of a ``layout``, 0 the coarsest."""

    layout: Any

    @cached_property
    def moved(self) -> np.ndarray:
        """How far each region is from where it was drawn, m (regions, dim): who moves them writes it."""
        return np.zeros((len(self.layout.case.space.refine), self.layout.dimensions))

    @cached_property
    def count(self) -> int:
        """How many there are."""
        return 1 + max((one.levels for one in self.layout.case.space.refine), default=0)

    def spacing(self, level: int) -> float:
        """dx of a level, m."""
        return self.layout.spacing * 0.5**level

    def smoothing_length(self, level: int) -> float:
        """h of a level, m."""
        return self.layout.smoothing_length * 0.5**level

    def support(self, level: int) -> float:
        """Radius of the kernel of a level, m."""
        return self.layout.support * 0.5**level

    def margin(self, level: int) -> float:
        """How far outside of its region particles of a level are, m: whole spacings of the coarser one."""
        coarser = self.spacing(level - 1)
        return math.ceil(REACHES * self.support(level) / coarser - 1e-6) * coarser

    @property
    def widest(self) -> float:
        """How far outside of regions finer particles may be before new lists are made, m."""
        stray = 1.0 + STRAYS * any(one.moves for one in self.layout.case.space.refine)
        return self.margin(1) + LASTS * self.spacing(0) + stray * self.support(self.count - 1)

    def nearest(self, points: np.ndarray) -> tuple[int, float]:
        """The region that ever comes nearest to some ``points`` (n, dim), m, as the coarsest particles around
        it know it, and how far all of them are then outside of that, m."""
        away = [self._away(n, 1, way.back(points)).min() for n, way in enumerate(self._ways)]
        return int(np.argmin(away)), float(min(away))

    def _around(self, level: int) -> float:
        """How much larger the region of the next coarser level is than that of a level, m: whole spacings of
        what is around that, so that sites of both fit."""
        wide, coarser = self.margin(level) + AROUND * self.support(level - 1), self.spacing(max(level - 2, 0))
        return math.ceil(wide / coarser - 1e-6) * coarser

    def outside(self, level: int, points: np.ndarray) -> np.ndarray:
        """How far ``points`` (n, dim) are outside of the region of a level, m (n,); below 0 inside of it."""
        if not 0 < level < self.count:
            return np.full(len(points), -np.inf if level == 0 else np.inf)
        refine = enumerate(self.layout.case.space.refine)
        away = (self._away(n, level, points) for n, one in refine if one.levels >= level)
        return reduce(np.minimum, away)

    def _border(self, level: int, points: np.ndarray) -> Faces:
        """The border of the region of a level that is nearest to each of some ``points`` (n, dim)."""
        refine = enumerate(self.layout.case.space.refine)
        found = [self._faces(n, level, points) for n, one in refine if one.levels >= level]
        return chosen(found, np.argmin)

    def active(self, level: int, points: np.ndarray) -> np.ndarray:
        """Whether particles of a level on its sites ``points`` (n, dim) m move by their own forces (n,)."""
        middles = self.middles(level, points, self.corners(level, points))
        border = -0.5 * TIE * self.layout.spacing
        return (self.outside(level, middles) < border) & ~(self.outside(level + 1, points) < border)

    def shares(self, level: np.ndarray, points: np.ndarray, gaps: Gaps) -> tuple[np.ndarray, np.ndarray]:
        """The share of a ``level`` (n,) each in what all levels tell together at some ``points`` (n, dim), m:
        they pass from one to the next within BAND spacings about the border (n,); and its gradient, 1/m (n,
        dim).  Both sides of narrow ``gaps`` have the share of the one that is farther inside."""
        found, slope = np.zeros(len(points)), np.zeros(points.shape)
        for one in range(self.count):
            own = np.flatnonzero(level == one)
            (inner, inwards), (next_finer, to_finer) = (
                self._within_gaps(n, points[own], gaps.of(own)) for n in (one, one + 1)
            )
            found[own], slope[own] = inner - next_finer, inwards - to_finer
        return found, slope

    def _within_gaps(self, level: int, points: np.ndarray, gaps: Gaps) -> tuple[np.ndarray, np.ndarray]:
        """What :meth:`_within` says, of the place in ``gaps`` that is farther inside."""
        found, slope = self._within(level, points)
        part = gaps.facing * np.clip((WIDE - gaps.width / self.spacing(max(level - 1, 0))) / FADES, 0.0, 1.0)
        narrow = np.flatnonzero(part > 0.0)
        if len(narrow):
            beyond, to_beyond = self._within(level, gaps.beyond[narrow])
            part = part[narrow] * (beyond > found[narrow])
            found[narrow] += part * (beyond - found[narrow])
            slope[narrow] += part[:, None] * (to_beyond - slope[narrow])
        return found, slope

    def _within(self, level: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """1 well inside of the region of a level, 0 well outside (n,), and how that grows, 1/m (n, dim)."""
        if not 0 < level < self.count:
            return np.full(len(points), float(level == 0)), np.zeros(points.shape)
        (away, normal), band = self._border(level, points), self.band(level)
        t = np.clip(0.5 - away / band, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t), -(6.0 * t * (1.0 - t) / band)[:, None] * normal

    def band(self, level: int) -> float:
        """How wide the band about the border of the region of a level is where both push on walls, m."""
        return BAND * self.spacing(max(level - 1, 0))

    def corners(self, level: int, points: np.ndarray) -> np.ndarray:
        """Which corner of a coarser cell each of some sites ``points`` (n, dim) m of a level is (n,)."""
        sites = np.floor((points - np.array(self.layout.lattice.origin)) / self.spacing(level))
        return (sites.astype(np.int64) % 2) @ 2 ** np.arange(points.shape[1])[::-1] * (level > 0)

    def to_corners(self, level: int) -> np.ndarray:
        """From the middle of a cell to the particles of a finer ``level`` in it (2^dim, dim), m."""
        return self.layout.lattice.within_cell(2) * 0.5 ** (level - 1)

    def middles(self, level: int, points: np.ndarray, corner: np.ndarray) -> np.ndarray:
        """The middles of the coarser cells of which particles of a level at ``points`` (n, dim) m are the
        ``corner`` (n,)."""
        return points - self.to_corners(level)[corner.astype(np.int64)] if level else points

    def away(self, level: int, points: np.ndarray, corner: np.ndarray) -> np.ndarray:
        """How far particles of a level at ``points`` (n, dim), the ``corner`` (n,) of coarser cells, are
        outside of its region, m (n,): by the middles of these cells.  Where a middle is in a wall or outside
        the domain it is by the points themselves: coarser water is not there, and a corner that sank to the
        floor stays."""
        middles = self.middles(level, points, corner)
        found, own = self.outside(level, middles), self.outside(level, points)
        astray = np.flatnonzero((found > own) & (own < 0.0))
        closed = astray[self._closed(middles[astray])] if len(astray) else astray
        found[closed] = own[closed]
        return found

    def _closed(self, points: np.ndarray) -> np.ndarray:
        """Which of some points (n, dim), m, are in walls that rest or outside the domain (n,)."""
        layout = self.layout
        rest = [n for n in layout.parts.walls if not is_prescribed(layout.parts[n].motion)]
        x = [layout.folded(d, along) for d, along in enumerate(points.T)]
        beyond = [(a < low) | (a > up) for a, low, up in zip(x, layout.lower, layout.upper)]
        return np.logical_or.reduce([np.isin(layout.held(x, x[0].shape), rest), *beyond])

    def sites(self, level: int, extra: float = 0.0, room: tuple[Corner, Corner] | None = None) -> np.ndarray:
        """The sites (n, dim), m, of a level in its region, its margin and ``extra`` m more; where a box is
        told as ``room``, in that alone and wherever the region may come."""
        lattice, points = self.layout.lattice, []
        wide, outside = self.margin(level) + extra, self.outside if room is None else self.ever
        for first, last in lattice.chunks():
            grid, shape = lattice.grid(first, last), lattice.shape(first, last)
            middle = np.stack([np.broadcast_to(x, shape).ravel() for x in grid], axis=1)
            middle = middle if room is None else middle[self._near_box(middle, *room)]
            middle = middle[outside(level, middle) < wide + self.layout.spacing]
            for one in range(1, level):
                middle = self._divided(one, middle)
            points.append(self._divided(level, middle[outside(level, middle) < wide]))
        return np.concatenate(points)

    def _divided(self, level: int, middle: np.ndarray) -> np.ndarray:
        """The particles of a level (2^dim n, dim), m, around the ``middle`` of each coarser cell (n, dim), m:
        one step of sizes after the other, as they are born, so that a row on the end of a margin is there
        for finer ones as for the coarser."""
        return (middle[:, None, :] + self.to_corners(level)).reshape(-1, middle.shape[1])

    def held(
        self, level: int, number: int, extra: float = 0.0, room: tuple[Corner, Corner] | None = None
    ) -> np.ndarray | None:
        """Those of :meth:`sites` that a part of the layout has; None without any."""
        points = self.sites(level, extra, room)
        found = self.layout.held([*points.T], (len(points),)) if len(points) else np.zeros(0)
        return points[found == number] if (found == number).any() else None

    def around(self, number: int) -> int:
        """The finest level whose region has the middle of a part of the layout."""
        if self.count == 1:
            return 0
        lower, upper = bounds(self.layout.parts[number].shape)
        middle = 0.5 * (np.array([lower]) + np.array([upper]))
        return max(level for level in range(self.count) if self.outside(level, middle)[0] < 0.0)

    def filled(self, level: int, number: int) -> Iterator[np.ndarray]:
        """The sites (n, dim), m, of a level that a part of the layout has anywhere, by chunks."""
        if level:
            found = self.held(level, number, math.inf, bounds(self.layout.parts[number].shape))
            if found is not None:
                yield found
            return
        lattice = self.layout.lattice
        for begin, end in lattice.chunks():
            held = self.layout.materials(begin, end) == number
            grid = lattice.grid(begin, end)
            yield np.stack([np.broadcast_to(a, held.shape)[held] for a in grid], axis=1)

    def kernel(self, level: int):
        """The smoothing kernel of a level."""
        space = self.layout.case.space
        smooths = kernel(space.kernel, self.smoothing_length(level), space.dimensions)
        return normalised(smooths, self.spacing(level), space.dimensions) if space.normalised else smooths

    def _near_box(self, points: np.ndarray, lower: Corner, upper: Corner) -> np.ndarray:
        """Which points are within a spacing of a box; along an axis that repeats all are."""
        found, dx = np.ones(len(points), bool), self.layout.spacing
        for x, low, up, period in zip(points.T, lower, upper, self.layout.periods):
            if period is None:
                found &= (x > low - dx) & (x < up + dx)
        return found

    @cached_property
    def _ways(self) -> list:
        return [way_of(self.layout, one) for one in self.layout.case.space.refine]

    @cached_property
    def _forms(self) -> list[Form]:
        return [form_of(one.shape) for one in self.layout.case.space.refine]

    def ever(self, level: int, points: np.ndarray) -> np.ndarray:
        """As :meth:`outside`, of regions wherever they may come."""
        told = enumerate(zip(self.layout.case.space.refine, self._ways))
        away = (self._away(n, level, way.back(points)) for n, (one, way) in told if one.levels >= level)
        return reduce(np.minimum, away)

    def carried_by(self, name: str) -> int:
        """The finest level of whose regions one moves with the part of this name: it stays in there."""
        refine = self.layout.case.space.refine
        return max((one.levels for one in refine if one.moves_with == name), default=0)

    def _away(self, number: int, level: int, points: np.ndarray) -> np.ndarray:
        """How far points are outside of one region, as large as what is finer in it needs, m (n,)."""
        form, places, more = self._laid(number, level, points)
        return reduce(np.minimum, map(form.away, places)) - more

    def _faces(self, number: int, level: int, points: np.ndarray) -> Faces:
        """The border of that region, nearest image."""
        form, places, more = self._laid(number, level, points)
        found = chosen([*map(form.faces, places)], np.argmin)
        return Faces(found.away - more, found.normal)

    def _laid(self, number: int, level: int, points: np.ndarray) -> tuple[Form, Iterator[np.ndarray], float]:
        """Its form, the images of points where that was at the start, and by how much it is larger, m."""
        one = self.layout.case.space.refine[number]
        more = sum(self._around(finer) for finer in range(level + 1, 1 + one.levels))
        return self._forms[number], self._images(points - self.moved[number]), more

    def _images(self, points: np.ndarray) -> Iterator[np.ndarray]:
        """The points, and their images one period away along each axis that repeats."""
        found = [points]
        for d, period in enumerate(self.layout.periods):
            if period is not None:
                step = np.zeros(len(AXES[: points.shape[1]]))
                step[d] = period
                found += [x + way * step for x in tuple(found) for way in (-1.0, 1.0)]
        yield from found


class Finer:
    """A scene as effects of a finer ``level`` see it: with another spacing, all else the same."""

    finer = ()

    def __init__(self, scene, levels: Levels, level: int):
        self._scene = scene
        self.level, self.spacing = level, levels.spacing(level)
        self.smoothing_length, self.support = levels.smoothing_length(level), levels.support(level)
        self.kernel = levels.kernel(level)

    def __getattr__(self, name: str):
        return getattr(self._scene, name)


def finer_of(scene) -> tuple[Finer, ...]:
    """A ``scene`` as each of its finer levels sees it."""
    levels = Levels(scene.layout)
    return tuple(Finer(scene, levels, level) for level in range(1, levels.count))
