"""A geometry file at its place in a scene, and which points lie in the shape that it draws."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from psph.case.files import Found
from psph.case.mesh import Mesh, Turn
from psph.scene.forms.form import ASKEW
from psph.scene.meshes.loops import sides, windings
from psph.scene.meshes.reading import LARGEST, MeshError, read
from psph.scene.meshes.topology import Welded, areas, closed, edges_of, holes, turned, volume, weld
from psph.scene.meshes.tree import Tree, tree_of

BEND = np.radians(25.0)
"""The angle between two faces from which on they meet in an edge; less is a round face in pieces."""

ALL_OPEN = 0.8
"""Area of the triangles that close a surface, over its own: above, it encloses nothing."""


@dataclass(frozen=True)
class FileSurface:
    """A surface as a file has it, welded, turned to one side, and closed.

    ``sheet`` is the surface itself, ``whole`` the same with its holes closed; lengths in the unit of the
    file. ``open_edges``: with a face on one side alone, around so many ``holes``; ``turned``: faces that lay
    the other way than those beside them; ``open``: whether it encloses nothing.
    """

    sheet: Welded
    whole: Welded
    open_edges: int
    holes: int
    turned: int
    open: bool


class Surface:
    """The surface of a body in a scene: ``sheet`` and ``whole`` as in :class:`FileSurface`, in m.

    ``volume`` in m³; ``rounding`` (m): how exact the file is; ``lower``, ``upper``: corners of the box around
    it.
    """

    def __init__(self, body: FileSurface, scale: float, turns: Sequence[Turn], move: Sequence[float]):
        self.body = body
        self.sheet, self.whole = (_placed(one, scale, turns, move) for one in (body.sheet, body.whole))
        self.rounding = self.sheet.rounding
        used = self.sheet.corners.reshape(-1, 3)
        if not np.abs(used).max() <= LARGEST:
            raise MeshError(f"reaches beyond {LARGEST:g} m; make scale or move smaller")
        self.lower, self.upper = tuple(used.min(axis=0).tolist()), tuple(used.max(axis=0).tolist())
        self.volume = volume(self.whole.corners)

    @property
    def size(self) -> tuple[float, float, float]:
        """Its extent along each axis, m."""
        return tuple(up - low for low, up in zip(self.lower, self.upper))

    def encloses(self, grid: Sequence[np.ndarray], tolerance: float, way: np.ndarray = ASKEW) -> np.ndarray:
        """True where a point of a grid (psph.scene.forms.form.Grid) lies within the closed surface.

        Points that it winds around any number of times but 0, either way: parts may overlap.  They are moved
        by the tolerance along the ``way`` (3,).
        """
        grid = self._off_the_faces(grid, tolerance, way)
        shape = np.broadcast_shapes(*(x.shape for x in grid))
        if 0 in shape:
            return np.zeros(shape, bool)
        across = [k for k in range(len(shape)) if grid[0].shape[k] > 1 or grid[1].shape[k] > 1]
        order = across + [k for k in range(len(shape)) if k not in across]
        lines, found = tuple(shape[k] for k in across), np.empty([shape[k] for k in order], np.int64)
        x, y, z = (a.transpose(order) for a in grid)
        x, y = (np.broadcast_to(a, lines + (1,) * (x.ndim - len(lines))).ravel() for a in (x, y))
        tree, corners, turns = self._sorted
        flat = found.reshape(len(x), -1)
        z = np.array(np.broadcast_to(z, found.shape)).reshape(flat.shape)
        windings(x, y, z, corners, turns, tree.boxes, flat)
        return (found != 0).transpose(np.argsort(order))

    def shell(
        self,
        grid: Sequence[np.ndarray],
        thickness: float,
        outside: bool,
        tolerance: float,
        way: np.ndarray = ASKEW,
    ) -> np.ndarray:
        """True where a point of a grid is nearer to the surface than ``thickness``, m, on one side of it.

        Where a surface ends, at a rim, its shell ends: nothing lies beyond.
        """
        points = self._off_the_faces(grid, tolerance, way)
        shape = np.broadcast_shapes(*(x.shape for x in points))
        flat = np.stack([np.broadcast_to(x, shape).ravel() for x in points], axis=1)
        tree, corners, normals = self._lined
        found, _, _ = _sides(flat, thickness, tree, corners, normals)
        return ((found > 0.0) if outside else (found < 0.0)).reshape(shape)

    def faces(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Signed distances (n,) m of ``points`` (n, 3) from the closed surface, below zero inside, and the
        directions (n, 3) in which they grow."""
        tree, corners, normals = self._closed
        side, away, (triangle, part) = _sides(points, np.inf, tree, corners, normals)
        sign, length = np.where(side < 0.0, -1.0, 1.0), np.sqrt((away**2).sum(axis=1))
        flat = (part == 0) | (length == 0.0)
        out = sign[:, None] * away / np.where(flat, 1.0, length)[:, None]
        return sign * length, np.where(flat[:, None], normals[triangle, 0], out)

    @cached_property
    def sharp(self) -> tuple[np.ndarray, np.ndarray]:
        """The corners (n, 3), m, and the ends of the edges (m, 2, 3), m, of the closed surface where its
        faces bend by more than :data:`BEND`."""
        whole, sides = self.whole, np.array([[0, 1], [1, 2], [2, 0]])
        normals = _normals(whole)
        length = np.sqrt((normals**2).sum(axis=2))
        bends = (normals * normals[:, :1]).sum(axis=2) < np.cos(0.5 * BEND) * length * length[:, :1]
        corners = np.unique(whole.faces[bends[:, 1:4]])
        ends = np.unique(np.sort(whole.faces[:, sides][bends[:, 4:]], axis=1), axis=0)
        return whole.vertices[corners], whole.vertices[ends]

    def _off_the_faces(
        self, grid: Sequence[np.ndarray], tolerance: float, way: np.ndarray
    ) -> list[np.ndarray]:
        """The coordinates moved by a trifle, so that the low side of a face is inside and no point on it.

        Arrays with as many axes each as the points have.
        """
        axes = max(1, *(np.ndim(x) for x in grid))
        by = max(tolerance, self.rounding) * way
        return [np.array(x + d, ndmin=axes) for x, d in zip(grid, by)]

    @cached_property
    def _sorted(self) -> tuple[Tree, np.ndarray, np.ndarray]:
        """The tree of the closed surface, its triangles with sorted corners, and which way they turn."""
        corners = self.whole.corners
        order = np.lexsort(np.moveaxis(corners, 2, 0)[::-1], axis=1)
        even = (np.diff(np.concatenate([order, order[:, :1]], axis=1), axis=1) % 3 == 1).all(axis=1)
        corners = np.take_along_axis(corners, order[:, :, None], axis=1)
        tree = tree_of(corners, axes=2)  # for lines along z
        return tree, corners[tree.order], np.where(even, 1, -1)[tree.order]

    @cached_property
    def _lined(self) -> tuple[Tree, np.ndarray, np.ndarray]:
        """The tree of the surface as it is, its triangles, and the normals of their parts."""
        return _lined(self.sheet)

    @cached_property
    def _closed(self) -> tuple[Tree, np.ndarray, np.ndarray]:
        """The same of the closed surface."""
        return _lined(self.whole)


