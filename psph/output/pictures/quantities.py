"""What is shown of a frame: a saved field, or one that follows from several."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from psph.fields import DENSITY, FLUID, GAS, PRESSURE
from psph.output.errors import NotThere
from psph.output.pictures.groups import matter_of, spreading_of, wholes_called
from psph.output.pictures.vorticity import vorticity
from psph.output.reader import Run
from psph.output.sizes import LENGTH

VELOCITY, SPEED, VORTICITY, GROUP = "velocity", "speed", "vorticity", "group"
"""The field, its size under the name that people use, its curl, and the number of a fluid or wall."""
SAMPLES, FEW_SAMPLES = 25, 4
"""Frames over a run that the limits of the colours are taken from; those of a field that takes long."""
VON_MISES, DEVIATOR = "von_mises", "deviator"
"""The stress √(3J₂), where frames hold the deviator that it follows from, and no field of its own."""


class Quantity(NamedTuple):
    """Something to colour by: ``values`` (n,) in ``unit`` of a frame that holds the fields ``reads``, and
    the ``width`` of particles.

    ``name`` stands in the names of files.  ``signed``: its sign matters as much as its size: zero is in the
    middle of its colours.  ``names`` has those of the fluids where it counts them, ``whole`` the
    word for what is moved as a whole, which shares a colour.  ``of_flow``: where there are any, the limits
    of the colours are theirs, since stresses of solids beside them are of another size.  ``steep``:
    its colours go by powers of ten, from dark, where it spans more than one.
    """

    name: str
    title: str
    unit: str
    reads: tuple[str, ...]
    values: Callable[[dict], np.ndarray]
    signed: bool = False
    names: tuple[str, ...] = ()
    whole: str = ""
    samples: int = SAMPLES
    of_flow: bool = False
    steep: bool = False


def quantity(run: Run, case: dict, field: str) -> Quantity:
    """What ``field`` asks for.  NotThere if the frames do not have it."""
    match field:
        case "velocity" | "speed":
            return Quantity(VELOCITY, SPEED, run.unit(VELOCITY), (VELOCITY,), _size_of(VELOCITY))
        case "vorticity":
            return _vorticity(case)
        case "group":
            return Quantity(
                GROUP,
                "group",
                "",
                (GROUP,),
                _size_of(GROUP),
                names=tuple(name for name, _ in matter_of(case)),
                whole=wholes_called(case),
            )
    saved = run.fields
    if field == VON_MISES and DEVIATOR in saved and field not in saved:
        return Quantity(field, "von Mises stress", run.unit(DEVIATOR), (DEVIATOR,), _von_mises)
    if field not in saved:
        known = ", ".join([*saved, SPEED, VORTICITY])
        raise NotThere(f"{run.path}: field: {field} is not saved; choose one of {known}")
    fluid, thins_out = field == PRESSURE.name, field == DENSITY.name and LENGTH in saved
    title, unit = field.replace("_", " "), run.unit(field)
    return Quantity(field, title, unit, (field,), _size_of(field), of_flow=fluid, steep=thins_out)


def usual(run: Run, case: dict) -> str:
    """The field to be seen where none is asked for: the pressure, and of a run of elastic solids alone the
    von Mises stress."""
    return PRESSURE.name if spreading_of(case) or VON_MISES not in run.fields else VON_MISES


def _size_of(field: str) -> Callable[[dict], np.ndarray]:
    """The field as one number per particle; the length of a vector."""

    def values(frame: dict) -> np.ndarray:
        rows = frame[field].astype(float)
        return np.linalg.norm(rows, axis=1) if rows.ndim == 2 else rows

    return values


def _von_mises(frame: dict) -> np.ndarray:
    """√(3J₂) of a deviator by rows from the diagonal on; in 2D s_zz = −(s_xx + s_yy)."""
    s = frame[DEVIATOR].astype(float)
    plane = s.shape[1] == 3
    on = s[:, [0, 2]] if plane else s[:, [0, 3, 5]]
    off = s[:, [1]] if plane else s[:, [1, 2, 4]]
    return np.sqrt(1.5 * ((on**2).sum(axis=1) + on.sum(axis=1) ** 2 + 2.0 * (off**2).sum(axis=1)))


def _vorticity(case: dict) -> Quantity:
    """ω of the fluid: its component out of the plane in 2D, its size in 3D.  NotThere in 1D."""
    space = case["space"]
    dimensions = space["dimensions"]
    if dimensions == 1:
        raise NotThere("plot --field vorticity: a flow along one axis has none; choose another field")
    flowing = spreading_of(case)
    if not flowing:
        raise NotThere("plot --field vorticity: the run has no fluid; choose von_mises, or another field")
    periods = periods_of(case)

    def values(frame: dict) -> np.ndarray:
        fluid = np.isin(frame["kind"], (FLUID, GAS))
        width = frame["width"][fluid]
        if LENGTH in frame:
            volume = width**dimensions
        else:
            rest = np.array([material["density"] for _, material in flowing])
            volume = rest[frame["group"][fluid]] / frame["density"][fluid] * width**dimensions
        reach = 2.0 * space["smoothing"] * width
        omega = vorticity(frame["position"][fluid], frame["velocity"][fluid], volume, reach, periods)
        sizes = np.full(len(fluid), np.nan)
        sizes[fluid] = omega if omega.ndim == 1 else np.linalg.norm(omega, axis=1)
        return sizes

    reads = (VELOCITY, "density", "group")
    plane = dimensions == 2
    return Quantity(VORTICITY, VORTICITY, "1/s", reads, values, signed=plane, samples=FEW_SAMPLES)


def periods_of(case: dict) -> list[float]:
    """The period of each axis, m; 0 where it does not repeat."""
    space = case["space"]
    repeats = ["xyz"[d] in space.get("periodic", ()) for d in range(space["dimensions"])]
    return [space["upper"][d] - space["lower"][d] if again else 0.0 for d, again in enumerate(repeats)]
