"""Self-gravity: what it adds to a scene, whatever the kinds of matter (psph.kinds)."""

from collections.abc import Iterator, Mapping
from math import pi, sqrt
from typing import ClassVar

from psph.fields import Field
from psph.kinds import Kind, Rank, Stage, Work, count_of
from psph.physics.rigid.body import RigidBody
from psph.physics.self_gravity import ATTRACTION, ATTRACTION_ENERGY, FINE, WHOLE_ATTRACTION, is_whole

MOST = 20_000
"""Particles for which a sum over all pairs takes about a second on one core."""

PAIR = 2.4e-9
"""Seconds of a pair on a core: by docs/gravity.md."""

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
        return (ATTRACTION, ATTRACTION_ENERGY, *([WHOLE_ATTRACTION] * whole))

    @property
    def bears_midway(self) -> bool:
        """Yes: forces are summed at the end of a step, where all particles stand."""
        return True

    def faults(self) -> Iterator[str]:
        """Open ends, beyond which there is more of the fluid."""
        if self.scene.case.ends:
            yield f"{KEY}: what is beyond an open end would pull too; remove this key, or the ends"

    def warnings(self) -> Iterator[str]:
        """Too many particles for a sum over all pairs."""
        if (count := count_of(self.scene)) > MOST:
            yield (
                f"{KEY}: {count:,} particles make {count**2:.2g} pairs a step, about "
                f"{PAIR * count**2:.2g} s on one core; the direct sum is for {MOST:,}: take a larger "
                "space.spacing, or more ranks"
            )

    def stages(self) -> Mapping[str, Stage]:
        """The pulls are known before the pass over the neighbours, which adds them to its sums."""
        return {"sum_over_pairs": Stage(_renew, _renew)}

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """√(0.05 ε/|a|): what falls past another one sees its pull change within ε."""
        if acceleration > 0.0:
            softening = self.scene.case.physics.self_gravity.softening
            yield sqrt(FINE * softening / acceleration), "self-gravity"

    def cure(self, limit: str) -> str:
        """A larger softening."""
        return f"{limit} limits the step: take a larger {KEY}.softening" if limit == "self-gravity" else ""

    def work(self, rank: Rank) -> Iterator[Work]:
        """The direct sum."""
        from psph.simulation.attraction import DirectSum

        yield DirectSum(rank)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What the sum takes, and how it is softened."""
        count, told = count_of(self.scene), self.scene.case.physics.self_gravity
        yield (
            "passes",
            f"Self-gravity by the direct sum, one a step: {count:,} squared = {count**2:.3g} pairs, about "
            f"{PAIR * count**2:.2g} s on one core; Newton's pull beyond {3 * told.softening:g} m",
        )
        yield "messages", f"  masses      of all particles to each rank, once a step, {48 * count:,} bytes"

    def bytes_of_particle(self, plan) -> float:
        """Of all masses, twice: as they came, and in order."""
        return 96.0


def _renew(simulation) -> None:
    simulation.engine.of(Attraction.name).renew(simulation)
