"""Triangles of a geometry file, in its own unit."""

import io
import logging
import warnings
from pathlib import Path

import numpy as np

from psph.errors import LONGEST_QUOTE, shortened

LARGEST = 1e30
"""Of a coordinate: what is computed from it, fourth powers among it, then stays a number."""

HEADER, RECORD = 84, 50
"""Bytes of a binary STL before its triangles, the last four of which count them, and of each triangle."""

CUT_SHORT = ".*could not be read to its end.*"
"""How numpy warns of a text in which something else than a number stands, and then takes what came before."""


class MeshError(ValueError):
    """A geometry file that no shape can be made of; the message says why and what to do."""


def read(path: Path) -> np.ndarray:
    """Corners (n, 3, 3) of the triangles of an STL, OBJ or PLY file, in its unit, turned as there.

    In an order that does not depend on that of the file.  Raises MeshError.
    """
    corners = _parsed(path)
    if not len(corners):
        raise MeshError("holds no triangle; export the surface of a body as triangles")
    if not np.isfinite(corners).all():
        raise MeshError("holds coordinates that are no numbers; export it again")
    if np.abs(corners).max() > LARGEST:
        raise MeshError(f"holds coordinates beyond {LARGEST:g}; export it again")
    return _ordered(corners)


def _content(path: Path) -> bytes:
    """All of a file.  MeshError: it cannot be read, or is a binary STL with another length than it says."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MeshError(f"{error.strerror or error}; give a file that can be read") from None
    is_binary = path.suffix.lower() == ".stl" and b"\0" in content and len(content) >= HEADER
    if is_binary and len(content) != HEADER + RECORD * (count := int.from_bytes(content[80:84], "little")):
        room = (len(content) - HEADER) / RECORD
        raise MeshError(
            f"is damaged: its header counts {count:,} triangle{'s' * (count != 1)}, and it has room for "
            f"{room:,.6g}; export it again"
        )
    return content


def _parsed(path: Path) -> np.ndarray:
    import trimesh  # takes half a second, for scenes with a mesh alone

    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # of what is wrong, psph speaks itself
    content = io.BytesIO(_content(path))
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", CUT_SHORT)
            mesh = trimesh.load(content, path.suffix[1:].lower(), process=False, skip_materials=True)
            if isinstance(mesh, trimesh.Scene):
                mesh = mesh.to_mesh()
            if not isinstance(mesh, trimesh.Trimesh):  # points or lines alone
                return np.empty((0, 3, 3))
            return np.array(mesh.vertices[mesh.faces], dtype=np.float64).reshape(-1, 3, 3)
    except Exception as error:  # whatever a damaged file does to its reader
        why = shortened(f"{type(error).__name__}: {error}", LONGEST_QUOTE)
        raise MeshError(f"cannot be read as {path.suffix[1:].upper()} ({why}); export it again") from None


def _ordered(corners: np.ndarray) -> np.ndarray:
    """Each triangle begun at its lowest corner, turned as before; triangles sorted by their corners."""
    first = np.lexsort(np.moveaxis(corners, 2, 0)[::-1], axis=1)[:, :1]
    turned = (first + np.arange(3)) % 3
    corners = np.take_along_axis(corners, turned[:, :, None], axis=1)
    return corners[np.lexsort(corners.reshape(-1, 9).T[::-1])]
