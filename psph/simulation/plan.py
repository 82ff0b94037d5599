"""The plan: exactly the effects, fields and messages that a scene needs, and why."""

from collections import namedtuple
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from psph.composition.count import flops_per_pair
from psph.composition.loads import Loads
from psph.composition.reflections import mirrors_of
from psph.composition.space import Metres, fixed_point
from psph.composition.terms import OF_A_PARTICLE
from psph.fields import (
    APART,
    IDENTITY,
    OF_EVERY_SCENE,
    OF_MATERIAL,
    Field,
    by_name,
    companions,
    filled,
    fixed,
    view_of,
)
from psph.kinds import Kind, kinds_in
from psph.particles.planes import Plane
from psph.particles.sizes import Sizes
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.motion import APPARENT, COUPLE, LOAD, OF_MOTION, WHIRL, WORK
from psph.scene.gauging import followed_fields
from psph.simulation.calling import acts_in, called_for, in_scene, why_dropped
from psph.simulation.limits import limits_of_effects, step_limits
from psph.simulation.materials import Materials, has_couples, material_value, materials_of, split
from psph.simulation.midway import COMING, HISTORY, Ahead, ahead_of, cfl_of, is_midway
from psph.simulation.movement import carried_fields
from psph.simulation.paces import held_fields, held_parts, is_held, steps_held
from psph.simulation.passes import Pass, array_of, make_passes
from psph.simulation.pulls import Pulls, pulls_of, shares_loop
from psph.simulation.reading import (
    Called,
    called_with,
    kept_in_frames,
    refuse_unwritten,
    refuse_without_image,
)

OF_STATE = ("position", "rest_density", "sound_speed")
"""Quantities that kick, drift and the equation of state read of every particle."""

ALWAYS_READ = (
    "position",
    "velocity",
    "pressure",
    "specific_volume",
    "mass",
    "rest_density",
    "sound_speed",
    "smoothing_length",
)
"""What the loops themselves read of a particle, whatever the effects."""

LOADED_READ = ("is_fluid",)
"""What a pass of loads reads of a neighbour, beside what its effects read."""

ONLY_READ = (APPARENT.name, WHIRL.name)
"""What particles carry of their motion only where a formula reads it."""

OF_SCENE = ("smoothing_length", "kernel", "spacing", "dimensions")

Extremes = namedtuple("Extremes", (*OF_SCENE, *(f.name for f in OF_MATERIAL)))
"""What limits of the time step rest on."""


