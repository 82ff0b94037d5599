"""Regions with finer particles: what they add to a scene (psph.kinds)."""

import math
from collections.abc import Container, Iterator, Mapping, Sequence

import numpy as np

from psph.fields import Field
from psph.kinds import Created, Kind, count_of
from psph.particles.sizes import Sizes
from psph.scene.forms.make import form_of
from psph.scene.levels import CORNER, DIVIDED, LENGTH, SHARE, SLOPE, Levels
from psph.scene.particles import settled_at
from psph.scene.parts.level import LevelPart, LevelWall
from psph.scene.shapes import bounds
from psph.simulation.levels import Resizing
from psph.simulation.materials import loaded_of, tell_of_groups
from psph.simulation.stages import nothing
from psph.work import Rank, Stage, Work

SKINS = {1: 0.3, 2: 0.3, 3: 0.24}
"""Part of the support by which lists reach farther at the most, by dimensions: in 3D longer rows cost more,
in 2D new lists."""

LEAST_SKIN = 0.06
"""That down to which lists narrow where they last."""

DEAR = {1: 10.0, 2: 10.0, 3: 5.0}
"""By dimensions, time of new lists, and of whom to follow by them, over that of a step's pairs: by it the dam
break in 2D keeps 0.3, and a sphere that heaves in 3D, where by 10 a step took 51 ms for 45, gets 0.12."""

LOOKED_AT = 16
"""Sample points along each axis of a region's box, by which an empty region is found."""

CLEAR = 2.0
"""Coarse spacings between a region's ends and what it goes with, below which `check` warns: a body of four
spacings has with its water 0.79 of their momentum after 0.6 s with half a spacing between, 0.95 with 1.5,
0.97 to 1.04 from three on."""

FIELDS = (
    Field(LENGTH, "m", "smoothing length of its level of sizes"),
    Field(DIVIDED, "1", "1 where finer particles stand in its place, else 0"),
    Field(CORNER, "1", "which corner of a coarser particle's cell it is"),
)


