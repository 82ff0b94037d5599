"""Plane creeping flow between walls that move, by boundary elements.

½ u(x) = 1/(4πμ) ∮ G f ds − 1/(4π) ∮ u T n ds with G = −ln r + r r/r² and T = −4 r r r/r⁴, f the traction on the
boundary, n out of the fluid (Pozrikidis, Boundary Integral and Singularity Methods, 1992).  u is told everywhere,
f found, by straight elements on which both are constant.
"""

from typing import NamedTuple

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


class Wall(NamedTuple):
    """Elements from ``begin`` to ``end`` (n, 2), m, the fluid on their left; their velocity (n, 2), m/s."""

    begin: np.ndarray
    end: np.ndarray
    velocity: np.ndarray


def closed(points, size, turning=0.0, about=(0.0, 0.0), inner=False):
    """A wall through the corners ``points`` (n, 2), anticlockwise, of elements of about ``size`` m or sizes (n,);
    the fluid is within, or around it where it is ``inner``; it turns with ``turning`` rad/s ``about`` a point."""
    points = np.asarray(points, float)
    after, sizes, found = np.roll(points, -1, axis=0), np.broadcast_to(size, len(points)), []
    for a, b, one in zip(points, after, sizes):
        count = max(1, round(float(np.hypot(*(b - a))) / one))
        found.append(a + (b - a) * np.linspace(0.0, 1.0, count, endpoint=False)[:, None])
    begin = np.concatenate(found)
    end = np.roll(begin, -1, axis=0)
    if inner:
        begin, end = end[::-1], begin[::-1]
    arm = 0.5 * (begin + end) - np.asarray(about)
    return Wall(begin, end, turning * np.stack([-arm[:, 1], arm[:, 0]], axis=1))


def circle(center, radius, count):
    """Corners of a polygon with the area of a circle."""
    angle = 2.0 * np.pi * np.arange(count) / count
    wide = radius * np.sqrt(2.0 * np.pi / count / np.sin(2.0 * np.pi / count))
    return np.asarray(center) + wide * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def tractions(walls, viscosity):
    """Force of the walls on the fluid by area (n, 2), Pa, up to a pressure; middles (n, 2), lengths (n,), m."""
    begin, end, speed = (np.concatenate([wall[k] for wall in walls]) for k in range(3))
    middle, way = 0.5 * (begin + end), end - begin
    length = np.hypot(*way.T)
    along = way / length[:, None]
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    n = len(middle)
    single, double = np.zeros((2, n, 2, n, 2))
    for node, weight in zip(NODES, WEIGHTS):
        apart = (middle + 0.5 * node * way)[None] - middle[:, None]
        square = (apart**2).sum(axis=2)
        np.fill_diagonal(square, 1.0)
        pair = apart[:, :, :, None] * apart[:, :, None, :] / square[:, :, None, None]
        own = 0.5 * weight * length
        bare = -0.5 * np.log(square)[:, :, None, None] * np.eye(2)
        single += ((bare + pair) * own[None, :, None, None]).transpose(0, 2, 1, 3)
        toward = (apart * normal[None]).sum(axis=2) / square
        double += (-4.0 * pair * (toward * own[None])[:, :, None, None]).transpose(0, 2, 1, 3)
    each = np.arange(n)
    itself = (1.0 - np.log(0.5 * length))[:, None, None] * np.eye(2) + along[:, :, None] * along[:, None, :]
    single[each, :, each, :] = length[:, None, None] * itself
    double[each, :, each, :] = 0.0
    flat = speed.ravel()
    right = 0.5 * flat + (double.reshape(2 * n, 2 * n) @ flat) / (4.0 * np.pi)
    matrix = single.reshape(2 * n, 2 * n) / (4.0 * np.pi * viscosity)
    scale, first = np.abs(matrix).max(), 0
    for wall in walls:  # of a pressure on all of one nothing is known: it moves nothing
        each = np.arange(first, first := first + len(wall.begin))
        matrix = matrix + scale * _evenly(each, normal, length)
    force = np.linalg.solve(matrix, right)
    return force.reshape(n, 2), middle, length


def _evenly(rows, normal, length):
    """The matrix (2n, 2n) that takes the mean pressure on some elements to all of them."""
    own = np.zeros_like(normal)
    own[rows] = normal[rows]
    return np.outer(own.ravel(), (own * length[:, None]).ravel()) / length[rows].sum()


def moments(walls, viscosity, about):
    """The moment of the fluid on each wall about a point, N m/m, anticlockwise."""
    force, middle, length = tractions(walls, viscosity)
    arm = middle - np.asarray(about)
    own = -(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]) * length
    return [float(part.sum()) for part in np.split(own, np.cumsum([len(wall.begin) for wall in walls])[:-1])]
