"""Profiles: numerical choices under one name, for the keys that a case does not give itself."""

from collections.abc import Mapping
from typing import Any

from psph.case.schemes import SCHEMES, scheme_keys, scheme_of

Location = tuple[str | int, ...]

OFF = "off"
"""The value that removes a key from the case."""

PROFILES: dict[str, dict[str, Any]] = {
    "quick": {"precision": "mixed"},
    "reference": {"physics.local_potential": OFF},
}
"""By which keys each differs from the default scheme; docs/accuracy.md has the error and cost of each."""

CLOSED: dict[str, dict[str, Any]] = {
    "quick": PROFILES["quick"],
    "reference": {"physics.position_shift": OFF, "physics.particle_shifting": 0.1},
}
"""The same in a domain that is periodic along every axis.  There the fluid has no surface, and a shift may
carry velocity along, which at a surface ruins the flow."""


def choices(profile: str, dimensions: int, periodic: tuple[str, ...]) -> dict[str, Any]:
    """Dotted keys and values of a profile, in a domain that is periodic along these axes."""
    return (CLOSED if len(set(periodic)) == dimensions else PROFILES)[profile]


def fill(data: dict[str, Any], touched: list[Location], made: list[Location]) -> dict[tuple[str, ...], str]:
    """Add the keys of the profile and the scheme to ``data``; which of them set which location.

    Keys at, above or below those ``touched`` stay as they are; where these are within a table that they have
    ``made``, since the file has none, they change that of the profile or scheme.  A profile or a scheme that
    is itself among these takes the place of all others.
    """
    filled: dict[tuple[str, ...], str] = {}
    data["scheme"] = scheme_of(data)
    named = {key: ("scheme", value) for key, value in _scheme_keys(data).items()}
    named |= {key: ("profile", value) for key, value in _profile_keys(data).items()}
    for key, (name, value) in named.items():
        path = tuple(key.split("."))
        table = data.setdefault(path[0], {}) if len(path) > 1 else data
        if not isinstance(table, dict):
            continue
        if any(_share(path, other) for other in touched):
            within = path not in touched and any(one == path[: len(one)] for one in made)
            if isinstance(value, dict) and within and isinstance(table.get(path[-1]), dict):
                table[path[-1]] = value | table[path[-1]]
            continue
        if value == OFF and (name,) in touched:
            table.pop(path[-1], None)
        elif value != OFF and ((name,) in touched or path[-1] not in table):
            table[path[-1]] = value
            filled[path] = f"{name} {data[name]}"
    return filled


def _profile_keys(data: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of the profile that a file names; empty if the file is wrong, which is reported elsewhere."""
    name, space = data.get("profile"), data.get("space")
    if not isinstance(name, str) or name not in PROFILES:
        return {}
    space = space if isinstance(space, dict) else {}
    axes = space.get("periodic", ())
    axes = tuple(map(str, axes)) if isinstance(axes, (list, tuple)) else ()
    return choices(name, space.get("dimensions"), axes)


def _scheme_keys(data: Mapping[str, Any]) -> dict[str, Any]:
    name, physics, space = data["scheme"], data.get("physics"), data.get("space")
    if not isinstance(name, str) or name not in SCHEMES:
        return {}
    surface = isinstance(physics, dict) and "free_surface" in physics
    return scheme_keys(name, surface, space if isinstance(space, dict) else {})


def _share(one: tuple, other: tuple) -> bool:
    """Whether a location is the other one, or lies above or below it."""
    least = min(len(one), len(other))
    return one[:least] == other[:least]
