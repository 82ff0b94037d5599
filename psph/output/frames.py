"""All frames of a run in one HDF5 file, written by all ranks at once.

Rank 0 alone lays a frame out (names, shapes, attributes: half a millisecond), all ranks fill it
together, rank 0 puts the time on it.  So a frame with a time is whole.  What is small rank 0 writes
alone, and opens the file once.  A run that is killed while HDF5 writes the layout, for a tenth of a
millisecond, may leave a file that does not open; a checkpoint brings it back.
"""

import math
import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import numpy as np

from psph.fields import SAVED, Field
from psph.output import rows as hdf5
from psph.output.errors import together
from psph.output.structure import Place, copied, put_back
from psph.output.xdmf import XdmfIndex

POINTS = Field("points", "m", "place in space: what XDMF needs of a 1D scene")
CONNECTIVITY = Field("connectivity", "1", "row of each particle: what XDMF needs")

LINE, TENSION = "line", "tension"
"""What the names of attributes of a frame begin with that are of lines: points, and a tension."""


def funnel_notice(comm) -> str | None:
    """The line to print at the start if rank 0 has to write the frames of all ranks."""
    if comm.size == 1 or hdf5.parallel_hdf5():
        return None
    return (
        f"output: h5py is built without MPI: rank 0 writes the frames of all {comm.size} ranks, "
        "in pieces; a parallel h5py writes them faster"
    )


