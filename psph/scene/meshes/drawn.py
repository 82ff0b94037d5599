"""The shapes of a case that geometry files draw."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from psph.case import Case, CaseError
from psph.case.mesh import Mesh
from psph.case.shapes import Shape
from psph.scene.lattice import TOLERANCE, Lattice, lattice_around
from psph.scene.shapes import bounds, inside

if TYPE_CHECKING:  # late: takes a while, and most scenes have no mesh
    from psph.scene.meshes.surface import Surface


class Drawn(NamedTuple):
    """A shape that a geometry file draws: its keys in the case, most often one, and its surface."""

    keys: tuple[str, ...]
    shape: Shape
    surface: "Surface"

    @property
    def mesh(self) -> Mesh:
        """What the case says of it."""
        return self.shape.form

    @property
    def key(self) -> str:
        """The first place where it stands."""
        return self.keys[0]

    @property
    def size(self) -> str:
        """Its extent in words."""
        return " x ".join(f"{length:.4g}" for length in self.surface.size) + " m"


def drawn(case: Case) -> tuple[Drawn, ...]:
    """The meshes of a case, read.  Raises CaseError with a line for each that no shape can be made of."""
    if not case.meshes:
        return ()
    from psph.scene.meshes.surface import MeshError, surface_of

    keys: dict[Mesh, list[str]] = {}
    for key, mesh in case.meshes.items():
        keys.setdefault(mesh, []).append(key)
    found, faults = [], []
    for mesh, where in keys.items():
        try:
            found.append(Drawn(tuple(where), Shape(mesh=mesh), surface_of(mesh)))
        except MeshError as trouble:
            faults.append(f"{case.file}: {where[0]}.file: {mesh.found.path} {trouble}")
    if faults:
        raise CaseError(faults)
    return tuple(found)


def sites_in(lattice: Lattice, one: Drawn) -> int:
    """Sites of a lattice in the shape that a mesh draws."""
    (low, high), total = bounds(one.shape), 0
    box = tuple(map(max, low, lattice.lower)), tuple(map(min, high, lattice.upper))
    part = lattice_around([box], lattice.origin, lattice.spacing, None)
    for first, last in part.chunks():
        held = inside(one.shape, part.grid(first, last), TOLERANCE * lattice.spacing)
        total += int(np.count_nonzero(held))
    return total
