"""Profiles: numerical choices under one name, for the keys that a case does not give itself."""

from collections.abc import Mapping
from typing import Any

from psph.case.schemes import SCHEMES, scheme_keys, scheme_of

OFF = "off"
"""The value that removes a key from the case."""

PROFILES: dict[str, dict[str, Any]] = {
    "quick": {
        "precision": "mixed",
        "space.kernel": "wendland-c2",
        "space.smoothing": 1.3,
        "time.cfl": 0.4,
        "physics.pressure_gradient": "symmetric",
        "physics.density_diffusion": 0.05,
        "physics.particle_shifting": OFF,
        "physics.gradient_correction": OFF,
    },
    "engineering": {
        "precision": "double",
        "space.kernel": "wendland-c2",
        "space.smoothing": 1.4,
        "time.cfl": 0.3,
        "physics.pressure_gradient": "symmetric",
        "physics.density_diffusion": 0.1,
        "physics.particle_shifting": OFF,
        "physics.gradient_correction": 0.5,
    },
    "reference": {
        "precision": "double",
        "space.kernel": "wendland-c2",
        "space.smoothing": 2.0,
        "time.cfl": 0.3,
        "physics.pressure_gradient": "symmetric",
        "physics.density_diffusion": 0.1,
        "physics.particle_shifting": OFF,
        "physics.gradient_correction": 0.5,
    },
}
"""Keys and values; docs/accuracy.md has the error and cost of each.  Neither shifting nor pressure
from differences works at a free surface yet, so these profiles use neither.  Half these steps change no
error of the cases by more than 2 % of itself, sound apart."""

PERIODIC: dict[str, dict[str, Any]] = {
    "quick": {
        "physics.pressure_gradient": "difference",
        "physics.particle_shifting": 0.1,
    },
    "engineering": {
        "physics.pressure_gradient": "difference",
        "physics.particle_shifting": 0.1,
    },
    "reference": {
        "physics.pressure_gradient": "difference",
        "physics.density_diffusion": 0.2,
        "physics.particle_shifting": 0.1,
    },
}
"""The keys that differ in a domain that is periodic along every axis: the fluid has no surface, and
under tension particles clump without shifting."""


def choices(profile: str, dimensions: int, periodic: tuple[str, ...]) -> dict[str, Any]:
    """Dotted keys and values of a profile, in a domain that is periodic along these axes."""
    closed = len(set(periodic)) == dimensions
    return PROFILES[profile] | (PERIODIC[profile] if closed else {})


def fill(data: dict[str, Any], touched: list[tuple[str | int, ...]]) -> dict[tuple[str, ...], str]:
    """Add the keys of the profile and the scheme to ``data``; which of them set which location.

    Keys at, above or below those ``touched`` stay as they are.  A profile or a scheme that is
    itself among these takes the place of all others.
    """
    filled: dict[tuple[str, ...], str] = {}
    data["scheme"] = scheme_of(data)
    for name, keys in (("profile", _profile_keys(data)), ("scheme", _scheme_keys(data))):
        for key, value in keys.items():
            path = tuple(key.split("."))
            table = data.setdefault(path[0], {}) if len(path) > 1 else data
            if not isinstance(table, dict) or any(_share(path, other) for other in touched):
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
    name, physics = data["scheme"], data.get("physics")
    if not isinstance(name, str) or name not in SCHEMES:
        return {}
    return scheme_keys(name, isinstance(physics, dict) and "free_surface" in physics)


def _share(one: tuple, other: tuple) -> bool:
    """Whether a location is the other one, or lies above or below it."""
    least = min(len(one), len(other))
    return one[:least] == other[:least]
