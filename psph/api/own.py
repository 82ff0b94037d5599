"""Effects, kernels, motions and gauges of a person's own, from Python objects to a catalogue and keys."""

from collections.abc import Iterable, Mapping
from typing import Any

from psph.case.given import key_of
from psph.errors import Refused
from psph.physics.catalogue import Catalogue, Entry


def own(effects: Iterable, kernel: type | None, motions: Mapping[str, Any], gauges: Iterable):
    """The catalogue of what is given, and the keys of a case that call for it.

    An effect ``Cohesion(strength=0.3)`` is ``physics.cohesion = { strength = 0.3 }``, a motion of the
    wall "belt" ``walls.belt.motion.steady``, a gauge ``tables.front``.  A class without values, as for a
    run that goes on, brings no keys.  Raises Refused.
    """
    entries: dict[str, list[Entry]] = {"effects": [], "motions": [], "tables": [], "kernels": []}
    changes: dict[str, Any] = {}

    def add(group: str, key: str, one: Any, where: str) -> None:
        kind = one if isinstance(one, type) else type(one)
        if not (issubclass(kind, tuple) and hasattr(kind, "_fields") and kind is not tuple):
            raise Refused(f"{kind.__name__}: not a NamedTuple; docs/python.md shows how to write one")
        entry = Entry(key.format(named(kind)), kind)
        if entry not in entries[group]:
            entries[group].append(entry)
        if one is not kind:
            changes[where.format(named(kind))] = one._asdict()

    for effect in effects:
        add("effects", "physics.{}", effect, "physics.{}")
    for wall, motion in motions.items():
        add("motions", "walls.*.motion.{}", motion, f"walls.{wall}.motion.{{}}")
    for gauge in gauges:
        add("tables", "tables.{}", gauge, "tables.{}")
    if kernel is not None:
        add("kernels", "space.kernel={}", kernel, "")
        changes["space.kernel"] = named(kernel)
    return Catalogue(**{group: tuple(found) for group, found in entries.items()}), changes


def named(kind: type) -> str:
    """The key of a class: ``SurfaceCohesion`` is ``surface_cohesion``."""
    return key_of(kind.__name__)
