"""How far points are from the faces that a case draws, and which way out."""

from collections.abc import Sequence

import numpy as np

from psph.case.shapes import Shape
from psph.scene.forms.form import Faces, Room, chosen
from psph.scene.forms.make import form_of


def faces_of(shape: Shape, points: np.ndarray, room: Room | None = None) -> Faces:
    """φ and ∇φ of ``shape`` at ``points`` (n, dim), m; exact before and behind a plane face.

    Faces at the border of ``room`` or beyond it are none.
    """
    return form_of(shape).faces(points, room)


def nearest_faces(shapes: Sequence[Shape], points: np.ndarray) -> Faces:
    """Those of the nearest of some ``shapes`` at ``points`` (n, dim), m, outside of all."""
    return chosen([faces_of(one, points) for one in shapes], np.argmin)


def corners_of(shape: Shape, apart: float) -> np.ndarray:
    """The corners (n, dim) that a shape draws, m; those inside its own parts among them.  In 3D also points
    on its straight edges, no more than ``apart`` m from each other."""
    return form_of(shape).corners(apart)
