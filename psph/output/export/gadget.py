"""Frames as snapshots in HDF5 like those of Gadget, which tools of astrophysics read.

Springel (2005), MNRAS 364, 1105, and the user guide of GADGET-4, section "Format of snapshot files": a group
``PartTypeN`` for each type of particle, a ``Header``, and ``Units`` in cgs.
"""

import os
from pathlib import Path

import h5py
import numpy as np

from psph.output.export.parts import Exported, in_space
from psph.output.progress import with_progress
from psph.output.sizes import LENGTH

TYPES = 6
"""Types of particles that a snapshot can have."""

_NAMES = {
    "position": "Coordinates",
    "velocity": "Velocities",
    "id": "ParticleIDs",
    "mass": "Masses",
    "thermal_energy": "InternalEnergy",
}
"""Names that Gadget has of its own; others are made of psph's, ``strain_rate`` as ``StrainRate``."""

_SI = {
    "UnitLength_in_cm": 1e2,
    "UnitMass_in_g": 1e3,
    "UnitVelocity_in_cm_per_s": 1e2,
    "UnitTime_in_s": 1.0,
}


def write_gadget(exported: Exported, folder: Path) -> list[Path]:
    """Write a snapshot for each chosen frame into ``folder``; their paths.

    ``PartType0`` are the fluids, 1 walls, 2 elastic solids, 3 rigid bodies (``PARTS``).  Numbers are those of
    the frames, to the bit, vectors with three components.  ``SmoothingLength`` is the radius of the
    kernel's support, as in Gadget, of each particle where they differ.
    """
    paths = [folder / f"{exported.stem}_{k:05d}.hdf5" for k in exported.chosen]
    for k, path in with_progress(list(zip(exported.chosen, paths)), "writing", "snapshots"):
        fresh = path.with_name(f"{path.name}.new")
        with h5py.File(fresh, "w") as file:
            _fill(file, exported, k)
        os.replace(fresh, path)
    return paths


def _fill(file: h5py.File, exported: Exported, k: int) -> None:
    frame = exported.run.frame(k)
    dimensions = frame["position"].shape[1]
    part = exported.parts(frame["group"])
    lengths, scene = frame.pop(LENGTH, None), exported.scene
    frame.setdefault("mass", exported.masses[frame["group"]])
    support = exported.support * 0.5 ** exported.levels[frame["group"]]
    if lengths is not None:
        support = exported.support / scene.smoothing_length * lengths
    counts = np.bincount(part, minlength=TYPES).astype(np.int32)
    file.create_group("Header").attrs.update(_header(exported, k, frame["position"], counts))
    file.create_group("Units").attrs.update(_SI)
    for number in np.flatnonzero(counts):
        of_kind = part == number
        group = file.create_group(f"PartType{number}")
        for name, rows in frame.items():
            _add(group, _called(name), in_space(rows, dimensions)[of_kind], exported.units[name])
        _add(group, "SmoothingLength", support[of_kind], "m")


def _header(exported: Exported, k: int, position: np.ndarray, counts: np.ndarray) -> dict:
    """What readers ask of a snapshot; a redshift of 0 and no expansion."""
    return {
        "NumPart_ThisFile": counts,
        "NumPart_Total": counts.astype(np.uint32),
        "NumPart_Total_HighWord": np.zeros(TYPES, np.uint32),
        "NumFilesPerSnapshot": 1,
        "MassTable": np.zeros(TYPES),
        "Time": float(exported.times[k]),
        "Redshift": 0.0,
        "BoxSize": float(np.ptp(position, axis=0).max()) + exported.scene.spacing,
        "Dimension": position.shape[1],
        "Flag_DoublePrecision": 1,
        **{f"Flag_{name}": 0 for name in ("Sfr", "Cooling", "StellarAge", "Metals", "Feedback")},
        "GroupNames": ", ".join(exported.names),
    }


def _add(group: h5py.Group, name: str, rows: np.ndarray, unit: str) -> None:
    group.create_dataset(name, data=rows).attrs["unit"] = unit


def _called(name: str) -> str:
    return _NAMES.get(name) or name.title().replace("_", "")