class FrameFile:
    """The frames of a run: ``/frames/00000/position`` and so on, one row a particle.

    Open only while a frame is written: it can be read during the run.  Created here; or, with
    ``kept``, the :meth:`structure` of then, the file of a run that goes on: as it was, in whatever
    state it is now.
    ``attributes`` (numbers and text, such as the case) go to the root of the file; ``fields`` tell
    what may stand in it, in this order.
    All methods are collective over ``comm`` and raise OutputError on every rank.
    """

    def __init__(
        self,
        path: Path,
        comm,
        attributes: dict,
        kept: bytes | None = None,
        fields: Iterable[Field] = SAVED,
    ):
        self._fields = {field.name: field for field in (*fields, POINTS, CONNECTIVITY)}
        self.path, self.comm = Path(path), comm
        self._index = XdmfIndex(self.path)
        self._connected: set[int] = set()
        self._places: list[Place] = []
        self._lines: dict[str, np.ndarray | float] = {}
        with together(comm, self.path):
            if comm.rank == 0 and kept is None:
                self._create(attributes)
            elif comm.rank == 0:
                self._reopen(attributes, kept)
        if kept is not None:
            self._connected = comm.bcast(self._connected)

    def write(
        self,
        index: int,
        time: float,
        step: int,
        arrays: dict[str, np.ndarray],
        lines: dict[str, tuple[np.ndarray, float]] | None = None,
    ) -> None:
        """Append a frame: the rows of the ranks one after another, in the order of the ranks.

        ``arrays`` holds the rows of this rank: ``(n,)`` or ``(n, dim)``, ``position`` among them.
        They may be views of any layout: one at a time is copied, to spare memory.  ``lines`` by name, the
        same on every rank, are points (m, dim), m, and a tension, N: attributes of the frame.
        """
        frame = f"frames/{index:05d}"
        counts = self.comm.allgather(len(arrays["position"]))
        self._lines = {
            f"{what} {name}": value
            for name, line in (lines or {}).items()
            for what, value in zip((LINE, TENSION), line)
        }
        first, total = sum(counts[: self.comm.rank]), sum(counts)
        rows = self._rows(frame, arrays, first, total)
        shapes = {name: (total, *part.shape[1:]) for name, part in rows.items()}
        kinds = {name: (shapes[name], part.dtype) for name, part in rows.items()}
        if hdf5.by_rank_0(self.comm, rows, counts):
            with together(self.comm, self.path):
                self._write_alone(frame, time, step, shapes, rows, counts)
                if self.comm.rank == 0:
                    self._index.add(frame, time, kinds)
        else:
            with together(self.comm, self.path):
                if self.comm.rank == 0:
                    with hdf5.opened(self.path) as file:
                        self._lay_out(file, frame, step, shapes, rows)
            with together(self.comm, self.path):
                hdf5.fill(self.path, self.comm, rows, counts)
            with together(self.comm, self.path):
                if self.comm.rank == 0:
                    with hdf5.opened(self.path) as file:
                        hdf5.complete(file, frame, "time", float(time))
                    self._index.add(frame, time, kinds)

    def _write_alone(self, frame, time, step, shapes, rows, counts) -> None:
        """Rank 0 lays the frame out, fills it with what the others send and completes it."""
        if self.comm.rank != 0:
            return hdf5.fill(self.path, self.comm, rows, counts)
        with hdf5.opened(self.path) as file:
            try:
                self._lay_out(file, frame, step, shapes, rows)
            except (OSError, RuntimeError):
                hdf5.drop(self.comm, rows, counts)
                raise
            hdf5.fill(self.path, self.comm, rows, counts, file)
            hdf5.complete(file, frame, "time", float(time))

    def complete_index(self) -> None:
        """List all frames so far for viewers."""
        with together(self.comm, self._index.path):
            if self.comm.rank == 0:
                self._index.complete()

    def close(self) -> None:
        """As :meth:`complete_index`, as far as it goes; not collective, a rank may be lost."""
        if self.comm.rank == 0:
            with suppress(OSError):
                hdf5.give_back(self.path)
            self._index.complete_if_possible()

    def sync(self) -> None:
        """List all frames so far and flush them to the disk."""
        self.complete_index()
        with together(self.comm, self.path):
            hdf5.sync(self.path)
            if self.comm.rank == 0:
                hdf5.sync(self._index.path)

    def structure(self) -> bytes:
        """All of the file but the numbers, on rank 0: with it they can be found again."""
        with together(self.comm, self.path):
            return copied(self.path, self._places) if self.comm.rank == 0 else b""

    def _rows(self, frame: str, arrays: dict, first: int, total: int) -> dict[str, np.ndarray]:
        """What this rank writes, by the name in the file; the same names on every rank."""
        count, dimensions = arrays["position"].shape
        rows = {f"{frame}/{name}": part for name, part in arrays.items()}
        short = [name for name, part in arrays.items() if len(part) != count]
        if short:
            raise ValueError(f"{self.path}: {', '.join(short)}: not {count} rows as position")
        if dimensions == 1:
            rows[f"{frame}/points"] = np.pad(arrays["position"], ((0, 0), (0, 2)))
        if total not in self._connected:
            rows[f"connectivity/{total}"] = np.arange(first, first + count)
            self._connected.add(total)
        return rows

    def _create(self, attributes: dict) -> None:
        self._index.remove()
        # A new file takes the place of an old one, which may be open in a viewer: leave it that.
        fresh = self.path.with_name(self.path.name + ".new")
        fresh.touch()
        hdf5.reserve(fresh, hdf5.MARGIN + len(str(attributes)))
        with hdf5.open_file(fresh, "w") as file:
            file.attrs.update(attributes)
            file.create_group("frames")
        os.replace(fresh, self.path)

    def _reopen(self, attributes: dict, kept: bytes) -> None:
        """Remove what was written after ``kept``, and list the frames until then."""
        put_back(self.path, kept)
        hdf5.reserve(self.path, hdf5.MARGIN + len(str(attributes)))
        with hdf5.open_file(self.path, "r+") as file:
            file.attrs.update(attributes)
            listed = [self._found(file, f"frames/{name}") for name in sorted(file["frames"], key=int)]
            orders = file.get("connectivity", {})
            self._connected = {int(name) for name in orders}
            self._places = [hdf5.place_of(dataset) for dataset in orders.values()]
            for frame, _, _ in listed:
                self._places += [hdf5.place_of(dataset) for dataset in file[frame].values()]
        self._index.restore(listed)

    def _lay_out(self, file, frame: str, step: int, shapes: dict, rows: dict) -> None:
        hdf5.reserve(self.path, hdf5.MARGIN + hdf5.size_of(shapes, rows))
        self._places += hdf5.create_datasets(file, shapes, rows, self._texts)
        hdf5.describe(file, frame, {"time": math.nan, "step": step} | self._lines)  # no time yet: not whole

    def _found(self, file, frame: str) -> tuple[str, float, dict]:
        """A frame's name, time, and the shape and type of its datasets in the order of the fields."""
        if frame not in file or not math.isfinite(file[frame].attrs.get("time", math.nan)):
            raise OSError(f"{frame} is missing, or incomplete")
        datasets = {f"{frame}/{name}": file[frame][name] for name in self._fields if name in file[frame]}
        kinds = {name: (dataset.shape, dataset.dtype) for name, dataset in datasets.items()}
        return frame, float(file[frame].attrs["time"]), kinds

    def _texts(self, name: str) -> dict[str, str]:
        """What the dataset ``name`` says of itself."""
        kind, name = name.split("/")[0], name.split("/")[-1]
        field = self._fields[CONNECTIVITY.name if kind == CONNECTIVITY.name else name]
        return {"unit": field.unit, "meaning": field.meaning}