def surface_of(mesh: Mesh) -> Surface:
    """The surface that a shape of a case asks for, read and prepared once.  Raises MeshError."""
    surface = _surface(mesh.found, mesh.scale, mesh.rotate, mesh.move or (0.0, 0.0, 0.0))
    if not mesh.shell and surface.body.open:
        gaps = f"{surface.body.holes:,} hole{'s' * (surface.body.holes != 1)}"
        raise MeshError(
            f"encloses nothing: {surface.body.open_edges:,} open edges around {gaps} as large as itself; "
            "give shell = a thickness in m, or close the surface"
        )
    return surface


def holds(
    mesh: Mesh, grid: Sequence[np.ndarray], tolerance: float, way: np.ndarray | None = None
) -> np.ndarray:
    """True where a point of a grid (psph.scene.forms.form.Grid), moved by the tolerance along the ``way``,
    lies in the shape; broadcasts like the grid."""
    surface, off = surface_of(mesh), ASKEW if way is None else way
    if mesh.shell:
        return surface.shell(grid, mesh.shell, mesh.side == "outside", tolerance, off)
    return surface.encloses(grid, tolerance, off)


def box_around(mesh: Mesh) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Lowest and highest corner of a box around the shape, m; as exact as the file is."""
    surface = surface_of(mesh)
    beyond = surface.rounding
    if mesh.shell and (mesh.side == "outside" or surface.body.open_edges):
        beyond += mesh.shell
    return tuple(x - beyond for x in surface.lower), tuple(x + beyond for x in surface.upper)


@cache
def _surface(found: Found, scale: float, turns: tuple[Turn, ...], move: tuple[float, ...]) -> Surface:
    return Surface(_body(found), scale, turns, move)


@cache
def _body(found: Found) -> FileSurface:
    """The surface of a file, made fit; each once in a process."""
    surface = weld(read(found.path))
    if not len(surface.faces):
        raise MeshError("holds triangles without an area alone; export it again, at its origin")
    about = turned(surface)
    sheet = _about(surface, about)
    rings = holes(sheet)
    whole = closed(sheet, rings)
    own, all_ = (float(np.linalg.norm(areas(one.corners), axis=1).sum()) for one in (sheet, whole))
    encloses = all_ - own <= ALL_OPEN * own
    if encloses and volume(whole.corners) < 0.0:  # all faces lie inwards
        sheet, whole = (_about(one, slice(None)) for one in (sheet, whole))
    open_edges = int(np.count_nonzero(edges_of(sheet.faces).unbalanced))
    return FileSurface(sheet, whole, open_edges, len(rings), int(about.sum()), not encloses)


def _about(surface: Welded, which) -> Welded:
    """With some of its faces turned round."""
    faces = surface.faces.copy()
    faces[which] = faces[which][:, ::-1]
    return surface._replace(faces=faces)


def _placed(surface: Welded, scale: float, turns: Sequence[Turn], move: Sequence[float]) -> Welded:
    """In m, scaled, turned and moved."""
    from scipy.spatial.transform import Rotation

    with np.errstate(over="ignore", invalid="ignore"):
        vertices, rounding = surface.vertices * scale, surface.rounding * scale
    for turn in turns:
        axis, stays = np.array(turn.axis) / np.linalg.norm(turn.axis), np.array(turn.about or (0.0,) * 3)
        rotation = Rotation.from_rotvec(turn.degrees * axis, degrees=True)
        vertices = rotation.apply(vertices - stays) + stays
    return Welded(vertices + np.array(move), surface.faces, rounding)


def _sides(points, reach, tree: Tree, corners, normals):
    """What psph.scene.meshes.loops.sides finds."""
    found, away = np.empty(len(points)), np.zeros((len(points), 3))
    hit = np.zeros((len(points), 2), np.int64)
    sides(np.ascontiguousarray(points), reach, corners, normals, tree.boxes, found, away, hit)
    return found, away, hit.T


def _lined(surface: Welded) -> tuple[Tree, np.ndarray, np.ndarray]:
    """The tree of a surface, its triangles, and the normals of their parts."""
    tree = tree_of(surface.corners)
    return tree, surface.corners[tree.order], _normals(surface)[tree.order]


def _normals(surface: Welded) -> np.ndarray:
    """Normals (n, 7, 3) of faces, their corners and their edges, for :func:`psph.scene.meshes.loops.sides`.

    That of an edge is the sum over its faces, of a corner the same weighted by their angles there.  Zeros at
    the rim of an open surface.
    """
    faces, corners, edges = surface.faces, surface.corners, edges_of(surface.faces)
    along = areas(corners)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    face = along / np.where(length > 0.0, length, 1.0)
    at_edge = np.zeros((len(edges.ends), 3))
    at_corner = np.zeros((len(surface.vertices), 3))
    for k in range(3):
        ahead, back = corners[:, (k + 1) % 3] - corners[:, k], corners[:, k - 1] - corners[:, k]
        angle = np.arctan2(np.linalg.norm(np.cross(ahead, back), axis=1), (ahead * back).sum(axis=1))
        np.add.at(at_corner, faces[:, k], angle[:, None] * face)
        np.add.at(at_edge, edges.of[:, k], face)
    rim = edges.faces == 1
    at_edge[rim] = 0.0
    at_corner[edges.ends[rim].ravel()] = 0.0
    return np.concatenate([face[:, None], at_corner[faces], at_edge[edges.of]], axis=1)
