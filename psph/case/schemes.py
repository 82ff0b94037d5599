"""Schemes: numerical choices under one name, for the keys that a case does not give itself."""

import json
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

STABLE, PLAIN, SOLID, GAS = "stable", "sph", "solid", "gas"

SCHEMES: dict[str, dict[str, Any]] = {
    STABLE: {
        "space.kernel": "wendland-c2",
        "space.smoothing": 1.4,
        "time.cfl": 0.5,
        "time.passes": "auto",
        "time.lead": 0.05,
        "time.gather_every": 8,
        "physics.pressure_gradient": "symmetric",
        "physics.gradient_correction": 0.7,
        "physics.fourth_order_diffusion": 0.1,
        "physics.reconstructed_damping": {"alpha": 0.03, "in_disorder": 0.2},
        "physics.impact_damping": 4.0,
        "physics.local_potential": {"strength": 0.004, "threshold": 0.2},
        "physics.position_shift": 0.1,
        "physics.summation_density": 0.002,
        "physics.wall_approach": 2.2,
        "physics.tension_floor": 0.98,
        "physics.background_pressure": "auto",
        "neighbours.skin": 0.16,
        "neighbours.least_skin": 0.04,
    },
    PLAIN: {
        "space.kernel": "cubic",
        "space.smoothing": 1.2,
        "physics.pressure_gradient": "symmetric",
    },
    "ssph": {
        "space.kernel": "hyperbolic",
        "space.smoothing": 1.2,
        "physics.pressure_gradient": "minimum",
    },
    SOLID: {
        "space.kernel": "wendland-c2",
        "space.smoothing": 1.4,
        "time.cfl": 0.4,
        "physics.pressure_gradient": "symmetric",
        "physics.artificial_viscosity": {"alpha": 1.0, "beta": 2.0},
        "physics.artificial_stress": 0.3,
    },
    GAS: {
        "space.kernel": "wendland-c2",
        "space.smoothing": 1.4,
        "time.cfl": 0.2,
        "physics.pressure_gradient": "symmetric",
        "physics.shock_viscosity": {"alpha": 1.0, "beta": 2.0},
        "physics.heat_conduction": 1.0,
        "neighbours.skin": 0.15,
    },
}
"""The default scheme, and the two of Acta Phys. Sin. 61, 224701 (2012): plain SPH, eqs. (5) to (7)
with (9), and SSPH, (13) and (15): docs/stability.md has the results of each.  Then that of solids that are
updated Lagrangian, with the friction and the artificial stress of Gray, Monaghan & Swift (2001), and that of
ideal gases, with the viscosity and the conduction of Price (2012)."""


class Ratios(NamedTuple):
    """Some h/dx in so many ``dimensions``: not below ``least``, and below ``most``."""

    dimensions: int
    least: float
    most: float

    def hold(self, dimensions: Any, ratio: float) -> bool:
        """Whether this one is among them."""
        return dimensions == self.dimensions and self.least <= ratio < self.most


class Fitting(NamedTuple):
    """``keys`` that the default scheme has at these ``ratios``."""

    ratios: Ratios
    keys: dict[str, Any]


FITTINGS = (
    Fitting(Ratios(2, 0.0, 1.075), {"physics.local_potential": {"strength": 0.016, "threshold": 0.03}}),
    Fitting(
        Ratios(2, 1.175, 1.225),
        {"space.kernel": "cubic", "physics.local_potential": {"strength": 0.004, "threshold": 0.05}},
    ),
    Fitting(Ratios(2, 1.225, 1.325), {"space.kernel": "hyperbolic"}),
    Fitting(Ratios(2, 1.425, 1.75), {"physics.local_potential": {"strength": 0.004, "threshold": 0.01}}),
    Fitting(Ratios(3, 1.275, 1.375), {"space.kernel": "hyperbolic"}),
)
"""Without these still water does not come to rest, since lattices buckle under its pressure.  Either the
square, or in 3D the cubic lattice is stable under the kernel (docs/stability.md, the map), or the potential
acts in little disorder too, or both (docs/scheme.md, Other h/dx)."""

RESTLESS = (Ratios(2, 1.075, 1.175), Ratios(3, 1.05, 1.275), Ratios(3, 1.525, math.inf))
"""Where nothing was found under which still water comes to rest, and it boils."""

OF_FLUIDS = tuple(name for name in SCHEMES if name not in (SOLID, GAS))
"""Those for fluids."""

SURFACE = "physics.free_surface"
"""With the paper's free-surface condition, eq. (14), its pressure gradient is eq. (6)."""


def by_default(key: str) -> str:
    """What the reference says of a key that the default scheme sets; empty: it does not."""
    value = SCHEMES[STABLE].get(key)
    if value is None:
        return ""
    inner = value.items() if isinstance(value, dict) else ()
    text = f"{{ {', '.join(f'{k} = {v}' for k, v in inner)} }}" if inner else json.dumps(value)
    return f"`{text}` in the default scheme"


def scheme_of(data: Mapping[str, Any]) -> Any:
    """The scheme that a file names; else the default scheme."""
    return data.get("scheme", STABLE)


def scheme_keys(scheme: str, free_surface: bool, space: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted keys and values of a scheme; ``free_surface``: the case gives eq. (14).

    ``space``: the keys of that table which the case gives, for the default scheme is fitted to h/dx.
    """
    keys = SCHEMES[scheme]
    if free_surface:
        keys = keys | {"physics.pressure_gradient": "symmetric"}
    return keys | _fitted(keys, space) if scheme == STABLE else keys


def _fitted(keys: Mapping[str, Any], space: Mapping[str, Any]) -> dict[str, Any]:
    """What the fitting to h/dx changes; nothing where the case gives another kernel."""
    ratio = space.get("smoothing")
    if not isinstance(ratio, int | float):
        return {}
    for one in FITTINGS:
        if one.ratios.hold(space.get("dimensions"), ratio):
            kernel = (keys | one.keys)["space.kernel"]
            return one.keys if space.get("kernel", kernel) == kernel else {}
    return {}