@dataclass(frozen=True)
class Plan:
    """What will be simulated.  It prints itself: see psph.runs.explain."""

    called: tuple[Called, ...]
    absent: tuple[Entry, ...]
    dropped: dict[str, str]
    """Of effects that the case asks for and the scene has no use for: by their names, why."""
    kernel: Any
    materials: Materials
    """What holds for each group of particles."""
    planes: tuple[Plane, ...]
    """Mirrors: planes of symmetry, and walls that are one."""
    mirrors: Any
    """What is seen in them (psph.composition.mirrors), or None."""
    precision: str
    space: Any
    """How positions of neighbours are told apart: psph.composition.space."""
    smoothing_length: float
    constants: dict[str, float]
    fields: dict[str, Field]
    """Everything that a particle of the scene can carry, by name."""
    pulls: Pulls
    """What the body forces of the scene pull."""
    seen: tuple[Field, ...]
    """What formulas read of a particle."""
    arrays: tuple[str, ...]
    passes: tuple[Pass, ...]
    met: Pass | None
    """The pass of a kind of matter within steps of its own (psph.kinds.Kind.own_pass)."""
    refreshed: tuple[str, ...]
    """What ghosts need before the first pass of every step."""
    ghost_fields: tuple[str, ...]
    """What ghosts need once, when lists are made."""
    evolving: tuple[Field, ...]
    """Fields that an effect gives a rate, beside velocity and density."""
    matter: tuple[Kind, ...]
    """The kinds of matter of the scene, which declare what they add (psph.kinds)."""
    loads: Any
    """How the push on groups that are loaded is summed (psph.composition.loads)."""
    renewed: tuple[str, ...]
    """What ghosts need of it that kinds of matter fill anew just before the sums."""
    cfl: float
    ahead: Ahead | None
    """By which parts of a step what forces read is ahead, None in one pass (psph.simulation.midway)."""
    fixed_step: float | None
    extremes: Any
    """The scene's shared values, and the largest of those that differ by material."""
    kept: tuple[str, ...]
    """Fields that frames hold beside those of every frame (output.fields)."""
    steps_held: int
    """For how many steps the rates of friction serve (psph.simulation.paces)."""
    pace: int = 1
    """How many steps one of its own is (psph.simulation.own_steps)."""
    finer: tuple["Plan", ...] = ()
    """The same for each finer level of sizes (psph.scene.levels): other numbers, the same code."""

    def of(self, name: str) -> Any:
        """The kind of matter of that name, or None."""
        return next((kind for kind in self.matter if kind.name == name), None)

    @cached_property
    def is_stiff(self) -> bool:
        """Whether density and speed of all that is in the scene stay near those at rest."""
        return all(kind.is_stiff for kind in self.matter)

    @property
    def sizes(self) -> Sizes | None:
        """How far particles reach by lengths of their own, of the kind of matter that has them; else None."""
        return next(filter(None, (kind.sizes for kind in self.matter)), None)

    @property
    def rate_passes(self) -> int:
        """Passes of a step that give rates."""
        return 2 if self.midway else 1

    @property
    def midway(self) -> Pass | None:
        """The pass at the middle of a step (psph.simulation.midway), or None."""
        return self.passes[0] if self.passes and self.passes[0].midway else None

    @cached_property
    def planned(self) -> dict[str, Any]:
        """What kinds of matter have planned for their own rooms, by their names."""
        made = ((kind.name, kind.planned(self)) for kind in self.matter)
        return {name: one for name, one in made if one is not None}

    @cached_property
    def effects(self) -> tuple:
        """The tuple whose type selects the compiled loop."""
        return tuple(call.effect for call in self.called)

    @property
    def stored(self) -> tuple[Field, ...]:
        """The fields that need an array."""
        return tuple(self.fields[name] for name in self.arrays)

    @property
    def saved(self) -> tuple[Field, ...]:
        """The fields of a frame."""
        return tuple(f for f in (*IDENTITY, *self.stored) if f.saved or f.name in self.kept)

    @property
    def view(self) -> type:
        """The NamedTuple in which formulas see a particle."""
        return view_of(tuple(field.name for field in self.seen))

    @cached_property
    def reductions(self) -> tuple:
        """Effects with a sum of their own."""
        return tuple(e for e in self.effects if hasattr(e, "start"))

    @property
    def neighbour_fields(self) -> tuple[str, ...]:
        """What the last pass, which gives the rates, reads of a neighbour."""
        return self.passes[-1].neighbour_fields if self.passes else ()

    @cached_property
    def marking(self) -> tuple:
        """Effects with a field that is found from the places of the neighbours in each step."""
        return tuple(e for e in self.effects if hasattr(e, "marks"))

    @cached_property
    def moves_walls(self) -> bool:
        """Whether walls move as they are told, or a kind of matter by its own work."""
        return bool(self.materials.motions or self.materials.rigid) or any(kind.moves for kind in self.matter)

    @cached_property
    def starts_twice(self) -> bool:
        """Whether forces rest on sums of the pass before: then the first are computed twice."""
        return any(hasattr(e, "limit_density") or getattr(e, "lagged", False) for e in self.effects)

    @cached_property
    def displaces(self) -> bool:
        """Whether an effect moves particles beside their velocity."""
        return any(hasattr(e, "displacement") for e in self.effects)

    @cached_property
    def bounds(self) -> Any:
        """The effect that keeps an evolved field within bounds, or None."""
        return next((e for e in self.effects if hasattr(e, "admit")), None)

    @cached_property
    def carriers(self) -> tuple:
        """The effects that have a part in kick and drift: scenes without share those loops."""
        return tuple(call.effect for call in self.called if _carries(call))

    @property
    def books_work(self) -> bool:
        """Whether particles carry the energy that walls, or a moving frame, have given."""
        return WORK.name in self.arrays

    @cached_property
    def carried(self) -> tuple[str, ...]:
        """What the equation of state and the carriers read of a particle: scenes that differ in no more
        than this share the loops of kick and drift."""
        asked = (call for call in self.called if _carries(call) or self.pulls.ask(call.effect))
        read = set(OF_STATE).union(*(call.reads.own for call in asked))
        read |= {"mass"} if self.books_work else set()
        return tuple(field.name for field in self.seen if field.name in read)

    def flops_per_pair(self, periods: tuple, effects: tuple | None = None) -> int:
        """Operations of a pair in a step, of all or just some ``effects``: those of the passes that give
        rates, one that runs in every n-th step at an n-th; 0 where there is no such pass."""
        effects = self.effects if effects is None else effects
        operations = 0.0
        for one in self.passes:
            own, sums = (
                tuple(e for e in es if any(e is f for f in effects)) for es in (one.effects, one.reductions)
            )
            if one.gives_rates:
                counted = flops_per_pair(
                    own, sums, self.kernel, self.seen, self.constants, periods, one.gives
                )
                operations += counted / one.every
        return round(operations)

    @cached_property
    def limits_of_effects(self) -> tuple[tuple[float, str], ...]:
        """Limits of the time step that effects set, s, with their names: the same in each step."""
        return tuple(limits_of_effects(self))

    def longest_step(self, speed: float, acceleration: float) -> tuple[float, str]:
        """Δt in s and the name of the limit that sets it, for the largest |v| and |a|."""
        return min(self.step_limits(speed, acceleration), key=lambda limit: limit[0])

    def step_limits(self, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """Every limit of the time step with its name, s: its part, of a level whose own steps are longer."""
        for _, step, name in self.limits_by_level(speed, acceleration):
            yield step, name

    def limits_by_level(self, speed: float, acceleration: float) -> Iterator[tuple[int | None, float, str]]:
        """The same, each with its level of sizes; None where there is one, or the step is given."""
        if self.fixed_step is not None:
            yield None, self.fixed_step, "time.step"
            return
        for level, one in enumerate((self, *self.finer)):
            for step, name in step_limits(one, speed, acceleration):
                yield level if self.finer else None, step / one.pace, name


def make_plan(scene, catalogue: Catalogue | None = None) -> Plan:
    """The plan of a scene (psph.scene.Scene), with what its case or another catalogue offers."""
    case, catalogue = scene.case, catalogue or scene.case.catalogue
    entries = [one for one in catalogue.effects if acts_in(case, one.effect)]
    calls = [(entry, *asked) for entry in entries if (asked := called_for(case, entry))]
    fits = [(entry, in_scene(effect, scene), reason) for entry, effect, reason in calls]
    fitted = [fit for fit in fits if fit[1] is not None]
    marking = [effect for _, effect, _ in fitted if hasattr(effect, "marks")]
    written = tuple(field for _, effect, _ in fitted for field in filled(effect))
    written += tuple(effect.marks for effect in marking)
    written += tuple(effect.remembers for _, effect, _ in fitted if hasattr(effect, "remembers"))
    written += tuple(field for _, effect, _ in fitted for field in getattr(effect, "drawn", ()))
    evolving = tuple(field for field in written if field.evolves)
    further = tuple(field for one in evolving for field in companions(one))
    matter = kinds_in(scene)
    materials = materials_of(scene, catalogue.states, [effect for _, effect, _ in fitted])
    species, flows = materials.species, materials.flows
    of_kinds = tuple(field for kind in matter for field in kind.fields) + followed_fields(scene)
    of_kinds += (APART,) if materials.apart.any() else ()
    extremes = Extremes(
        *(getattr(scene, name) for name in OF_SCENE),
        *(max(material_value(m, f.name) for m in species) for f in OF_MATERIAL),
    )
    midway = is_midway(scene, [effect for _, effect, _ in fitted], matter, extremes)
    rate_passes = 2 if midway else 1
    of_kinds += (COMING,) if midway else ()
    hold_for = steps_held(scene, [effect for _, effect, _ in fitted], extremes, matter, rate_passes)
    if hold_for > 1:
        fitted = [(one, part, why) for one, effect, why in fitted for part in held_parts(effect, scene)]
    slow = [effect for _, effect, _ in fitted if is_held(effect)] if hold_for > 1 else []
    held = held_fields(slow, has_couples(scene))
    fields = by_name(catalogue.fields.values(), written, further, OF_MOTION, of_kinds, held)
    called = tuple(called_with(entry, effect, reason, scene, fields) for entry, effect, reason in fitted)
    present, pulls = {entry for entry, *_ in fitted}, pulls_of(called, scene.dimensions, flows)
    loaded = materials.loaded is not None
    for_loads = (*LOADED_READ, *(name for kind in matter for name in kind.load_reads)) * (flows and loaded)
    of_works = tuple(name for kind in matter for name in kind.reads)
    own = {*ALWAYS_READ, *for_loads, *of_works}.union(*(c.reads.own | c.reads.neighbour for c in called))
    told = carried_fields(materials, scene.frame)
    told_by = {e.told_by for e in marking}
    shared, varying = split(species, own | told_by)
    at_start = tuple(field.name for _, effect, _ in fitted for field in fixed(effect))
    varying += tuple(name for name in at_start if name in own)
    of_step = (field for field in OF_EVERY_SCENE if not (midway and field in HISTORY))
    kept = (field for field in written if not field.asked or field.name in own)
    computed = tuple(field.name for field in (*of_step, *kept, *further, *of_kinds, *held))
    refuse_unwritten(scene, called, (*computed, *told, *at_start))
    seen = tuple(field for name, field in fields.items() if name in own)
    imaged = by_name(OF_EVERY_SCENE, seen).values()
    # What has sizes that change sums its density, over images too: these bear no weight between the two.
    summed = any(kind.sizes is not None and kind.sizes.grow for kind in matter)
    weight = (0.0,) * scene.dimensions if summed else scene.gravity
    if scene.layout.mirror_planes:
        refuse_without_image(scene, called, fields)
    told = {name for name in told if name in own or name not in ONLY_READ}
    told |= {LOAD.name} if loaded else set()
    told |= {COUPLE.name} if has_couples(scene) else set()
    told |= {WORK.name} if pulls.booked or pulls.booked_in_bonds else set()
    stored = tuple(n for n in fields if n in computed or n in varying or n in told)
    paired = shares_loop(called, flows)
    passes = make_passes(
        paired if flows or any(hasattr(c.effect, "push") for c in paired) else (),
        stored,
        lambda name: array_of(name, stored),
        max(1, case.time.gather_every // rate_passes),
        for_loads,
        hold_for,
        midway,
    )
    met = next(filter(None, (kind.own_pass(called, stored) for kind in matter)), None)
    fresh = {name for one in passes for name in one.neighbour_fields if name not in one.brought}
    brought = {name for one in passes for name in one.brought}
    neighbour = {name for one in (*passes, *([met] if met else [])) for name in one.neighbour_fields}
    neighbour.update(of_works)
    refreshed = tuple(n for n in stored if n in fresh and n in (*computed, APPARENT.name))
    renewed = {name for kind in matter for name in kind.renews(passes)}
    return Plan(
        called=called,
        absent=tuple(e for e in catalogue.effects if e not in present),
        dropped={
            entry.effect.__name__: why_dropped(effect, scene, reason)
            for entry, effect, reason in calls
            if entry not in present
        },
        kernel=scene.kernel,
        materials=materials,
        planes=scene.layout.mirror_planes,
        mirrors=mirrors_of(scene.layout.mirror_planes, weight, scene.layout.reach.cutoff, imaged),
        precision=case.precision,
        space=fixed_point(scene.smoothing_length, scene.layout.periods)
        if case.precision == "mixed"
        else Metres(tuple(scene.layout.periods)),
        smoothing_length=scene.smoothing_length,
        constants=shared | {n: getattr(scene, n) for n in ("smoothing_length",) if n not in stored},
        fields=fields,
        pulls=pulls,
        seen=seen,
        arrays=stored,
        passes=passes,
        met=met,
        refreshed=refreshed,
        ghost_fields=tuple(
            n
            for n in stored
            if n in varying and n in neighbour | told_by or n in neighbour and n in brought or n == APART.name
        ),
        evolving=evolving,
        matter=matter,
        loads=next((how for kind in matter if (how := kind.loads(passes))), Loads),
        renewed=tuple(name for name in refreshed if name in renewed),
        cfl=cfl_of(scene, rate_passes),
        ahead=ahead_of(scene) if midway else None,
        fixed_step=case.time.step,
        extremes=extremes,
        kept=kept_in_frames(scene, stored),
        steps_held=hold_for,
        pace=1 if evolving else max((kind.pace for kind in matter), default=1),
        finer=tuple(make_plan(one, catalogue) for one in scene.finer),
    )


def _carries(call: Called) -> bool:
    """Whether an effect has a part in kick and drift."""
    return any(hasattr(call.effect, name) for name in (*OF_A_PARTICLE, "admit"))
