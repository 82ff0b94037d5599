"""Mass and inertia of rigid bodies from the sites that they hold."""

from typing import NamedTuple

import numpy as np

from psph.case.bodies import SLIDES, TURNS
from psph.case.motion import motion_of
from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.pose import in_space
from psph.scene.lattice import lattice_around
from psph.scene.layout import Layout
from psph.scene.levels import Levels
from psph.scene.mirrors import clipped
from psph.scene.parts import Part
from psph.scene.shapes import bounds, inside

FINER = 7
"""By how much finer the lattice is that tells the volume of a shape."""


class Volume(NamedTuple):
    """``volume`` in m^d, ``centre`` (3,) m and ``spread`` (3, 3) m², the mean of (x − c)(x − c)ᵀ, of
    what is full."""

    volume: float
    centre: np.ndarray
    spread: np.ndarray

    def inertia(self, mass: float) -> np.ndarray:
        """Moments about the centre, kg m² (3, 3), of a ``mass`` in kg that fills it evenly."""
        return mass * (np.trace(self.spread) * np.eye(3) - self.spread)

    def surface(self, dimensions: int) -> float:
        """The surface, m^(d − 1), of a box of this spread, or of a cube of this volume if that has more."""
        d = dimensions
        sides = np.sqrt(12.0 * np.linalg.eigvalsh(self.spread[:d, :d]))
        box = 2.0 * sum(float(np.delete(sides, axis).prod()) for axis in range(d))
        return max(box, 2.0 * d * self.volume ** ((d - 1.0) / d))


def volume_of(layout: Layout, material: int) -> Volume:
    """What the sites of a material fill, a cell of the lattice each; of a finer one in a finer region."""
    d, levels, count = layout.dimensions, Levels(layout), 0
    middle = np.array(layout.lattice.lower)  # sums are taken about a point near by
    first, second = np.zeros(d), np.zeros((d, d))
    level = levels.around(material)
    dx = levels.spacing(level)
    for found in levels.filled(level, material):
        x = found - middle
        count, first, second = count + len(x), first + x.sum(axis=0), second + x.T @ x
    if not count:
        return Volume(0.0, np.full(3, np.nan), np.full((3, 3), np.nan))
    mean = first / count
    spread = np.zeros((3, 3))
    spread[:d, :d] = second / count - np.outer(mean, mean) + dx * dx / 12.0 * np.eye(d)
    return Volume(count * dx**d, np.array(in_space(tuple(mean + middle))), spread)


def drawn_volume(layout: Layout, shape) -> float:
    """The volume of a shape itself, m^d, this side of mirrors: that of the cells of a finer lattice in it."""
    fine = layout.spacing / FINER
    lattice = lattice_around([clipped(bounds(shape), layout.mirror_planes)], layout.lattice.lower, fine, None)
    count = sum(
        np.count_nonzero(np.broadcast_to(inside(shape, lattice.grid(*ends), 0.0), lattice.shape(*ends)))
        for ends in lattice.chunks()
    )
    return float(count) * fine**layout.dimensions


def _with_clamps(layout: Layout, name: str, mass: float, centre: np.ndarray, inertia: np.ndarray) -> tuple:
    """Mass, centre and moments about it of a body and of the parts of elastic solids that it carries."""
    for part in layout.parts:
        if getattr(part.motion, "name", None) != name:
            continue
        filled = volume_of(layout, part.number)
        if not filled.volume:
            continue
        more = part.table.density * filled.volume
        both, away = (mass * centre + more * filled.centre) / (mass + more), filled.centre - centre
        lever = mass * more / (mass + more) * (away @ away * np.eye(3) - np.outer(away, away))
        inertia = inertia + filled.inertia(more) + lever
        mass, centre = mass + more, both
    return mass, centre, inertia


def moved_as_whole(layout: Layout, part: Part) -> RigidBody:
    """How a part moves that keeps its form under forces."""
    table, filled, dimensions = part.table, volume_of(layout, part.number), layout.dimensions
    mass = table.mass or table.density * filled.volume
    inertia = filled.inertia(mass)
    if table.inertia is not None and dimensions == 2:
        inertia[2, 2] = table.inertia
    elif table.inertia is not None:
        inertia = np.array(table.inertia)
    centre = np.array(in_space(table.centre)) if table.centre else filled.centre
    mass, centre, inertia = _with_clamps(layout, part.name, mass, centre, inertia)
    spin = (0.0, 0.0, table.spin or 0.0) if dimensions == 2 else tuple(table.spin or (0.0,) * 3)
    freed = table.freed(dimensions)
    return RigidBody(
        part.name,
        mass,
        tuple(centre.tolist()),
        tuple(inertia.ravel().tolist()),
        in_space(table.velocity),
        spin,
        tuple(one in freed for one in SLIDES),
        tuple(one in freed for one in TURNS),
        in_space(table.pivot) if table.pivot else None,
        table.held,
        motion_of(table.motion, layout.gravity),
    )
