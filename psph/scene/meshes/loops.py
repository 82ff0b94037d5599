"""Compiled loops over points and triangles."""

import numpy as np

from psph.engine.jit import elementwise
from psph.scene.meshes.tree import LEAF

DEEPEST = 64
"""Boxes that wait to be opened: a tree of 2³⁰ triangles has fewer levels."""

SOME = 64
"""Crossings of a line for which there is room at first."""


@elementwise
def crossing(a_x, a_y, b_x, b_y, x, y):
    """How an edge of a projected triangle passes a point: 1 upwards to its right, −1 downwards, else 0.

    Its ends come in one order, whichever triangle asks: two triangles that share it get the same answer.
    """
    if (a_y > y) == (b_y > y):
        return 0
    at = a_x + (y - a_y) * ((b_x - a_x) / (b_y - a_y))
    at = min(max(at, min(a_x, b_x)), max(a_x, b_x))
    if x < at:
        return 1 if b_y > a_y else -1
    return 0


@elementwise
def windings(x, y, z, corners, turns, boxes, found):
    """How often a surface winds around the points of lines along z.

    x, y (n,) of the lines; z (n, m) of their points; ``corners`` (t, 3, 3) of the triangles in the order of
    the tree, those of each sorted; ``turns`` (t,) 1, or −1 where sorting turned it; ``boxes`` of the tree.
    Fills ``found`` (n, m) int64: crossings above each point, upwards out of the body less downwards into it.

    A triangle counts where its projection winds around the line, by its edges alone: for each edge a point
    is on one side for both its triangles, so that the crossings of a closed surface always add up to 0.
    """
    leaves = len(boxes) // 2
    waiting = np.empty(DEEPEST, np.int64)
    heights, signs = np.empty(SOME), np.empty(SOME, np.int64)
    for line in range(len(x)):
        p, q, low, count = x[line], y[line], z[line].min(), 0
        waiting[0], left = 1, 1
        while left:
            left -= 1
            box = waiting[left]
            if p < boxes[box, 0] or p > boxes[box, 3] or q < boxes[box, 1] or q > boxes[box, 4]:
                continue
            if boxes[box, 5] <= low:  # below all points of the line
                continue
            if box < leaves:
                waiting[left], waiting[left + 1] = 2 * box, 2 * box + 1
                left += 2
                continue
            first = (box - leaves) * LEAF
            for t in range(first, min(first + LEAF, len(corners))):
                a_x, a_y, a_z = corners[t, 0, 0], corners[t, 0, 1], corners[t, 0, 2]
                b_x, b_y, b_z = corners[t, 1, 0], corners[t, 1, 1], corners[t, 1, 2]
                c_x, c_y, c_z = corners[t, 2, 0], corners[t, 2, 1], corners[t, 2, 2]
                sign = crossing(a_x, a_y, b_x, b_y, p, q) + crossing(b_x, b_y, c_x, c_y, p, q)
                sign = turns[t] * (sign - crossing(a_x, a_y, c_x, c_y, p, q))
                if sign == 0:
                    continue
                u_x, u_y, u_z = b_x - a_x, b_y - a_y, b_z - a_z
                v_x, v_y, v_z = c_x - a_x, c_y - a_y, c_z - a_z
                up = u_x * v_y - u_y * v_x
                height = a_z
                if up != 0.0:
                    height -= ((u_y * v_z - u_z * v_y) * (p - a_x) + (u_z * v_x - u_x * v_z) * (q - a_y)) / up
                if count == len(heights):
                    more, others = np.empty(2 * count), np.empty(2 * count, np.int64)
                    for k in range(count):
                        more[k], others[k] = heights[k], signs[k]
                    heights, signs = more, others
                heights[count] = min(max(height, min(a_z, b_z, c_z)), max(a_z, b_z, c_z))
                signs[count] = sign
                count += 1
        for k in range(z.shape[1]):
            number = 0
            for one in range(count):
                if heights[one] > z[line, k]:
                    number += signs[one]
            found[line, k] = number


