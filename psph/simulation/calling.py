"""Which effects a case calls for, and by which of its keys."""

from typing import Any

from psph.acts import acts_on
from psph.case import Case
from psph.case.corners import matter_in
from psph.case.parameters import as_numbers
from psph.physics.catalogue import Entry

WALLS = "walls"
"""Keys of walls are asked of rigid bodies too: to the fluid they are walls."""


def acts_in(case, effect: type) -> bool:
    """Whether there is matter in a case on which an effect acts."""
    return not matter_in(case).isdisjoint(acts_on(effect))


def in_scene(effect, scene):
    """The form of an effect that a scene needs, or None."""
    return effect.in_scene(scene) if hasattr(effect, "in_scene") else effect


def why_dropped(effect, scene, reason: str) -> str:
    """Why an effect that ``reason`` asks for has no form in a scene."""
    why = effect.why_absent(scene) if hasattr(effect, "why_absent") else "this scene has no use for it"
    return f"left out, though {reason}: {why}"


def called_for(case, entry: Entry) -> tuple[Any, str] | None:
    """The effect with its parameters and why it is there, or None."""
    if not entry.key:
        return entry.effect(), "every scene"
    calls = (_called_by(case, entry, key) for key in entry.key.split("|"))
    return next((call for call in calls if call), None)


def _called_by(case, entry: Entry, key: str) -> tuple[Any, str] | None:
    """The same by one of its keys."""
    key, _, choice = key.partition("=")
    for path, value, given in _values(case, key.split(".")):
        by = path if key.endswith("*") else f"{path} = {_plain(value)}" + _origin(case, path, given)
        if choice:
            if value == choice:
                return entry.effect(), by
        elif "*" in key or isinstance(value, tuple):
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
    if isinstance(node, Case) and head == WALLS:
        for table, name, one in (entry for entry in node.entries if entry.of.rigid):
            yield from _values(one, rest[1:], f"{table}.{name}")
        return
    for name in names:
        below = node[name] if isinstance(node, dict) else getattr(node, name)
        set_here = isinstance(node, dict) or name in node.model_fields_set
        yield from _values(below, rest, f"{path}.{name}".strip("."), given and set_here)


def _plain(value) -> str:
    if hasattr(type(value), "model_fields"):
        inner = ", ".join(f"{k} = {_plain(v)}" for k, v in dict(value).items() if v is not None)
        return "{ " + inner + " }"
    if isinstance(value, bool):
        return str(value).lower()
    return f"[{', '.join(map(_plain, value))}]" if isinstance(value, (list, tuple)) else f"{value}"
