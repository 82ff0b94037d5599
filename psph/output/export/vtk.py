"""Frames as VTK files: a ``.vtp`` each, and a ``.pvd`` that lists them with their times.

XML with the numbers behind it as they are in memory ("appended raw"): Kitware, VTK File Formats,
https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
"""

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from psph.output.export.parts import PARTS, Exported, in_space
from psph.output.progress import with_progress

_TYPES = {"f8": "Float64", "i8": "Int64", "u1": "UInt8"}
_HEAD = (
    '<?xml version="1.0"?>\n<VTKFile type="{type}" version="1.0" '
    f'byte_order="{sys.byteorder.capitalize()}Endian" header_type="UInt64">\n'
)
_UNIT = '<InformationKey name="UNITS_LABEL" location="vtkDataArray">{}</InformationKey>'


def write_vtk(exported: Exported, folder: Path) -> Path:
    """Write the chosen frames into ``folder``; the path of the ``.pvd``.

    Points are the particles, each with a vertex; ``part`` tells PARTS apart; the names of the groups stand in
    the field data, as the time does.  Lines of bodies have files of their own, each a line with a tension,
    where the first frame has some.  Numbers are those of the frames, to the bit.
    """
    kinds = {"": _cloud} | ({"-lines": _lines} if exported.run.lines(0) else {})
    files: dict[str, list[tuple[float, str]]] = {kind: [] for kind in kinds}
    for k in with_progress(exported.chosen, "writing", "frames"):
        for kind, written in kinds.items():
            path = folder / f"{exported.stem}{kind}_{k:05d}.vtp"
            replace(path, written(exported, k))
            files[kind].append((float(exported.times[k]), path.name))
    for kind, listed in files.items():
        replace(folder / f"{exported.stem}{kind}.pvd", collection(listed))
    return folder / f"{exported.stem}.pvd"


def _cloud(exported: Exported, k: int) -> bytes:
    """The file of frame ``k``."""
    frame = exported.run.frame(k)
    position = frame.pop("position")
    count, dimensions = position.shape
    behind = _Behind()
    fields = [behind.array(n, in_space(rows, dimensions), exported.units[n]) for n, rows in frame.items()]
    fields.append(behind.array("part", exported.parts(frame["group"])))
    rows = np.arange(count, dtype=np.int64)
    xml = [
        _HEAD.format(type="PolyData"),
        "<PolyData>\n<FieldData>\n",
        behind.array("TimeValue", exported.times[k : k + 1], "s", whole=True),
        _texts("group_names", exported.names),
        _texts("part_names", PARTS),
        f'</FieldData>\n<Piece NumberOfPoints="{count}" NumberOfVerts="{count}">\n<PointData>\n',
        *fields,
        "</PointData>\n<Points>\n",
        behind.array("position", in_space(position, dimensions), exported.units["position"]),
        "</Points>\n<Verts>\n",
        behind.array("connectivity", rows),
        behind.array("offsets", rows + 1),
        '</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_',
    ]
    return "".join(xml).encode() + b"".join(behind.blocks) + b"\n</AppendedData>\n</VTKFile>\n"


def _lines(exported: Exported, k: int) -> bytes:
    """The file of the lines of frame ``k``."""
    lines, behind = exported.run.lines(k), _Behind()
    points = [in_space(points, points.shape[1]) for points, _ in lines.values()]
    ends = np.cumsum([len(one) for one in points], dtype=np.int64)
    count = int(ends[-1]) if lines else 0
    xml = [
        _HEAD.format(type="PolyData"),
        "<PolyData>\n<FieldData>\n",
        behind.array("TimeValue", exported.times[k : k + 1], "s", whole=True),
        _texts("line_names", tuple(lines)),
        f'</FieldData>\n<Piece NumberOfPoints="{count}" NumberOfLines="{len(lines)}">\n<CellData>\n',
        behind.array("tension", np.array([tension for _, tension in lines.values()], float), "N"),
        "</CellData>\n<Points>\n",
        behind.array("position", np.concatenate([np.empty((0, 3)), *points]), "m"),
        "</Points>\n<Lines>\n",
        behind.array("connectivity", np.arange(count, dtype=np.int64)),
        behind.array("offsets", ends),
        '</Lines>\n</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_',
    ]
    return "".join(xml).encode() + b"".join(behind.blocks) + b"\n</AppendedData>\n</VTKFile>\n"