class Refinement(Kind):
    """Fluids and walls with finer particles in some regions."""

    name = "refine"
    moves = True

    @classmethod
    def is_in(cls, case) -> bool:
        """Whether a case has such regions."""
        return bool(case.space.refine)

    @property
    def fields(self) -> tuple:
        """Whose corner they are and what follows, and where walls and bodies tell their load its share."""
        return (*FIELDS, *([SHARE, SLOPE] if loaded_of(self.scene.species).any() else []))

    @property
    def load_reads(self) -> tuple[str, ...]:
        """The share of its level, and how that changes."""
        return SHARE.name, SLOPE.name

    @property
    def keeps_energy(self) -> bool:
        """Not that of who follows."""
        return False

    @property
    def bears_held(self) -> bool:
        """Not: who follows has no history of rates."""
        return False

    @property
    def pace(self) -> int:
        """Each level takes twice the step of the next finer one."""
        return 2 ** (self.levels.count - 1 - getattr(self.scene, "level", 0))

    def waiting(self, plan) -> float:
        """Those of levels whose steps are longer than the finest."""
        finer = [self._starting(level) for level in range(1, self.levels.count)]
        starting = [count_of(self.scene) - sum(finer), *finer]
        return sum(n * (1.0 - 1.0 / one.pace) for n, one in zip(starting, (plan, *plan.finer)))

    @property
    def reads(self) -> tuple[str, ...]:
        """Of whom it leads."""
        return ("mass",)

    @property
    def sizes(self) -> Sizes:
        """By the level of each particle; only who follows looks at other levels, as walls may.  Who leads and
        who divides is found with new lists: nobody strays by more than a third of the narrowest
        margin until then."""
        across = np.array([one.follows or not one.is_fluid for one in self.scene.species])
        finest = self.levels.support(self.levels.count - 1)
        return Sizes(
            self.scene.kernel.support,
            max(SKINS[self.scene.dimensions], self.scene.case.neighbours.skin),
            LENGTH,
            LENGTH,
            growth=1.0,
            across=across,
            strays=finest,
            least=LEAST_SKIN,
            dear=DEAR[self.scene.dimensions],
        )

    @property
    def levels(self) -> Levels:
        """Of the scene."""
        return Levels(self.scene.layout)

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """The smoothing length of their level, and whose corner they are."""
        level = np.array([one.level for one in self.scene.species])[species]
        yield LENGTH, (self.scene.layout.smoothing_length * 0.5**level)[:, None]
        corner = np.zeros(len(level))
        for one in range(1, self.levels.count):
            corner[level == one] = self.levels.corners(one, position[level == one])
        yield CORNER, corner[:, None]

    def particles(self) -> Created | None:
        """Finer ones, on no sites of the lattice."""
        layout = self.scene.layout
        parts = [
            part
            for part in layout.parts
            if isinstance(part, LevelPart | LevelWall) and part.number in layout.placed
        ]
        if not parts:
            return None
        number = np.repeat(
            [part.number for part in parts], [len(layout.placed[part.number]) for part in parts]
        )
        position = np.concatenate([layout.placed[part.number] for part in parts])
        found = settled_at(self.scene.starts, np.arange(len(number)), number, position)
        return Created(number, found.position, found.velocity, found.density, {}, of_parts=True)

    def stages(self) -> Mapping[str, Stage]:
        """Who leads and follows is found before new lists are made, and who follows before the sums."""
        return {
            "predict": Stage(_turn, nothing),
            "renew_lists": Stage(_renew, _begin),
            "sum_over_pairs": Stage(_impose, _impose),
        }

    def renews(self, passes: Sequence) -> tuple[str, ...]:
        """The state of who follows."""
        return ("velocity", "predicted_velocity", "density", "pressure", "specific_volume")

    def work(self, rank: Rank) -> Iterator[Work]:
        """The levels on a rank."""
        yield Resizing(rank)

    def faults(self) -> Iterator[str]:
        """Regions outside the domain, and those thinner than what is around them sees."""
        layout = self.scene.layout
        for one in layout.case.space.refine:
            lower, upper = bounds(one.shape)
            thin = min(high - low for low, high in zip(lower, upper))
            if thin <= 0.0:
                yield f"{one.where}.shape: nothing is in it: its parts do not meet; move one of them"
            elif thin < layout.support:
                yield (
                    f"{one.where}.shape: {thin:.4g} m thick, less than the {layout.support:.4g} m that "
                    "particles around it see; make it thicker, or give a smaller space.spacing to all"
                )
            elif _is_empty(form_of(one.shape), np.array(lower), np.array(upper)):
                yield f"{one.where}.shape: nothing is in it; leave out less"
            ends = zip(lower, upper, layout.lower, layout.upper)
            if any(high <= least or low >= most for low, high, least, most in ends):
                yield f"{one.where}.shape: outside the domain, where nothing is; move it into the fluid"

    def warnings(self) -> Iterator[str]:
        """Regions that go with something, and end close to it or are elsewhere."""
        layout = self.scene.layout
        for one in layout.case.space.refine:
            if not one.moves_with:
                continue
            least, most = bounds(layout.case.boundaries[one.moves_with].shape)
            lower, upper = bounds(one.shape)
            # Nothing comes in where the region goes on to an end of the domain, such as a mirror.
            below = [a - b for a, b, end in zip(least, lower, layout.lower) if b > end]
            above = [b - a for a, b, end in zip(most, upper, layout.upper) if b < end]
            near = min(*below, *above, math.inf, math.inf)
            if any(low > high for low, high in zip(map(max, least, lower), map(min, most, upper))):
                yield (
                    f"{one.where}.shape: nowhere near {one.moves_with}, with which it goes; "
                    "put it around that"
                )
                continue
            if all(a <= b for a, b in zip(least, lower)) and all(a >= b for a, b in zip(most, upper)):
                yield f"{one.where}.shape: all of it is in {one.moves_with}; make it larger, for finer fluid"
                continue
            dx = self.levels.spacing(one.levels - 1)
            if 0.0 <= near < CLEAR * dx:
                yield (
                    f"{one.where}.shape: ends {near:.3g} m beside {one.moves_with}, with which it goes: "
                    "coarse water that comes in takes up to a fifth of its momentum; leave three of their "
                    f"spacings, {3.0 * dx:.3g} m"
                )

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What each level has, and how long its steps are."""
        levels = self.levels
        for level in range(1, levels.count):
            dx, h, wide = levels.spacing(level), levels.smoothing_length(level), levels.margin(level)
            told = (
                f"dx = {dx:g} m, h = {h:g} m, margin {wide:g} m; {self._starting(level):,} of the particles"
            )
            yield "reach", f"  level {level}     {told}"
        for one in self.scene.case.space.refine:
            going = f", moves with {one.moves_with}" if one.moves_with else ""
            going = f", goes with the front {one.front}" if one.front else going
            yield "reach", f"  region      {one.where}, {one.factor} times finer{going}"
        for level, one in enumerate((plan, *plan.finer)):
            if one.pace > 1:
                yield (
                    "steps",
                    f"  level {level}             its steps are as long as {one.pace} of the finest",
                )

    def _starting(self, level: int) -> int:
        """How many particles of a finer level there are at the start, those in its margin and of its walls
        too."""
        layout = self.scene.layout
        own = [part.number for part in layout.parts if part.level == level]
        return sum(len(layout.placed[number]) for number in own if number in layout.placed)


def _is_empty(form, lower: np.ndarray, upper: np.ndarray) -> bool:
    """Whether a ``form`` has no inside: of samples of its box from ``lower`` to ``upper``, m, each is farther
    from the form than half the diagonal between samples."""
    width = (upper - lower) / LOOKED_AT
    sides = [low + w * (np.arange(LOOKED_AT) + 0.5) for low, w in zip(lower, width)]
    points = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, len(sides))
    return bool(form.away(points).min() > 0.5 * np.sqrt((width**2).sum()))


def _work(simulation):
    return simulation.engine.of(Refinement.name)


def _turn(simulation) -> None:
    _work(simulation).clock.turn(simulation.steps, simulation.impacts.lasts)


def _begin(simulation) -> None:
    _sort(simulation)


def _renew(simulation) -> None:
    with simulation.ledger("skin"):
        holds = simulation.listed and simulation.neighbourhood.skin.reach()
        simulation.listed = holds and _work(simulation).going.hold
    if not simulation.listed:
        with simulation.ledger("refine"):
            _sort(simulation, simulation.population)


def _sort(simulation, population=None) -> None:
    _work(simulation).sort(population)
    tell_of_groups(simulation.store, simulation.plan.materials)


def _impose(simulation) -> None:
    _work(simulation).impose(simulation)
