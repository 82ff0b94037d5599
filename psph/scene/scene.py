"""The scene: a case laid out on the lattice, in four values, each made from the case and those before it."""

from functools import cached_property
from operator import attrgetter
from typing import Any

from psph.case import Case
from psph.case.parameters import chosen
from psph.kinds import in_case
from psph.scene.census import Census, take_census
from psph.scene.layout import Layout, lay_out
from psph.scene.levels import Finer, finer_of
from psph.scene.particles import ParticleSet, fill
from psph.scene.speeds import Speeds
from psph.scene.starts import Starts


class Scene:
    """A description of the initial state of a case; particles are created on request.

    The same on every rank.  ``layout`` says which part of the case holds which site, ``census`` what the
    sites tell, ``speeds`` how fast the parts are and so how fast sound is, ``starts`` in which state they
    begin.  Each is found when it is asked for.  Beside these the scene answers what effects may ask
    (psph.physics.facts).
    """

    def __init__(self, case: Case):
        self.case = case
        self.layout: Layout = lay_out(case)

    @cached_property
    def census(self) -> Census:
        """Counts, extents and overlaps, from one visit of every site."""
        return take_census(self.layout)

    @cached_property
    def speeds(self) -> Speeds:
        """How fast things are and will be, and sound with them."""
        return Speeds(self.census)

    @cached_property
    def starts(self) -> Starts:
        """The state of all parts before the first step."""
        return Starts(self.speeds)

    def particles(self, first: int, last: int, first_id: int) -> ParticleSet:
        """The particles of lattice planes ``first`` to ``last - 1``, in lattice order.

        ``first_id`` is the number of particles in the planes before.
        """
        count = int(self.census.counts[first:last].sum())
        made = ParticleSet.empty(count, self.layout.dimensions, first_id)
        fill(made, self.starts, first, last)
        return made

    @cached_property
    def finer(self) -> tuple[Finer, ...]:
        """The scene as each finer level of sizes sees it; none where there is one spacing."""
        return finer_of(self)

    @cached_property
    def tables(self) -> dict[str, Any]:
        """Further tables that a run writes, by their names."""
        return chosen(getattr(self.case, "tables", None), self.case.catalogue.tables)

    # What effects may ask: psph.physics.facts says what each is.
    physics = property(attrgetter("case.physics"))
    dimensions = property(attrgetter("layout.dimensions"))
    spacing = property(attrgetter("layout.spacing"))
    smoothing_length = property(attrgetter("layout.smoothing_length"))
    kernel = property(attrgetter("layout.kernel"))
    support = property(attrgetter("layout.support"))
    gravity = property(attrgetter("layout.gravity"))
    frame = property(attrgetter("layout.frame"))
    hard_planes = property(attrgetter("layout.hard_planes"))
    sound_speed = property(attrgetter("speeds.sound_speed"))
    expected_speed = property(attrgetter("speeds.expected"))
    starting_speed = property(attrgetter("speeds.starting"))
    species = property(attrgetter("starts.species"))
    rheologies = property(attrgetter("starts.rheologies"))
    strengths = property(attrgetter("starts.strengths"))
    has_free_surface = property(attrgetter("starts.has_free_surface"))
    lowest_pressure = property(attrgetter("starts.lowest_pressure"))
    starting_fullness = property(attrgetter("starts.fullness"))
    standing_tension = property(attrgetter("starts.standing_tension"))

    def answer(self, friction: bool) -> float:
        """How much rigid bodies answer to contacts with elastic solids, 1/kg (psph.kinds)."""
        return max(kind.answer(self.census, friction) for kind in in_case(self.case))
