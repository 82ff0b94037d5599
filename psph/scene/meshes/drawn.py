"""The shapes of a case that geometry files draw."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from psph.case import Case, CaseError
from psph.case.consistency import walk
from psph.case.errors import dotted
from psph.case.findings import Location
from psph.case.mesh import Mesh
from psph.case.placing import Placing
from psph.case.shapes import Shape
from psph.scene.lattice import TOLERANCE, Lattice, lattice_around
from psph.scene.shapes import bounds, inside

if TYPE_CHECKING:  # late: takes a while, and most scenes have no mesh
    from psph.scene.meshes.surface import Surface


class Drawn(NamedTuple):
    """A shape that a geometry file draws: its keys in the case, most often one, its ``mesh``, the ``shape``
    with all that places it, its surface, and how many times its volume is there."""

    keys: tuple[str, ...]
    mesh: Mesh
    shape: Shape
    surface: "Surface"
    times: float

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

    keys: dict[tuple[Mesh, Shape, float], list[str]] = {}
    for key, one in _placed(case):
        keys.setdefault(one, []).append(key)
    found, faults = [], []
    for (mesh, shape, times), where in keys.items():
        try:
            found.append(Drawn(tuple(where), mesh, shape, surface_of(mesh), times))
        except MeshError as trouble:
            faults.append(f"{case.file}: {where[0]}.file: {mesh.found.path} {trouble}")
    if faults:
        raise CaseError(faults)
    return tuple(found)


def _placed(case: Case) -> Iterator[tuple[str, tuple[Mesh, Shape, float]]]:
    """Each mesh of a case by its key, as the shapes around it place it."""
    around: list[tuple[Location, Shape]] = []
    for loc, value in walk(case):
        around = [(place, shape) for place, shape in around if loc[: len(place)] == place]
        if isinstance(value, Shape):
            around.append((loc, value))
        elif isinstance(value, Mesh):
            whole, times = Shape(mesh=value), 1.0
            for one in (shape for _, shape in reversed(around) if shape.is_placed):
                keys = {name: getattr(one, name) for name in Placing.model_fields}
                whole = Shape(union=(whole,), **keys)
                times *= one.copies * (one.scale or 1.0) ** 3
            yield dotted(loc), (value, whole, times)


def sites_in(lattice: Lattice, one: Drawn) -> int:
    """Sites of a lattice in the shape that a mesh draws."""
    (low, high), total = bounds(one.shape), 0
    box = tuple(map(max, low, lattice.lower)), tuple(map(min, high, lattice.upper))
    part = lattice_around([box], lattice.origin, lattice.spacing, None)
    for first, last in part.chunks():
        held = inside(one.shape, part.grid(first, last), TOLERANCE * lattice.spacing)
        total += int(np.count_nonzero(held))
    return total
