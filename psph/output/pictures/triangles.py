"""Walls and bodies of a run in 3D as triangles, for viewers such as ParaView: an XDMF file of its own."""

import os
import tomllib
from pathlib import Path

import h5py
import numpy as np

from psph.errors import Refused
from psph.output.errors import NotThere
from psph.output.pictures import names
from psph.output.pictures.carried import Carried, carried_parts
from psph.output.pictures.once import once
from psph.output.pictures.walls import Triangles
from psph.output.progress import with_progress
from psph.output.reader import Run
from psph.output.xdmf import ENDING, HEAD, TAIL, item

READS = ("position", "kind", "group", "id")
"""Fields of frames."""

_GRID = """      <Grid Name="{name}" GridType="Uniform">
        <Time Value="{time!r}"/>
        <Topology TopologyType="Triangle" NumberOfElements="{count}">
          {corners}
        </Topology>
        <Geometry GeometryType="XYZ">
          {points}
        </Geometry>
        <Attribute Name="group" AttributeType="Scalar" Center="Cell">
          {group}
        </Attribute>
      </Grid>
"""


def triangles(folder: Path) -> Path:
    """Write walls and bodies in every frame of the run in ``folder``; the path of the XDMF file.

    It stands in the folder ``solids`` beside an HDF5 file with ``points`` (n, 3) in m, ``corners`` (m, 3),
    rows of these, and ``group`` (m,) of each triangle, as particles have it.  What does not differ from one
    frame to the next is there once.  Raises Refused for a run that is not in 3D or has no walls and bodies.
    """
    run = Run(folder)
    case = tomllib.loads(run.case_text)
    if case["space"]["dimensions"] != 3:
        raise Refused(f"plot --solids: the run has {case['space']['dimensions']} dimensions; leave it out")
    if not len(run.times):
        raise NotThere(f"{run.path}: no frame yet; wait for the first one")
    start = once(run.frame(0, *READS), case)
    parts = list(carried_parts(case, start, case["space"]["spacing"], run.folder))
    if not parts:
        raise Refused("plot --solids: the run has no walls and no bodies; leave it out")
    (run.folder / names.TRIANGLES).mkdir(exist_ok=True)
    path = run.folder / names.TRIANGLES / run.path.name
    fresh = path.with_name(f"{path.name}.new")
    with h5py.File(fresh, "w") as file:
        grids = [
            _grid(file, path, parts, run, case, k)
            for k in with_progress(range(len(run.times)), "moving walls", "frames")
        ]
    os.replace(fresh, path)
    index = path.with_suffix(ENDING)
    index.write_text(HEAD.format(name=names.TRIANGLES) + "".join(grids) + TAIL, encoding="utf-8")
    return index


def _grid(file: h5py.File, path: Path, parts: list[Carried], run: Run, case: dict, k: int) -> str:
    """The element of frame ``k``, whose arrays are written into ``file``."""
    frame = once(run.frame(k, *READS), case)
    faces = [part.at(frame) for part in parts]
    arrays = dict(zip(("points", "corners"), _joined(np.concatenate(faces))))
    arrays["group"] = np.repeat([part.group for part in parts], [len(one) for one in faces]).astype(np.int64)
    items = {
        name: item(path, _kept(file, name, k, rows), (rows.shape, rows.dtype))
        for name, rows in arrays.items()
    }
    return _GRID.format(name=f"{k:05d}", time=float(run.times[k]), count=len(arrays["corners"]), **items)


def _joined(faces: Triangles) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) and, of each triangle, its rows of them (m, 3)."""
    points, rows = np.unique(faces.reshape(-1, 3), axis=0, return_inverse=True)
    return points, rows.reshape(-1, 3).astype(np.int64)


def _kept(file: h5py.File, name: str, k: int, rows: np.ndarray) -> str:
    """Where the array of frame ``k`` stands: with the last one before, if that is the same."""
    earlier = list(file.require_group(name))
    if earlier and np.array_equal(file[name][earlier[-1]], rows):
        return f"{name}/{earlier[-1]}"
    file[name].create_dataset(f"{k:05d}", data=rows)
    return f"{name}/{k:05d}"
