"""The verb ``stability``."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from psph.lab.maps import picture
from psph.lab.maps.survey import SurveyRow, sentences, survey
from psph.lab.maps.tables import CSV, PAGE, PICTURE, UNIT, as_csv, head, line, markdown, subtitle, write
from psph.smoothing import KERNELS
from psph.theory.stability import STATES, SYMMETRIC
from psph.theory.stability.errors import StabilityError
from psph.theory.stability.growth import Growth, box_growth, growth
from psph.theory.stability.parts import REMEDIES
from psph.theory.stability.uniform import STIFF, Settings
from psph.theory.stability.windows import SMOOTHINGS

SMOOTHING, LATTICE, FOLDER = 1.4, "square", Path("stability")
"""Defaults; h/dx as in a case."""

NARROWEST, WIDEST = 0.6, 4.0
"""h/dx, the bounds of a case."""


class Asked(NamedTuple):
    """The options of the verb, None where one is left out."""

    kernel: str | None = None
    smoothing: float | None = None
    lattice: str = LATTICE
    state: str | None = None
    form: str = SYMMETRIC
    remedies: tuple[str, ...] = ()
    pressure: float | None = None
    density: float | None = None
    sound_speed: float | None = None
    spacing: float | None = None
    box: int | None = None
    out: Path | None = None
    json: bool = False


def stability(comm, asked: Asked) -> None:
    """Compute and print the growth, on rank 0.

    Raises StabilityError for what makes no sense, on every rank.
    """
    settings = _settings(asked) if asked.kernel else _settings_of_map(asked)
    if comm.rank != 0:
        return
    if not asked.kernel:
        _map(settings, asked.out or FOLDER, asked.json)
        return
    found = box_growth(settings, asked.box) if asked.box is not None else growth(settings)
    for said in words(asked, settings, found):
        print(said)
    if asked.json:
        print(json.dumps(_plain(found)))


def words(asked: Asked, settings: Settings, found: Growth):
    """The answer for one kernel."""
    state = "compression" if settings.pressure > 0.0 else "tension"
    where = f"box of {asked.box} particles along an edge, " if asked.box is not None else ""
    yield (
        f"{settings.kernel}, h/dx {settings.smoothing:g}, {where}{subtitle(_in_units(settings))}, "
        f"under {state}"
    )
    if found.stable:
        yield "  stable: nothing grows"
        return
    rate, wave = ("1/s", "rad/m") if asked.pressure is not None else (UNIT, "rad/dx")
    vector = ", ".join(f"{k:.4g}" for k in found.wave_vector)
    length = 2.0 * np.pi / float(np.linalg.norm(found.wave_vector)) / settings.spacing
    yield (
        f"  unstable: grows by {found.rate:.4g} {rate}, fastest at the wave vector ({vector}) "
        f"{wave}, of wavelength {length:.3g} dx"
    )


def _in_units(settings: Settings) -> Settings:
    """With c in √(|P|/ρ)."""
    unit = np.sqrt(abs(settings.pressure) / settings.density)
    return settings._replace(sound_speed=settings.sound_speed / unit)


def _plain(found: Growth) -> dict:
    return {
        "growth_rate": found.rate,
        "wave_vector": found.wave_vector.tolist(),
        "stable": found.stable,
    }


def _map(settings: Settings, folder: Path, as_json: bool) -> None:
    print(f"fastest growth in {UNIT}; · is stable\n{subtitle(settings)}\n{head()}", flush=True)
    rows: list[SurveyRow] = []
    for row in survey(settings):
        rows.append(row)
        print(line(row), flush=True)
    print()
    for sentence in sentences(rows):
        print(sentence.replace("`", ""))
    write(folder / CSV, as_csv(settings, rows))
    write(folder / PAGE, markdown(settings, rows))
    picture.draw(folder / PICTURE, rows, subtitle(settings))
    print(f"wrote {folder}: {CSV}, {PAGE}, {PICTURE}")
    if as_json:
        print(
            json.dumps(
                [
                    {"kernel": row.kernel, "state": row.state, "smoothing": h, **_plain(one)}
                    for row in rows
                    for h, one in zip(SMOOTHINGS, row.found)
                ]
            )
        )


def _settings_of_map(asked: Asked) -> Settings:
    """Those that all of a map share."""
    of_one = ("smoothing", "state", "pressure", "density", "spacing", "box")
    if given := [name for name in of_one if getattr(asked, name) is not None]:
        raise StabilityError(
            f"stability --{given[0]}: the map has all kernels, h/dx and both states; name one "
            f"with --kernel, of {', '.join(KERNELS)}"
        )
    return _settings(asked._replace(kernel=next(iter(KERNELS)), state="compression"))


def _settings(asked: Asked) -> Settings:
    if asked.kernel not in KERNELS:
        raise StabilityError(f"stability --kernel {asked.kernel}: not known; one of {', '.join(KERNELS)}")
    smoothing = SMOOTHING if asked.smoothing is None else asked.smoothing
    if not NARROWEST <= smoothing <= WIDEST:
        raise StabilityError(f"stability --smoothing {asked.smoothing:g}: give {NARROWEST:g} to {WIDEST:g}")
    for name in ("sound_speed", "density", "spacing"):
        value = getattr(asked, name)
        if value is not None and not 0.0 < value < float("inf"):
            option = name.replace("_", "-")
            raise StabilityError(f"stability --{option} {value:g}: give a number above zero")
    pressure, density, spacing = _units(asked)
    unit = (abs(pressure) / density) ** 0.5
    return Settings(
        asked.kernel,
        smoothing,
        asked.lattice,
        pressure,
        asked.form,
        density,
        asked.sound_speed or STIFF * unit,
        spacing,
        tuple(map(_remedy, asked.remedies)),
    )


def _units(asked: Asked) -> tuple[float, float, float]:
    """Pressure, density and spacing: in SI units, or signs and ones."""
    if asked.pressure is None:
        for name in ("density", "spacing"):
            if getattr(asked, name) is not None:
                raise StabilityError(f"stability --{name}: needs --pressure; give that too, in Pa")
        if asked.state is None:
            raise StabilityError(
                f"stability --kernel {asked.kernel}: give --state {' or '.join(STATES)}, or --pressure in Pa"
            )
        return STATES[asked.state], 1.0, 1.0
    for name in ("density", "spacing"):
        if getattr(asked, name) is None:
            raise StabilityError(f"stability --pressure: give --{name} too, all in SI units")
    if not 0.0 < abs(asked.pressure) < float("inf"):
        raise StabilityError(
            f"stability --pressure {asked.pressure:g}: give a number other than zero, below it for tension"
        )
    if asked.state and STATES[asked.state] * asked.pressure < 0.0:
        raise StabilityError(
            f"stability --pressure {asked.pressure:g}: that is not {asked.state}; remove --state"
        )
    return asked.pressure, asked.density, asked.spacing


def _remedy(text: str):
    """A remedy from NAME or NAME=VALUE."""
    name, _, value = text.partition("=")
    if name not in REMEDIES:
        raise StabilityError(f"stability --with {name}: not known; one of {', '.join(REMEDIES)}")
    kind: Any = REMEDIES[name]
    takes = kind._fields
    if not value:
        if len(takes) > len(kind._field_defaults):
            raise StabilityError(f"stability --with {name}: give {name}=VALUE")
        return kind()
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    if not takes or not 0.0 <= number < float("inf"):
        what = "a number, zero or above" if takes else "no value"
        raise StabilityError(f"stability --with {text}: {name} takes {what}")
    return kind(number)
