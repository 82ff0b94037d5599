"""Triangles that share corners: welding, turning to one side, closing of holes."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

ROUNDING = 2.0**-21
"""Of the largest coordinate: corners nearer to each other are one.  Single precision, in which an STL file
holds them, has 2⁻²⁴."""


class Welded(NamedTuple):
    """A surface of triangles with shared corners.

    ``vertices`` (v, 3); ``faces`` (n, 3) int64, numbers of corners; ``rounding``: how far welding may have
    moved a corner.  Lengths in the unit of the vertices.
    """

    vertices: np.ndarray
    faces: np.ndarray
    rounding: float

    @property
    def corners(self) -> np.ndarray:
        """(n, 3, 3)."""
        return self.vertices[self.faces]


class Edges(NamedTuple):
    """Edges of a surface.

    ``ends`` (e, 2): numbers of corners, the lower first; ``of`` (n, 3): the edge of each side of each face,
    from its corner k to k + 1; ``ahead`` (n, 3): whether that side runs from the lower number to the higher.
    """

    ends: np.ndarray
    of: np.ndarray
    ahead: np.ndarray

    @property
    def faces(self) -> np.ndarray:
        """(e,): how many faces meet there."""
        return np.bincount(self.of.ravel(), minlength=len(self.ends))

    @property
    def unbalanced(self) -> np.ndarray:
        """(e,): how many more faces run along it ahead than back: 0 where a surface is closed and turned to
        one side."""
        signs = np.where(self.ahead, 1, -1).ravel()
        return np.bincount(self.of.ravel(), signs, minlength=len(self.ends)).astype(np.int64)


def weld(corners: np.ndarray) -> Welded:
    """One vertex for corners (n, 3, 3) that differ by rounding; faces left without three are dropped."""
    points = corners.reshape(-1, 3)
    rounding = ROUNDING * float(np.abs(points).max())
    cells = np.rint(points / (rounding or 1.0)).astype(np.int64)
    _, first, cell = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    found = points[first]
    pairs = cKDTree(found).query_pairs(rounding, output_type="ndarray")  # few: one point in a cell
    near = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(found),) * 2)
    number, group = connected_components(near, directed=False)
    one = np.full(number, len(found))
    np.minimum.at(one, group, np.arange(len(found)))
    faces = group[cell.ravel()].reshape(-1, 3)
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Welded(found[one], faces[whole], rounding)


def edges_of(faces: np.ndarray) -> Edges:
    """The edges of faces (n, 3)."""
    begin, end = faces, np.roll(faces, -1, axis=1)
    many = int(faces.max(initial=0)) + 1
    both, number = np.unique(np.minimum(begin, end) * many + np.maximum(begin, end), return_inverse=True)
    return Edges(np.column_stack(np.divmod(both, many)), number.reshape(-1, 3), begin < end)


def areas(corners: np.ndarray) -> np.ndarray:
    """Vectors (n, 3) along the normals of triangles (n, 3, 3), as long as their areas."""
    return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def volume(corners: np.ndarray) -> float:
    """What closed triangles (n, 3, 3) enclose, above 0 where they are turned outwards: Σ a·(b × c)/6."""
    a, b, c = np.moveaxis(corners - corners.reshape(-1, 3).mean(axis=0), 1, 0)
    return float(np.einsum("ni,ni->", a, np.cross(b, c))) / 6.0


def turned(surface: Welded) -> np.ndarray:
    """True (n,) for faces that lie the other way than most of what they are joined to.

    Two faces at an edge lie alike where one runs along it ahead and the other back.  In a graph with each
    face as it is and each face turned, joined where they lie alike, a surface with two sides falls into two
    parts: that with more of the area as it is stays.
    """
    n, edges = len(surface.faces), edges_of(surface.faces)
    side = np.argsort(edges.of.ravel(), kind="stable")
    side = side[np.repeat(edges.faces == 2, edges.faces)].reshape(-1, 2)
    one, other = (side // 3).T
    crossed = np.equal(*edges.ahead.ravel()[side].T) * n
    rows, columns = np.concatenate([one, one + n]), np.concatenate([other + crossed, other + (n - crossed)])
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(2 * n, 2 * n))
    number, part = connected_components(graph, directed=False)
    as_is, about = part[:n], part[n:]
    area = np.linalg.norm(areas(surface.corners), axis=1)
    held = np.bincount(as_is, area, minlength=number)
    return (held[as_is] < held[about]) | (held[as_is] == held[about]) & (as_is > about)


def holes(surface: Welded) -> list[list[int]]:
    """Rings of vertices around the holes of a surface, each in the direction of faces that would close it."""
    edges = edges_of(surface.faces)
    number = edges.unbalanced
    open_ = np.flatnonzero(number)
    onward: dict[int, list[int]] = {}
    for (low, high), count in zip(edges.ends[open_].tolist(), number[open_].tolist()):
        begin, end = (high, low) if count > 0 else (low, high)  # against the faces that are there
        onward.setdefault(begin, []).extend([end] * abs(count))
    rings = []
    for start in sorted(onward):
        while onward[start]:
            rings += _rings_from(start, onward)
    return rings


def _rings_from(start: int, onward: dict[int, list[int]]) -> list[list[int]]:
    """A walk along open edges until it is back; whenever it crosses itself a ring is cut off."""
    walk, place, rings = [start], {start: 0}, []
    while onward[walk[-1]]:
        step = onward[walk[-1]].pop()
        if step in place:
            ring = walk[place[step] :]
            for vertex in ring[1:]:
                del place[vertex]
            del walk[place[step] + 1 :]
            rings.append(ring)
        else:
            place[step] = len(walk)
            walk.append(step)
    return rings


def closed(surface: Welded, rings: list[list[int]]) -> Welded:
    """The surface with every ring filled by triangles to the middle of its corners."""
    vertices, faces = [surface.vertices], [surface.faces]
    count = len(surface.vertices)
    for ring in rings:
        if len(ring) == 3:
            faces.append(np.array([ring]))
        elif len(ring) > 3:  # two ends of a crack lie on each other
            vertices.append(surface.vertices[ring].mean(axis=0, keepdims=True))
            faces.append(np.column_stack([ring, np.roll(ring, -1), np.full(len(ring), count)]))
            count += 1
    return Welded(np.concatenate(vertices), np.concatenate(faces), surface.rounding)
