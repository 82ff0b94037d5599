"""Kinds of matter: how each declares itself, and the catalogue of those that psph has.

A kind says what it adds to a case, to the plan, to a step, to the books and to what is printed; plan, engine,
record, guards, checkpoint, `explain` and `check` go through the kinds of a scene and name none.  Those of
psph have a room each in psph/matter; files that a case uses bring others (docs/recipes/kind.md).
"""

from collections.abc import Container, Iterator, Mapping, Sequence
from importlib import import_module
from typing import Any, ClassVar, NamedTuple

import numpy as np

from psph.work import Rank, Stage, Work

CATALOGUE = (
    "psph.matter.soil:Soils",
    "psph.matter.solid:UpdatedSolids",
    "psph.matter.solid:ElasticSolids",
    "psph.matter.gas:IdealGases",
    "psph.matter.fluid:Fluids",
    "psph.matter.body:RigidBodies",
    "psph.matter.wall:Walls",
    "psph.matter.region:Regions",
    "psph.matter.end:OpenEnds",
    "psph.matter.attraction:Attraction",
    "psph.matter.refinement:Refinement",
)
"""Module and class of each kind that psph has, in the order in which they are asked.  They are named here and
imported when a scene is there, since they stand above all that asks them."""

TOPICS = ("matter", "reach", "messages", "passes", "steps", "friction")
"""Of lines for `explain`: what it is; how far its particles see others; what it sends in each step beside the
halo; passes over neighbours of its own; what it does within a step; its friction."""


class Created(NamedTuple):
    """Particles as they begin, all of a kind, the same on every rank: ``group`` (n,) is the number of that of
    each among those of the kind, with ``of_parts`` among the parts of the scene; ``position`` (n, dim) m,
    ``velocity`` (n, dim) m/s, ``density`` (n,) kg/m^d; ``values`` has fields by name, (n, ...).
    """

    group: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    density: np.ndarray
    values: Mapping[str, np.ndarray]
    of_parts: bool = False


