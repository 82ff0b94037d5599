"""Volume, centre and inertia of the body that a geometry file draws."""

from typing import NamedTuple

import numpy as np

from psph.case.mesh import Mesh
from psph.scene.meshes.surface import surface_of


class MassProperties(NamedTuple):
    """A body of density 1: ``volume`` in m³, ``center`` (3,) in m, ``inertia`` (3, 3) about the centre in m⁵.

    Times a density in kg/m³ they are its mass, and its inertia in kg m².
    """

    volume: float
    center: np.ndarray
    inertia: np.ndarray


def enclosed_by(mesh: Mesh) -> MassProperties:
    """The closed body that a mesh encloses, whether it is filled or a shell (Mirtich 1996, by trimesh).

    Raises MeshError.
    """
    import trimesh  # takes half a second, for scenes with a mesh alone

    whole = surface_of(mesh).whole
    body = trimesh.Trimesh(whole.vertices, whole.faces, process=False)
    found = body.mass_properties
    return MassProperties(float(found.mass), np.array(found.center_mass), np.array(found.inertia))
