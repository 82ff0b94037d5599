"""The plan: exactly the effects, fields and messages that a scene calls for, and why."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from psph.case.parameters import as_numbers
from psph.particles.fields import FIELDS
from psph.physics.catalogue import CATALOGUE, EQUATIONS_OF_STATE, Entry
from psph.physics.compose import OF_A_PARTICLE, ParticleView
from psph.physics.space import Metres, fixed_point
from psph.physics.trial import Reads, UnknownField, reads

ALWAYS = (
    "position", "velocity", "predicted_velocity", "acceleration", "listed_position",
    "density", "density_rate", "density_rate_1", "density_rate_2", "specific_volume", "pressure",
)
"""Fields of every scene."""

PER_MATERIAL = ("mass", "rest_density", "viscosity", "wall", "no_slip")
"""Quantities fixed at the start: one number where all materials agree, else an array."""

PER_SITE = ("stress_point",)
"""Quantities fixed at the start by the site of a particle: whether it is an odd one."""

OF_STATE = ("position", "rest_density", "sound_speed")
"""Quantities that kick, drift and the equation of state read of every particle."""

FORCE_LIMIT = 0.25
"""Monaghan (1992): Δt ≤ 0.25 √(h/|a|)."""


class Called(NamedTuple):
    """An effect of the scene, the key of the case that called for it, and what it reads."""

    effect: Any
    reason: str
    reads: Reads


@dataclass(frozen=True)
class Plan:
    """What will be simulated.  It prints itself: see psph.solver.explain."""

    called: tuple[Called, ...]
    absent: tuple[Entry, ...]
    dropped: dict[str, str]
    """Of effects that the case asks for and the scene has no use for: by their names, why."""
    kernel: Any
    state: Any
    state_reason: str
    precision: str
    space: Any
    """How positions of neighbours are told apart: psph.physics.space."""
    smoothing_length: float
    constants: dict[str, float]
    arrays: tuple[str, ...]
    refreshed: tuple[str, ...]
    ghost_fields: tuple[str, ...]
    neighbour_fields: tuple[str, ...]
    cfl: float
    fixed_step: float | None
    extremes: ParticleView
    """The scene's shared values, and the largest of those that differ by material."""

    @cached_property
    def effects(self) -> tuple:
        """The tuple whose type selects the compiled loop."""
        return tuple(call.effect for call in self.called)

    @cached_property
    def reductions(self) -> tuple:
        """Effects with a sum of their own."""
        return tuple(e for e in self.effects if hasattr(e, "start"))

    @cached_property
    def marking(self) -> tuple:
        """Effects with a field that is found when the neighbours are listed."""
        return tuple(e for e in self.effects if hasattr(e, "marks"))

    @cached_property
    def starts_twice(self) -> bool:
        """Whether forces rest on sums of the pass before: then the first are computed twice."""
        late = ("limit_density", "writes")
        return any(hasattr(e, name) for e in self.effects for name in late)

    @cached_property
    def displaces(self) -> bool:
        """Whether an effect moves particles beside their velocity."""
        return any(hasattr(e, "displacement") for e in self.effects)

    @cached_property
    def carriers(self) -> tuple:
        """The effects that have a part in kick and drift: scenes without share those loops."""
        return tuple(call.effect for call in self.called if _carries(call))

    @cached_property
    def uncarried(self) -> dict[str, None]:
        """What neither the equation of state nor the carriers read of a particle."""
        read = set(OF_STATE).union(*(call.reads.own for call in self.called if _carries(call)))
        return dict.fromkeys(name for name in ParticleView._fields if name not in read)

    def longest_step(self, speed: float, acceleration: float) -> tuple[float, str]:
        """Δt in s and the name of the limit that sets it, for the largest |v| and |a|."""
        return min(self.step_limits(speed, acceleration), key=lambda limit: limit[0])

    def step_limits(self, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """Every limit of the time step with its name, s."""
        if self.fixed_step is not None:
            yield self.fixed_step, "time.step"
            return
        h = self.smoothing_length
        yield self.cfl * h / (self.constants["sound_speed"] + speed), "sound (CFL)"
        if acceleration > 0.0:
            yield FORCE_LIMIT * (h / acceleration) ** 0.5, "force"
        for effect in self.effects:
            if hasattr(effect, "longest_step"):
                yield effect.longest_step(self.extremes), words(type(effect).__name__)


def make_plan(scene) -> Plan:
    """The plan of a scene (psph.scene.Scene)."""
    case = scene.case
    calls = [(entry, *found) for entry in CATALOGUE if (found := _called_for(case, entry))]
    fits = [(entry, _in_scene(effect, scene), reason) for entry, effect, reason in calls]
    fitted = [fit for fit in fits if fit[1] is not None]
    called = tuple(
        Called(effect, reason, reads(effect, scene.dimensions, scene.kernel))
        for _, effect, reason in fitted
    )
    present = {entry for entry, *_ in fitted}
    [(state, state_reason)] = filter(None, (_called_for(case, e) for e in EQUATIONS_OF_STATE))
    own = frozenset().union(*(c.reads.own | c.reads.neighbour for c in called)) | {"rest_density"}
    marking = [c.effect for c in called if hasattr(c.effect, "marks")]
    told_by = {e.told_by for e in marking}
    shared, varying = _split(scene, own | told_by)
    written = tuple(e.writes for e in (c.effect for c in called) if hasattr(e, "writes"))
    written += tuple(e.marks for e in marking)
    neighbour = _read_of_neighbours(called)
    _refuse_unwritten(called, written)
    return Plan(
        called=called,
        absent=tuple(e for e in CATALOGUE if e not in present),
        dropped={
            entry.effect.__name__: _why_dropped(effect, scene, reason)
            for entry, effect, reason in calls if entry not in present
        },
        kernel=scene.kernel,
        state=state,
        precision=case.precision,
        space=fixed_point(scene.smoothing_length, scene.periods)
        if case.precision == "mixed"
        else Metres(tuple(scene.periods)),
        state_reason=state_reason,
        smoothing_length=scene.smoothing_length,
        constants=shared
        | {"sound_speed": scene.sound_speed, "smoothing_length": scene.smoothing_length},
        arrays=ALWAYS + varying + written,
        refreshed=tuple(n for n in FIELDS if n in neighbour and n in ALWAYS + written),
        ghost_fields=tuple(n for n in varying if n in neighbour | told_by),
        neighbour_fields=tuple(n for n in FIELDS if n in neighbour and n in ALWAYS + varying + written),
        cfl=case.time.cfl,
        fixed_step=case.time.step,
        extremes=ParticleView(
            position=None,
            sound_speed=scene.sound_speed,
            smoothing_length=scene.smoothing_length,
            **{n: max(material_value(m, n) for m in scene.materials) for n in PER_MATERIAL},
        ),
    )


def _carries(call: Called) -> bool:
    """Whether an effect has a part in kick and drift."""
    return any(hasattr(call.effect, name) for name in OF_A_PARTICLE)


def _refuse_unwritten(called, written: tuple[str, ...]) -> None:
    """Raise UnknownField where an effect reads what only an absent effect would write."""
    known = {"velocity", "sound_speed", "smoothing_length", "largest_speed", *ALWAYS, *PER_MATERIAL, *PER_SITE, *written}
    for call in called:
        for name in sorted((call.reads.own | call.reads.neighbour) - known):
            effect = type(call.effect).__name__
            raise UnknownField(f"{effect} reads '{name}', which no effect of this scene writes")


def words(name: str) -> str:
    """``LaminarViscosity`` -> ``laminar viscosity``; an acronym stays one word."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()


def _read_of_neighbours(called) -> set[str]:
    """Names of the fields that some effect reads of a neighbour."""
    # The velocity also tells how far neighbours drift apart.
    names = {"position", "velocity"}.union(*(c.reads.neighbour for c in called))
    return {"predicted_velocity" if n == "velocity" else n for n in names}


def _split(scene, names) -> tuple[dict[str, float], tuple[str, ...]]:
    """Quantities fixed at the start that the scene reads: shared values, and names of those that vary."""
    shared, varying = {}, []
    for name in PER_MATERIAL:
        values = {material_value(m, name) for m in scene.materials}
        if name != "mass" and name not in names:
            continue
        if len(values) == 1:
            shared[name] = values.pop()
        else:
            varying.append(name)
    return shared, (*varying, *(name for name in PER_SITE if name in names))


def material_value(material, name: str) -> float:
    """A material's value of one of ``PER_MATERIAL``."""
    return float(getattr(material, "density" if name == "rest_density" else name))


def _in_scene(effect, scene):
    """The form of an effect that a scene calls for, or None."""
    return effect.in_scene(scene) if hasattr(effect, "in_scene") else effect


def _why_dropped(effect, scene, reason: str) -> str:
    """Why an effect that ``reason`` calls for has no form in a scene."""
    why = effect.why_absent(scene) if hasattr(effect, "why_absent") else "this scene has no use for it"
    return f"left out, though {reason}: {why}"


def _called_for(case, entry: Entry) -> tuple[Any, str] | None:
    """The effect with its parameters and why it is there, or None."""
    if not entry.key:
        return entry.effect(), "every scene"
    key, _, choice = entry.key.partition("=")
    for path, value, given in _values(case, key.split(".")):
        by = f"{path} = {_plain(value)}" + _origin(case, path, given)
        if choice:
            if value == choice:
                return entry.effect(), by
        elif "*" in key:
            if value:
                return entry.effect(), by
        elif value is not None:
            return entry.effect(**as_numbers(value)), by
    return None


def _origin(case, path: str, given: bool) -> str:
    """Where a value comes from, where the case does not give it."""
    if name := case.preset(path):
        return f" ({name})"
    return "" if given else " (default)"


def _values(node, keys: list[str], path: str = "", given: bool = True):
    """Every (path, value, whether the case gives it) that a key with ``*`` stands for."""
    if not keys:
        yield path, node, given
        return
    head, *rest = keys
    names = list(node) if head == "*" else [head]
    for name in names:
        below = node[name] if isinstance(node, dict) else getattr(node, name)
        set_here = isinstance(node, dict) or name in node.model_fields_set
        yield from _values(below, rest, f"{path}.{name}".strip("."), given and set_here)


def _plain(value) -> str:
    if hasattr(type(value), "model_fields"):
        inner = ", ".join(f"{k} = {_plain(v)}" for k, v in dict(value).items())
        return "{ " + inner + " }"
    if isinstance(value, bool):
        return str(value).lower()
    return str(list(value)) if isinstance(value, (list, tuple)) else f"{value}"

