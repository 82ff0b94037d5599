"""The small XML file through which viewers such as ParaView open the frames of a run.

XDMF 3, https://www.xdmf.org: a temporal collection of point clouds.  Two things that viewers
need: an explicit connectivity (without it ParaView shows nothing), and shapes that agree with the
HDF5 file.  2D positions stand as they are stored (XY); 1D ones have a dataset ``points`` beside.

The file is replaced whole, in one step.  To write a frame over its last lines would cost less, but
a reader that comes in between gets half a file, and half an XML file opens nowhere.
"""

import os
from collections.abc import Iterator
from contextlib import suppress
from html import escape  # xml.sax.saxutils, which does the same, loads what browses the web
from pathlib import Path
from time import monotonic
from typing import NamedTuple

import numpy as np

HEAD = """<?xml version="1.0"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="{name}" GridType="Collection" CollectionType="Temporal">
"""
TAIL = """    </Grid>
  </Domain>
</Xdmf>
"""
_GRID = """      <Grid Name="{name}" GridType="Uniform">
        <Time Value="{time}"/>
        <Topology TopologyType="Polyvertex" NumberOfElements="{count}" NodesPerElement="1">
          {connectivity}
        </Topology>
        <Geometry GeometryType="{geometry}">
          {points}
        </Geometry>
{attributes}      </Grid>
"""
_ATTRIBUTE = """        <Attribute Name="{name}" AttributeType="{kind}" Center="Node">
          {item}
        </Attribute>
"""
_ITEM = (
    '<DataItem Dimensions="{shape}" NumberType="{number}" Precision="{bytes}" Format="HDF">'
    "{file}:/{name}</DataItem>"
)

NAME, TIME = "<frame>", "<time>"
"""What stands in a template: no name in the file has these signs, which XML escapes."""

PARTICLES = "particles"

PAUSE = 1.0
"""Seconds from one writing of the index to the next while frames come."""

ENDING, EARLIER = ".xdmf", ".xmf"
"""Of the file's name.  PyVista knows the first alone; runs of earlier versions have the second."""

Kind = tuple[tuple[int, ...], np.dtype]
"""Shape and type of a dataset."""


def index_of(frames: Path) -> Path | None:
    """The file that lists the ``frames`` of a run for viewers, by this or an earlier version, if any."""
    paths = (frames.with_suffix(ending) for ending in (ENDING, EARLIER))
    return next((path for path in paths if path.exists()), None)


def item(file: Path, name: str, kind: Kind) -> str:
    """The element that stands for the dataset ``name`` of an HDF5 file beside the index."""
    shape, dtype = kind
    return _ITEM.format(
        shape=" ".join(map(str, shape)),
        number="UChar" if dtype == np.uint8 else {"f": "Float", "i": "Int"}[dtype.kind],
        bytes=dtype.itemsize,
        file=escape(file.name, quote=False),
        name=name,
    )


class _Frame(NamedTuple):
    name: str
    time: float
    lines: str  # one template for all frames that are alike: a run may have very many


class XdmfIndex:
    """The ``.xdmf`` beside the HDF5 file ``frames``; it lists the frames that are whole.

    It is rewritten where the frames have grown by its own size since it was last, so all its writings
    together are no more than the frames, however many; and once a ``PAUSE``, since a file system that keeps
    its order takes some milliseconds for it.  In between it is behind, until :meth:`complete`.
    """

    def __init__(self, frames: Path):
        self.path = frames.with_suffix(ENDING)
        self._frames = frames
        self._forget()

    def add(self, frame: str, time: float, kinds: dict[str, Kind]) -> None:
        """List a frame; ``kinds`` holds its datasets by their name in the HDF5 file."""
        self._list(frame, time, kinds)
        if monotonic() >= self._next and self._frames.stat().st_size - self._seen >= self._size:
            self._write()

    def remove(self) -> None:
        """Take the file away, also one of an earlier version."""
        for ending in (ENDING, EARLIER):
            self._frames.with_suffix(ending).unlink(missing_ok=True)

    def restore(self, frames: list[tuple[str, float, dict[str, Kind]]]) -> None:
        """List these frames and no others: (frame, time, kinds) as in :meth:`add`."""
        self._forget()
        for frame, time, kinds in frames:
            self._list(frame, time, kinds)
        self._write()
        self._frames.with_suffix(EARLIER).unlink(missing_ok=True)  # it would list frames of no more

    def complete(self) -> None:
        """Add the frames to the file that it does not list yet."""
        if self._behind:
            self._write()

    def complete_if_possible(self) -> None:
        """The same at the end of a run in trouble, of which a second one would tell nothing new."""
        with suppress(OSError):
            self.complete()

    def _forget(self) -> None:
        self._listed: list[_Frame] = []
        self._templates: dict[tuple, str] = {}
        self._behind = False
        self._size = len(HEAD.format(name=PARTICLES)) + len(TAIL)
        self._seen = 0  # bytes of the frames when the index was last written
        self._next = 0.0  # when it may be written again, by the clock

    def _list(self, frame: str, time: float, kinds: dict[str, Kind]) -> None:
        fields = tuple(
            (name.removeprefix(f"{frame}/"), kind)
            for name, kind in kinds.items()
            if name.startswith(f"{frame}/")
        )
        if fields not in self._templates:
            self._templates[fields] = self._template(frame.rpartition("/")[0], dict(fields))
        self._listed.append(_Frame(frame.rpartition("/")[2], float(time), self._templates[fields]))
        self._size += len(self._grid(*self._listed[-1]).encode())
        self._behind = True

    def _write(self) -> None:
        fresh = self.path.with_name(self.path.name + ".new")
        with open(fresh, "w", encoding="utf-8") as file:
            file.writelines(self._lines())
        os.replace(fresh, self.path)
        self._seen, self._behind = self._frames.stat().st_size, False
        self._next = monotonic() + PAUSE

    def _lines(self) -> Iterator[str]:
        yield HEAD.format(name=PARTICLES)
        for frame in self._listed:
            yield self._grid(*frame)
        yield TAIL

    def _grid(self, name: str, time: float, lines: str) -> str:
        return lines.replace(NAME, name).replace(TIME, repr(time))

    def _template(self, folder: str, fields: dict[str, Kind]) -> str:
        """The lines of a frame of these fields, with NAME and TIME in the place of its own."""
        (count, dimensions), _ = fields["position"]
        points = "points" if dimensions == 1 else "position"
        shown = {name: kind for name, kind in fields.items() if name not in ("position", "points")}
        frame = f"{folder}/{NAME}"
        return _GRID.format(
            name=NAME,
            time=TIME,
            count=count,
            connectivity=self._item(f"connectivity/{count}", ((count,), np.dtype("int64"))),
            geometry="XY" if dimensions == 2 else "XYZ",
            points=self._item(f"{frame}/{points}", fields[points]),
            attributes="".join(
                _ATTRIBUTE.format(
                    name=name,
                    kind="Vector" if kind[0][1:] > (1,) else "Scalar",
                    item=self._item(f"{frame}/{name}", kind),
                )
                for name, kind in shown.items()
            ),
        )

    def _item(self, name: str, kind: Kind) -> str:
        return item(self._frames, name, kind)