@elementwise
def sides(points, reach, corners, normals, boxes, found, away, hit):
    """On which side of the nearest triangle points lie that are nearer to it than ``reach``, m.

    ``points`` (n, 3); ``corners`` (t, 3, 3) in the order of the tree; ``normals`` (t, 7, 3) of each
    triangle, of its corners, of its edges from corner k to k + 1 (Bærentzen & Aanæs 2005: summed over the
    faces that meet there); ``boxes`` of the tree.  Fills ``found`` (n,) with (x − nearest)·normal, 0 where
    nothing is near, ``away`` (n, 3) with x − nearest, m, and ``hit`` (n, 2) with the triangle and its part.
    """
    leaves = len(boxes) // 2
    waiting = np.empty(DEEPEST, np.int64)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        least, side = reach * reach, 0.0
        waiting[0], left = 1, 1
        while left:
            left -= 1
            box = waiting[left]
            if _away(boxes, box, x, y, z) >= least:
                continue
            if box < leaves:
                one, other = 2 * box, 2 * box + 1
                if _away(boxes, one, x, y, z) < _away(boxes, other, x, y, z):
                    one, other = other, one
                waiting[left], waiting[left + 1] = one, other  # the nearer one is opened first
                left += 2
                continue
            first = (box - leaves) * LEAF
            for t in range(first, min(first + LEAF, len(corners))):
                part, s, r = _nearest(corners, t, x, y, z)
                d_x = x - (corners[t, 0, 0] + s * (corners[t, 1, 0] - corners[t, 0, 0]))
                d_y = y - (corners[t, 0, 1] + s * (corners[t, 1, 1] - corners[t, 0, 1]))
                d_z = z - (corners[t, 0, 2] + s * (corners[t, 1, 2] - corners[t, 0, 2]))
                d_x -= r * (corners[t, 2, 0] - corners[t, 0, 0])
                d_y -= r * (corners[t, 2, 1] - corners[t, 0, 1])
                d_z -= r * (corners[t, 2, 2] - corners[t, 0, 2])
                square = d_x * d_x + d_y * d_y + d_z * d_z
                if square < least:
                    least = square
                    side = d_x * normals[t, part, 0] + d_y * normals[t, part, 1] + d_z * normals[t, part, 2]
                    away[i, 0], away[i, 1], away[i, 2] = d_x, d_y, d_z
                    hit[i, 0], hit[i, 1] = t, part
        found[i] = side


@elementwise
def _away(boxes, box, x, y, z):
    """Square of the distance from a point to a box, m²."""
    d_x = max(boxes[box, 0] - x, 0.0, x - boxes[box, 3])
    d_y = max(boxes[box, 1] - y, 0.0, y - boxes[box, 4])
    d_z = max(boxes[box, 2] - z, 0.0, z - boxes[box, 5])
    return d_x * d_x + d_y * d_y + d_z * d_z


@elementwise
def _nearest(corners, t, x, y, z):
    """The point of a triangle a + s (b − a) + r (c − a) nearest to another (Ericson 2005, 5.1.5).

    Returns the part that it lies on, 0 the inside, 1 to 3 a corner, 4 to 6 an edge, and s and r.
    """
    a_x, a_y, a_z = corners[t, 0, 0], corners[t, 0, 1], corners[t, 0, 2]
    u_x, u_y, u_z = corners[t, 1, 0] - a_x, corners[t, 1, 1] - a_y, corners[t, 1, 2] - a_z
    v_x, v_y, v_z = corners[t, 2, 0] - a_x, corners[t, 2, 1] - a_y, corners[t, 2, 2] - a_z
    w_x, w_y, w_z = x - a_x, y - a_y, z - a_z
    uu, uv = u_x * u_x + u_y * u_y + u_z * u_z, u_x * v_x + u_y * v_y + u_z * v_z
    vv = v_x * v_x + v_y * v_y + v_z * v_z
    uw, vw = u_x * w_x + u_y * w_y + u_z * w_z, v_x * w_x + v_y * w_y + v_z * w_z
    if uw <= 0.0 and vw <= 0.0:
        return 1, 0.0, 0.0
    ub, vb = uw - uu, vw - uv  # seen from b
    if ub >= 0.0 and vb <= ub:
        return 2, 1.0, 0.0
    share_c = uw * vb - ub * vw
    if share_c <= 0.0 and uw >= 0.0 and ub <= 0.0:
        return 4, uw / (uw - ub), 0.0
    uc, vc = uw - uv, vw - vv  # seen from c
    if vc >= 0.0 and uc <= vc:
        return 3, 0.0, 1.0
    share_b = uc * vw - uw * vc
    if share_b <= 0.0 and vw >= 0.0 and vc <= 0.0:
        return 6, 0.0, vw / (vw - vc)
    share_a = ub * vc - uc * vb
    if share_a <= 0.0 and vb - ub >= 0.0 and uc - vc >= 0.0:
        r = (vb - ub) / ((vb - ub) + (uc - vc))
        return 5, 1.0 - r, r
    whole = share_a + share_b + share_c
    return 0, share_b / whole, share_c / whole