def image(
    origin, step: float, fields: Mapping[str, np.ndarray], units: Mapping[str, str], time: float
) -> bytes:
    """A file ``.vti`` of ``fields`` at the points of a grid along the axes, ``step`` m apart from ``origin``.

    Each is (nx, ny, nz) or (nx, ny, nz, components), x first; VTK has x fastest.
    """
    counts = next(iter(fields.values())).shape[:3]
    ends = " ".join(f"0 {count - 1}" for count in counts)
    behind = _Behind()
    arrays = []
    for name, values in fields.items():
        rows = np.moveaxis(values, (0, 1, 2), (2, 1, 0)).reshape(-1, *values.shape[3:])
        arrays.append(behind.array(name, rows, units[name]))
    place = " ".join(map(repr, map(float, origin)))
    shape = f'WholeExtent="{ends}" Origin="{place}" Spacing="{step!r} {step!r} {step!r}"'
    xml = [
        _HEAD.format(type="ImageData"),
        f"<ImageData {shape}>\n<FieldData>\n",
        behind.array("TimeValue", np.array([time]), "s", whole=True),
        f'</FieldData>\n<Piece Extent="{ends}">\n<PointData>\n',
        *arrays,
        '</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding="raw">\n_',
    ]
    return "".join(xml).encode() + b"".join(behind.blocks) + b"\n</AppendedData>\n</VTKFile>\n"


def collection(files: Sequence[tuple[float, str]]) -> bytes:
    """A file ``.pvd`` that lists files with their times, s."""
    lines = (f'<DataSet timestep="{time!r}" part="0" file={quoteattr(name)}/>\n' for time, name in files)
    listed = f"<Collection>\n{''.join(lines)}</Collection>\n</VTKFile>\n"
    return (_HEAD.format(type="Collection") + listed).encode()


class _Behind:
    """The numbers that stand behind the XML: each array with its length in bytes before it."""

    def __init__(self):
        self.blocks: list[bytes] = []
        self._size = 0

    def array(self, name: str, rows: np.ndarray, unit: str = "", whole: bool = False) -> str:
        """Take ``rows`` up; the element that refers to them.  ``whole``: it says how many there are."""
        content = np.ascontiguousarray(rows).tobytes()
        components = rows.shape[1] if rows.ndim == 2 else 1
        shape = f'NumberOfComponents="{components}"' + f' NumberOfTuples="{len(rows)}"' * whole
        element = (
            f'<DataArray type="{_TYPES[rows.dtype.str[1:]]}" Name={quoteattr(name)} {shape} '
            f'format="appended" offset="{self._size}">{_UNIT.format(unit) if unit else ""}</DataArray>\n'
        )
        self.blocks += [np.uint64(len(content)).tobytes(), content]
        self._size += 8 + len(content)
        return element


def _texts(name: str, texts: tuple[str, ...]) -> str:
    """Words, as VTK has them: the number of each byte, 0 at the end of a word."""
    codes = " ".join(str(code) for text in texts for code in (*text.encode(), 0))
    return (
        f'<Array type="String" Name="{name}" NumberOfTuples="{len(texts)}" format="ascii">{codes}</Array>\n'
    )


def replace(path: Path, content: bytes) -> None:
    """Write a file in one step."""
    fresh = path.with_name(f"{path.name}.new")
    fresh.write_bytes(content)
    os.replace(fresh, path)
