"""The properties of a case that an exact solution needs."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Surroundings:
    """The fluid, what acts on it, and the domain: what is known before any speed of sound.

    ``density`` ρ₀ in kg/m³ of the first fluid, ``densities`` those of all in the order of the case, kinematic
    ``viscosity`` in m²/s and ``surface_tension`` in N/m of the first, ``gravity`` in m/s²; ``lower`` and
    ``upper`` are the corners of the domain in m, ``periods`` a length in m or None for each axis.
    """

    dimensions: int
    density: float
    densities: tuple[float, ...] = ()
    viscosity: float
    surface_tension: float = 0.0
    gravity: tuple[float, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    periods: tuple[float | None, ...]


@dataclass(frozen=True, kw_only=True)
class Setting(Surroundings):
    """The same with the ``sound_speed`` c in m/s, which is chosen by the top speed of the solution."""

    sound_speed: float


def whole_waves(setting: Surroundings, axes: tuple[int, ...], length: float) -> str | None:
    """What is wrong where a pattern of this ``length`` in m must repeat along ``axes``."""
    for axis in axes:
        name, period = "xyz"[axis], setting.periods[axis]
        if period is None:
            return f'repeats along {name}; add "{name}" to space.periodic'
        waves = period / length
        if abs(waves - round(waves)) > 1e-9 * waves or round(waves) < 1:
            return (
                f"repeats every {length:g} m, the domain every {period:g} m along {name}; "
                "let the one be a whole multiple of the other"
            )
    return None
