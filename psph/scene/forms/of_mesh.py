"""What a surface of triangles encloses."""

from collections.abc import Sequence

import numpy as np

from psph.case.mesh import Mesh
from psph.scene.forms.form import Faces, Form, Grid, Room, Triangles, between
from psph.scene.forms.shell import hollow
from psph.scene.meshes.surface import FileSurface, Surface, box_around, holds, surface_of
from psph.scene.meshes.topology import Welded


class OfMesh(Form):
    """The shape that a geometry file draws."""

    dimensions = 3

    def __init__(self, mesh: Mesh):
        self.mesh = mesh

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return holds(self.mesh, grid, slack, by / slack if slack else None)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says; as exact as the file is."""
        if np.count_nonzero(way) == 1:
            lower, upper = box_around(self.mesh)
            return float(sum(w * (up if w > 0.0 else low) for w, low, up in zip(way, lower, upper) if w))
        surface = surface_of(self.mesh)
        beyond = box_around(self.mesh)[1][0] - surface.upper[0]
        return float((surface.sheet.corners.reshape(-1, 3) @ way).max()) + beyond

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        found = Faces(*surface_of(self.mesh).faces(points))
        return hollow(found, self.mesh.shell, self.mesh.side != "outside") if self.mesh.shell else found

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return sharp(surface_of(self.mesh), apart)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says, in the triangles of the file."""
        return surface_of(self.mesh).sheet.corners


class OfSurface(Form):
    """A closed body: its corners (n, 3), m, and triangles (m, 3) turned outwards; for its faces alone."""

    dimensions = 3

    def __init__(self, vertices: np.ndarray, faces: np.ndarray):
        whole = Welded(vertices, faces, 0.0)
        self.whole = Surface(FileSurface(whole, whole, 0, 0, 0, False), 1.0, (), (0.0, 0.0, 0.0))

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        return Faces(*self.whole.faces(points))

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return sharp(self.whole, apart)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        return self.whole.sheet.corners


def sharp(surface: Surface, apart: float) -> np.ndarray:
    """Sharp corners (n, 3) of a surface, m, and points on its sharp edges, ``apart`` m at most."""
    ends, sides = surface.sharp
    return np.concatenate([ends, *(between(*side, apart) for side in sides)])
