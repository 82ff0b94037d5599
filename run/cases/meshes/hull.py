"""Draws the hull of ``run/cases/hull.toml``: ``python run/cases/meshes/hull.py`` writes hull.stl beside it.

A closed body in mm, 1200 long, 400 wide and 300 high, the same before and behind, keel along x at z = 0,
flat deck.  Its half width is

    y = 200 (1 − ξ⁸) (1 − (1 − ζ)⁴),   ξ = x/600,  ζ = z/300.
"""

import struct
from pathlib import Path

import numpy as np

LENGTH, WIDTH, HEIGHT = 1200.0, 400.0, 300.0
SECTIONS, WATERLINES = 32, 10


def triangles() -> np.ndarray:
    """Corners (n, 3, 3) in mm, each triangle counter-clockwise seen from outside."""
    along, up = np.linspace(-1.0, 1.0, SECTIONS + 1), np.linspace(0.0, 1.0, WATERLINES + 1)
    xi, zeta = np.meshgrid(along, up, indexing="ij")
    x, y, z = xi * LENGTH / 2, WIDTH / 2 * (1 - xi**8) * (1 - (1 - zeta) ** 4), zeta * HEIGHT
    left, right = np.stack([x, y, z], axis=-1), np.stack([x, -y, z], axis=-1)
    deck = np.stack([right[:, -1], left[:, -1]], axis=1)
    patches = [*_halves(left), *(half[:, ::-1] for half in _halves(right)), *_halves(deck[:, ::-1])]
    corners = np.concatenate(patches).astype("<f4")
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return corners[np.linalg.norm(normals, axis=1) > 0.0]  # at stem, stern and keel sides meet


def _halves(grid: np.ndarray):
    """Two triangles for each cell of a grid (n, m, 3) of points."""
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    for corners in ((a, c, b), (a, d, c)):
        yield np.stack(corners, axis=-2).reshape(-1, 3, 3)


def stl(corners: np.ndarray) -> bytes:
    """A binary STL file: a head of 80 bytes, the number of triangles, then normal and corners of each."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    parts = [b"hull of run/cases/hull.toml, in mm".ljust(80), struct.pack("<I", len(corners))]
    for normal, three in zip(normals.astype("<f4"), corners):
        parts += [normal.tobytes(), three.tobytes(), b"\0\0"]
    return b"".join(parts)


if __name__ == "__main__":
    Path(__file__).with_suffix(".stl").write_bytes(stl(triangles()))
