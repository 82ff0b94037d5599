"""How much of what presses on walls and bodies each of their levels of sizes tells.

Where walls and bodies are there on several levels, all fluid of a level pushes on its own, and of the push of
a pair the level's share counts at the face nearest to the fluid, half the way along that to the wall.  Shares
of all levels add up to one and pass into each other within some spacings about a border.  Were instead each
bit of fluid that leads to push, a border along a face would cut off rows that bear a part of the pressure
each, and those of another spacing bear other parts: a row in front of a face it would press by an eighth too
much.
"""

import numpy as np

from psph.particles.named_rows import find_beside
from psph.particles.neighbours import Neighbours
from psph.physics.motion import deforms, is_rigid
from psph.physics.rigid.pose import PLACE
from psph.scene.faces import FAR, WITHIN, form_in, within_mirrors
from psph.scene.forms.form import Room
from psph.scene.levels import SHARE, SLOPE, Gaps, Levels
from psph.scene.shapes import bounds
from psph.work import Rank

NEAR = 1.5
"""Supports of the coarsest level beside a band where levels share, farther from which no face is in it that a
particle sees or is behind."""


class FaceShares:
    """The shares of the ``levels`` of a rank in what presses on its walls and bodies.

    ``places`` (motions, dim, 1 + dim) are the maps of rigid motions when lists were made.
    """

    def __init__(self, rank: Rank, levels: Levels):
        self._layout, materials = rank.scene.layout, rank.plan.materials
        self._store, self._domain, self._levels = rank.store, rank.domain, levels
        species = materials.species
        self._level_of = np.array([one.level for one in species])
        self._pose_of = [
            materials.pose_of[n] if is_rigid(one.motion) else -1 for n, one in enumerate(species)
        ]
        origins = [part.origin for part in self._layout.parts]
        self._origin_of, self._fluid_of = np.array(origins), np.array([one.is_fluid for one in species])
        self._loaded = materials.loaded
        # Where the faces of a wall that deforms have gone nobody tells.
        self._bare = np.array([deforms(one.motion) for one in species])
        faced = [] if self._loaded is None else self._loaded & ~self._bare
        self._faced = np.unique(self._origin_of[faced])
        self._forms = {
            number: form_in(self._layout, number, self._pose_of[number] < 0)
            for number in map(int, self._faced)
        }
        self._maps: np.ndarray | None = None
        self.places = np.zeros((0, 0, 0))

    def meet(self, maps: np.ndarray | None) -> None:
        """Get the maps of all rigid motions, or None."""
        self._maps = maps

    def turn(self) -> None:
        """To how walls and bodies stand now, when new lists are made."""
        if self._maps is not None:
            self.places = self._maps[:, PLACE].copy()

    def tell(self, lists: Neighbours) -> np.ndarray:
        """Write the shares of the fluid that ``lists`` name beside walls and bodies whose push is asked for;
        who of it, and who of these by the faces that they have, is told of (owned,); collective."""
        store, layout, levels = self._store, self._layout, self._levels
        groups, beside = self._domain.groups(), np.zeros(store.owned, bool)
        find_beside(store.owned, store.low, lists, self._loaded[groups], beside)
        group = groups[store.inner]
        fluid = self._fluid_of[group] & beside
        loaded = self._loaded[group] & (lists.lengths[: store.owned] > 0)
        rows = np.flatnonzero(fluid | loaded)
        where = np.stack([x[store.inner][rows] for x in store["listed_position"]], axis=1)
        level, inside = self._level_of[group[rows]], self._domain.inside(where)
        away = [np.abs(levels.outside(one, inside)) for one in range(1, levels.count)]
        near = np.flatnonzero(np.min(away, axis=0) < NEAR * layout.support + levels.band(1))
        # Of each the nearest face of all parts, and the nearest of another part.
        face, least = np.array([where[near]] * 2), np.full((2, len(near)), np.inf)
        normal = np.zeros(face.shape)
        of, flows = self._origin_of[group[rows[near]]], fluid[rows[near]]
        for number in self._faced:
            asked = np.flatnonzero(flows | (of == number))
            away, points, ways = self._nearest(number, where[near[asked]])
            nearer = away < least[0, asked]
            for array, values in ((least, away), (face, points), (normal, ways)):
                array[1, asked[nearer]] = array[0, asked[nearer]]
                array[0, asked[nearer]] = values[nearer]
            second = ~nearer & (away < least[1, asked])
            for array, values in ((least, away), (face, points), (normal, ways)):
                array[1, asked[second]] = values[second]
        bare = self._beside_bare(lists, groups)[rows[near]]
        face[0, bare], normal[0, bare], least[1, bare] = where[near[bare]], 0.0, np.inf
        where[near] = face[0]
        found, slope = levels.shares(
            level, self._domain.inside(where), self._gaps(where, near, least, face, normal)
        )
        across = sum(slope[near, d] * normal[0, :, d] for d in range(store.dimensions))
        slope[near] -= across[:, None] * normal[0]
        flows = fluid[rows]
        share, along = store[SHARE.name][store.inner], [x[store.inner] for x in store[SLOPE.name]]
        for array, values in zip((share, *along), (found, *slope.T)):
            array[:] = 0.0
            array[rows[flows]] = values[flows]
        self._domain.halo.refresh((SHARE.name, SLOPE.name))  # what ghosts have is of the lists before
        told = np.zeros(store.owned, bool)
        told[rows] = (found > 0.0) | slope.any(axis=1)
        return told

    def _beside_bare(self, lists: Neighbours, groups: np.ndarray) -> np.ndarray:
        """Who is of a wall that deforms, or names one, by the ``groups`` of all columns (owned,): their
        shares are those at their own places."""
        store, bare = self._store, self._bare[groups]
        found = bare[store.inner].copy()
        if self._bare.any():
            find_beside(store.owned, store.low, lists, bare, found)
        return found

    def _gaps(self, where: np.ndarray, near: np.ndarray, least, face, normal) -> Gaps:
        """What is across from the faces at ``where`` (n, dim), m, of those rows that are ``near``: by how far
        both faces are, ``least`` (2, near), where they are, ``face`` (2, near, dim), and their normals."""
        beyond, width, facing = where.copy(), np.full(len(where), np.inf), np.zeros(len(where))
        beyond[near], width[near] = face[1], least.sum(axis=0)
        facing[near] = np.maximum(-sum(a * b for a, b in zip(*normal.transpose(0, 2, 1))), 0.0)
        return Gaps(self._domain.inside(beyond), width, facing)

    def _nearest(self, number: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How far some ``points`` (n, dim), m, are from the nearest face of a part of the layout (n,), where
        that is, and its unit normal (n, dim)."""
        layout, row = self._layout, self._pose_of[number]
        start = points.copy()
        if row >= 0:
            place = self.places[row]
            middle = place[:, 0] + place[:, 1:] @ (0.5 * np.sum(bounds(layout.parts[number].shape), axis=0))
            for d, period in enumerate(layout.periods):
                if period is not None:
                    start[:, d] -= period * np.rint((start[:, d] - middle[d]) / period)
            start = _by(start - place[:, 0], place[:, 1:])
        faces = self._forms[number].faces(start, self._room(row >= 0))
        normal = _by(faces.normal, self.places[row][:, 1:].T) if row >= 0 else faces.normal
        way = np.where(np.isfinite(faces.away), -faces.away, 0.0)
        return np.abs(faces.away), points + way[:, None] * normal, normal

    def _room(self, moves: bool) -> Room:
        """Where a wall has faces, or one that ``moves`` as it was drawn: within mirrors, and if it rests
        within the open ends of the domain."""
        layout, within, room = self._layout, WITHIN * self._layout.spacing, within_mirrors(self._layout)
        for d, period in enumerate(layout.periods):
            if period is None and not moves:
                ends = layout.lower[d] + within, layout.upper[d] - within
                room[:, d] = np.where(np.abs(room[:, d]) < FAR, room[:, d], ends)
        return room[0], room[1]


def _by(vectors: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Sums over e of ``vectors`` (n, e) times ``turn`` (e, dim), in one order on any processor."""
    return sum(vectors[:, e, None] * turn[e] for e in range(len(turn)))
