"""Self-gravity: what it adds to a scene, whatever the kinds of matter (psph.kinds)."""

from collections.abc import Iterator, Mapping
from math import log2, pi, sqrt
from typing import ClassVar

from psph.fields import Field
from psph.kinds import Kind, count_of, kinds_in
from psph.physics.gas.softening import DEEPENING
from psph.physics.rigid.body import RigidBody
from psph.physics.self_gravity import (
    ATTRACTION,
    ATTRACTION_ENERGY,
    BY_SIZE,
    DIRECT,
    FINE,
    MOST,
    WHOLE_ATTRACTION,
    is_whole,
    takes_tree,
)
from psph.simulation.gas_deepening import Deepening
from psph.work import Rank, Stage, Work

PAIR = 2.4e-9
"""Seconds of a pair on a core: by docs/gravity.md."""

BRANCH = 3.5e-7
"""Seconds that a particle and a doubling of all particles take in a tree on a core: by docs/gravity.md."""

KEY = "physics.self_gravity"


class Attraction(Kind):
    """All that moves attracts all else."""

    name: ClassVar = "attraction"

    @classmethod
    def is_in(cls, case) -> bool:
        """Where the case asks for it."""
        return case.physics.self_gravity is not None

    @classmethod
    def driven_speed(cls, census) -> float:
        """√(2GM/R): that of a fall from far away onto all matter in one ball."""
        layout = census.layout
        cell = layout.spacing**layout.dimensions
        mass = sum(one.mass for one in census.motions if isinstance(one, RigidBody))
        volume = 0.0
        for part in layout.parts:
            if part.moves_freely or part.moves_whole:
                own = float(census.sizes[part.number]) * cell
                volume += own
                mass += 0.0 if part.moves_whole else own * part.table.density
        radius = (0.75 * volume / pi) ** (1.0 / 3.0)
        return sqrt(2.0 * layout.case.physics.self_gravity.constant * mass / radius) if radius else 0.0

    @property
    def fields(self) -> tuple[Field, ...]:
        """The pulls, and the energy."""
        whole = any(is_whole(one.motion) for one in self.scene.species)
        return (
            ATTRACTION,
            ATTRACTION_ENERGY,
            *([WHOLE_ATTRACTION] * whole),
            *([DEEPENING] * self._by_size),
        )

    def renews(self, passes) -> tuple[str, ...]:
        """How softening changes, where it goes by size."""
        return (DEEPENING.name,) * self._by_size

    @property
    def _by_size(self) -> bool:
        return self._told.softening == BY_SIZE

    @property
    def bears_midway(self) -> bool:
        """Yes: forces are summed at the end of a step, where all particles stand."""
        return True

    def faults(self) -> Iterator[str]:
        """Open ends, beyond which there is more of the fluid; sizes where all have one."""
        if self._by_size and not any(kind.sizes for kind in kinds_in(self.scene)):
            yield f'{KEY}.softening: "h" goes by the sizes of gases, of which there is none; give a length'
        if self.scene.case.ends:
            yield f"{KEY}: what is beyond an open end would pull too; remove this key, or the ends"

    def warnings(self) -> Iterator[str]:
        """Too many particles for a sum over all pairs."""
        if self._told.method == DIRECT and (count := count_of(self.scene)) > MOST:
            yield (
                f"{KEY}.method: {count:,} particles make {count**2:.2g} pairs a step, about "
                f"{PAIR * count**2:.2g} s on one core; the direct sum is for {MOST:,}: take "
                f'"tree", which takes about {_seconds_of_tree(count):.2g} s'
            )

    @property
    def _told(self):
        return self.scene.case.physics.self_gravity

    def stages(self) -> Mapping[str, Stage]:
        """The pulls are known before the pass over the neighbours, which adds them to its sums."""
        return {"sum_over_pairs": Stage(_renew, _begin)}

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """√(0.05 ε/|a|): what falls past another one sees its pull change within ε; by sizes gases have
        theirs."""
        if acceleration > 0.0 and not self._by_size:
            yield sqrt(FINE * self._told.softening / acceleration), "self-gravity"

    def cure(self, limit: str) -> str:
        """A larger softening."""
        return f"{limit} limits the step: take a larger {KEY}.softening" if limit == "self-gravity" else ""

    def work(self, rank: Rank) -> Iterator[Work]:
        """The sum."""
        from psph.simulation.attraction import MutualPulls

        yield MutualPulls(rank, Deepening(rank, self._told.constant) if self._by_size else None)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What the sum takes, and how it is softened."""
        count, told = count_of(self.scene), self._told
        if takes_tree(told, count):
            cost = (
                f"by a tree, one a step: cells of mass M within b at r count as one where GM b⁴/r⁶ < "
                f"{told.accuracy:g} |a|, about {_seconds_of_tree(count):.2g} s"
            )
        else:
            cost = (
                f"by the direct sum, one a step: {count:,} squared = {count**2:.3g} pairs, about "
                f"{PAIR * count**2:.2g} s"
            )
        reach = "both supports" if self._by_size else f"{3 * told.softening:g} m"
        yield (
            "passes",
            f"Self-gravity {cost} on one core; Newton's pull beyond {reach}",
        )
        yield "messages", f"  masses      of all particles to each rank, once a step, {56 * count:,} bytes"

    def bytes_of_particle(self, plan) -> float:
        """Of all masses, twice: as they came, and in order; and of a tree."""
        return 260.0 if takes_tree(self._told, count_of(self.scene)) else 112.0


def _seconds_of_tree(count: int) -> float:
    return BRANCH * count * log2(count)


def _begin(simulation) -> None:
    simulation.engine.of(Attraction.name).begin_sums(simulation)


def _renew(simulation) -> None:
    simulation.engine.of(Attraction.name).renew(simulation)