class Kind:
    """A kind of matter in a ``scene``: it declares what it overrides, and nothing else.

    ``name`` is its table in a case; where that has another word for it, :meth:`is_in` says so.
    """

    name: ClassVar[str] = ""
    table: ClassVar[Any] = None
    """The keys of one of its entries in a case (psph.case.keys.Table), of a kind that a file brings."""
    refuses: ClassVar[Mapping[str, str]] = {}
    """Beside what it does not work, each word of psph.acts with a sentence and its cure."""
    columns: ClassVar[tuple[str, ...]] = ()
    """What it adds to log.csv: energies in J."""
    may_save: ClassVar[tuple] = ()
    """Fields of frames that only such matter has (psph.fields.Field), whatever of it a scene has."""
    is_stiff: ClassVar[bool] = True
    """Whether density and speed stay near those at rest, so that guards can watch them."""

    pushes_within: ClassVar[bool] = False
    """Whether its work pushes its particles itself, beside the effects."""

    def __init__(self, scene: Any):
        self.scene = scene

    @classmethod
    def is_in(cls, case: Any) -> bool:
        """Whether a case has such matter."""
        return bool(getattr(case, cls.name, None))

    @classmethod
    def drains(cls, case: Any) -> bool:
        """Whether particles may vanish by it, so that what flows can come to have a free surface."""
        return False

    @classmethod
    def motion_of(cls, layout: Any, part: Any) -> Any:
        """How a part of this kind moves as a whole under forces (psph.physics.motion); None: of another."""
        return None

    @classmethod
    def answer(cls, census: Any, friction: bool) -> float:
        """How much what moves as a whole answers to contacts (psph.physics.facts.Facts.answer)."""
        return 0.0

    @classmethod
    def has_free_surface(cls, census: Any) -> bool:
        """Whether it has a free surface at the start or can have one (psph.scene.census)."""
        return False

    @classmethod
    def driven_speed(cls, census: Any) -> float:
        """The largest speed, m/s, that gravity along periods, or what drives it else, gives it by the end."""
        return 0.0

    @classmethod
    def creeping_speed(cls, census: Any) -> float:
        """The speed, m/s, that sets that of sound where gravity along periods or tension drives it slowly."""
        return 0.0

    @classmethod
    def materials(cls, speeds: Any) -> Any:
        """What its parts are made of, by psph.scene.speeds, for its own rooms; None: what tables say."""
        return None

    @classmethod
    def layers(cls, census: Any) -> Mapping[int, Any]:
        """How parts under their own weight start, by number: ``pressure(position)`` and ``highest`` in Pa."""
        return {}

    @classmethod
    def contradictions(cls, case: Any) -> Iterator[tuple]:
        """What contradicts itself in its tables of a case (psph.case.findings.Finding)."""
        yield from ()

    def faults(self) -> Iterator[str]:
        """For `check`: why the scene cannot be run, each line a key and a cure."""
        yield from ()

    @property
    def farthest(self) -> float:
        """How far its lists reach at the start, m, where its particles have sizes of their own, else 0."""
        return 0.0

    def warnings(self) -> Iterator[str]:
        """For `check`: what will run, and likely not as intended."""
        yield from ()

    def curves(self) -> dict[str, Any]:
        """For `check --draw`: points (n, dim), m, by key, of what the case tells straight and hangs."""
        return {}

    def groups(self) -> tuple:
        """Groups of particles that it adds to those on the lattice (psph.scene.species.Species). They are
        apart (psph.particles.apart): sums of effects with ``across = True`` alone see them or theirs."""
        return ()

    def particles(self) -> Created | None:
        """The particles of these groups."""
        return None

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """With what particles begin that the scene's lattice has: those of these ``fields``, by name, that it
        knows to be other than zero, (n, components) for ``species`` (n,) at ``position`` (n, dim)."""
        yield from ()

    @property
    def fields(self) -> tuple:
        """What particles carry because it is there (psph.fields.Field)."""
        return ()

    @property
    def sizes(self) -> Any:
        """How far its particles reach, each by its own smoothing length (psph.particles.sizes); or None."""
        return None

    @property
    def moves(self) -> bool:
        """Whether its work moves particles itself, beside the kick of what is free."""
        return False

    @property
    def keeps_energy(self) -> bool:
        """Whether the energy of a scene with it is all in the books, so that a guard can watch it."""
        return True

    @property
    def keeps_heat(self) -> bool:
        """Whether what friction takes from motion is in the books of a scene with it, whose sum stays."""
        return False

    @property
    def bears_held(self) -> bool:
        """Whether rates of friction may serve for several steps beside it."""
        return True

    @property
    def bears_midway(self) -> bool:
        """Whether the rate of density may be summed at mid-step (psph.simulation.midway): it stands there."""
        return False

    @property
    def pace(self) -> int:
        """How many steps of the simulation one of the scene is, a level of sizes that takes its own; 1 in any
        scene where effects evolve fields."""
        return 1

    def waiting(self, plan: Any) -> float:
        """How many particles of a run by a ``plan`` have no sums in a step, on the mean."""
        return 0.0

    @property
    def reads(self) -> tuple[str, ...]:
        """What its work reads of neighbours of what materials fix (psph.fields.OF_MATERIAL)."""
        return ()

    @property
    def load_reads(self) -> tuple[str, ...]:
        """What it has the push of fluid on walls and bodies read of both, where that is asked for."""
        return ()

    def renews(self, passes: Sequence) -> tuple[str, ...]:
        """Fields that its work fills anew just before the ``passes`` over neighbours are summed."""
        return ()

    def own_pass(self, called: Sequence, stored: Sequence[str]) -> Any:
        """A pass within steps of its own (psph.simulation.passes) of those ``called``; None: it has none."""
        return None

    def loads(self, passes: Sequence) -> Any:
        """How pushes on walls and bodies are summed (psph.composition.loads); None: it does not matter."""
        return None

    def stages(self) -> Mapping[str, Stage]:
        """Stages of its own (psph.simulation.stages): each by the name of the one that it comes before."""
        return {}

    def limits(self, plan: Any, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """Its limits of the time step in s, each with its name, for the largest |v| and |a| in m/s, m/s²."""
        yield from ()

    def heeds(self, plan: Any) -> tuple:
        """Effects whose limits of the step it heeds in steps of its own."""
        return ()

    def work(self, rank: Rank) -> Iterator[Work]:
        """What it does on a rank within a step."""
        yield from ()

    def planned(self, plan: Any) -> Any:
        """What its own rooms ask of a ``plan``, made once (psph.simulation.plan); None: nothing."""
        return None

    def forecast(self, plan: Any) -> Iterator[tuple[str, Any]]:
        """For `explain`: a line, and the even state (psph.theory.stability.uniform.Settings) that linear
        theory is to judge behind it, or None."""
        yield from ()

    def lines(self, plan: Any, dt: float) -> Iterator[tuple[str, str]]:
        """For `explain`: lines, each with its topic (``TOPICS``); ``dt`` is the longest step in s."""
        yield from ()

    def advice(self, guard: str, suspect: Any) -> Iterator[str]:
        """What to try after a ``guard`` stopped a run by a ``suspect`` particle, the most promising first."""
        yield from ()

    def cure(self, limit: str) -> str:
        """What to change in it where the limit of the step of this name makes a run too long, or empty."""
        return ""

    def bytes_of_particle(self, plan: Any) -> float:
        """Bytes that its lists and tables take, by particle."""
        return 0.0

    def flops(self) -> float:
        """Operations of a pair in passes of its own, where no other passes are."""
        return 0.0

    def examples(self, plan: Any) -> tuple:
        """Values whose types select its compiled loops."""
        return ()

    def rehearsed(self) -> tuple[int, ...]:
        """Groups of which a rehearsal of the loops needs a particle."""
        return ()


def own() -> Iterator[type[Kind]]:
    """The kinds that psph has."""
    for entry in CATALOGUE:
        module, _, name = entry.partition(":")
        yield getattr(import_module(module), name)


def known(case: Any) -> Iterator[type[Kind]]:
    """The kinds that a case can have: psph's own, and those of files that it uses."""
    yield from own()
    yield from (entry.effect for entry in case.catalogue.kinds)


def in_case(case: Any) -> Iterator[type[Kind]]:
    """The kinds of matter of a case."""
    return (kind for kind in known(case) if kind.is_in(case))


def kinds_in(scene: Any) -> tuple[Kind, ...]:
    """The kinds of matter of a scene."""
    return tuple(kind(scene) for kind in in_case(scene.case))


def count_of(scene: Any) -> int:
    """How many particles a scene begins with: those on its lattice, and those that kinds of matter add."""
    made = filter(None, (kind.particles() for kind in kinds_in(scene)))
    return int(scene.census.counts.sum()) + sum(len(one.group) for one in made)
