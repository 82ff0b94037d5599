"""The small XML file through which viewers such as ParaView open the frames of a run.

XDMF 3, https://www.xdmf.org: a temporal collection of point clouds.  Two things that viewers
need: an explicit connectivity (without it ParaView shows nothing), and shapes that agree with the
HDF5 file.  2D positions stand as they are stored (XY); 1D ones have a dataset ``points`` beside.
"""

import os
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np

_HEAD = """<?xml version="1.0"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="particles" GridType="Collection" CollectionType="Temporal">
"""
_TAIL = """    </Grid>
  </Domain>
</Xdmf>
"""
_GRID = """      <Grid Name="{name}" GridType="Uniform">
        <Time Value="{time!r}"/>
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

Kind = tuple[tuple[int, ...], np.dtype]
"""Shape and type of a dataset."""


class XdmfIndex:
    """The ``.xmf`` beside the HDF5 file ``frames``; it lists the frames that are whole."""

    def __init__(self, frames: Path):
        self.path = frames.with_suffix(".xmf")
        self._file = frames.name
        self._grids: list[str] = []

    def add(self, frame: str, time: float, kinds: dict[str, Kind]) -> None:
        """List a frame; ``kinds`` holds its datasets by their name in the HDF5 file.

        The whole file is replaced in one step, since half an XML file opens nowhere.
        """
        fields = {
            name.removeprefix(f"{frame}/"): kind
            for name, kind in kinds.items()
            if name.startswith(f"{frame}/")
        }
        self._grids.append(self._grid(frame, float(time), fields))
        self._write()

    def restore(self, frames: list[tuple[str, float, dict[str, Kind]]]) -> None:
        """List these frames and no others: (frame, time, kinds) as in :meth:`add`."""
        self._grids = []
        for frame, time, kinds in frames:
            fields = {name.removeprefix(f"{frame}/"): kind for name, kind in kinds.items()}
            self._grids.append(self._grid(frame, time, fields))
        self._write()

    def _write(self) -> None:
        fresh = self.path.with_name(self.path.name + ".new")
        fresh.write_text(_HEAD + "".join(self._grids) + _TAIL, encoding="utf-8")
        os.replace(fresh, self.path)

    def _grid(self, frame: str, time: float, fields: dict[str, Kind]) -> str:
        (count, dimensions), _ = fields["position"]
        points = "points" if dimensions == 1 else "position"
        shown = {name: kind for name, kind in fields.items() if name not in ("position", "points")}
        return _GRID.format(
            name=frame.rpartition("/")[2],
            time=time,
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
        shape, dtype = kind
        return _ITEM.format(
            shape=" ".join(map(str, shape)),
            number="UChar" if dtype == np.uint8 else {"f": "Float", "i": "Int"}[dtype.kind],
            bytes=dtype.itemsize,
            file=escape(self._file),
            name=name,
        )
