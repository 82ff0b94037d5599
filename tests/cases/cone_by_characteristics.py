"""What a cone bears that is pressed into a rigid-plastic soil without weight or friction, by the method of
characteristics.

After Shield (1955), Proc. R. Soc. A 233, 267, for a flat punch, and Houlsby & Wroth (1982), 4th Int. Conf. Numer. Meth.
Geomech., for cones: the level surface of the soil meets the base of the cone, of radius 1; the cohesion is 1, and
pressure positive.  With the mean p of both stresses in the plane, the angle θ of the larger one to the radius, and the
stress around the axis equal to the smaller one (Haar & von Kármán), equilibrium is

    dp + 2 dθ + (dr + dz)/r = 0  along  dz/dr = tan(θ + π/4),
    dp − 2 dθ + (dr − dz)/r = 0  along  dz/dr = tan(θ − π/4).

Points are (r, z, p, θ).
"""

import math

import numpy as np

TURNS = 30
"""Repetitions after which a point stands."""


def bearing(apex: float, roughness: float = 0.0, step: float = 0.02, fan: int = 20) -> float:
    """N = F/(π R² c) of a cone with an ``apex`` angle, degrees, that bears the share ``roughness`` of c along its face.

    From the free surface lines in ``step``s, and ``fan`` of them from the edge, are followed until the face ends on the
    axis.
    """
    half = math.radians(0.5 * apex)
    turned = -half - 0.5 * math.asin(roughness)  # of the larger stress at the face
    angles = np.linspace(0.0, turned, fan + 1)
    line = [(1.0, 0.0, 1.0 - 2.0 * angle, angle) for angle in angles]
    face = [line[-1]]
    while True:
        following = [(1.0 + step * len(face), 0.0, 1.0, 0.0)]
        for before in line[1:]:
            following.append(_crossing(before, following[-1]))
        end = _at_face(following[-1], half, turned)
        if end[0] <= 0.0:
            break
        face.append(end)
        line = [*following, end]
    radius, pressure = np.array(face)[:, 0], np.array(face)[:, 2]
    borne = pressure + math.cos(math.asin(roughness)) + roughness / math.tan(half)
    slope = (borne[-1] - borne[-2]) / (radius[-1] - radius[-2])
    radius, borne = np.append(radius, 0.0), np.append(borne, borne[-1] - slope * radius[-1])
    return -float(np.trapezoid(2.0 * borne * radius, radius))


def _crossing(minus, plus):
    """The point on the line θ − π/4 through one point and on θ + π/4 through another."""
    theta, found = 0.5 * (minus[3] + plus[3]), plus
    for _ in range(TURNS):
        a, b = 0.5 * (minus[3] + theta) - 0.25 * math.pi, 0.5 * (plus[3] + theta) + 0.25 * math.pi
        r, z = _meeting(minus, a, plus, b)
        falls = minus[2] - 2.0 * minus[3] - 2.0 * ((r - minus[0]) - (z - minus[1])) / (r + minus[0])
        rises = plus[2] + 2.0 * plus[3] - 2.0 * ((r - plus[0]) + (z - plus[1])) / (r + plus[0])
        theta, found = 0.25 * (rises - falls), (r, z, 0.5 * (rises + falls), 0.25 * (rises - falls))
    return found


def _at_face(plus, half, theta):
    """Where the line θ + π/4 through a point meets the face, along which θ is known."""
    way = 0.5 * (plus[3] + theta) + 0.25 * math.pi
    r, z = _meeting((1.0, 0.0), -0.5 * math.pi - half, plus, way)
    p = plus[2] + 2.0 * (plus[3] - theta) - 2.0 * ((r - plus[0]) + (z - plus[1])) / (max(r, 0.0) + plus[0])
    return r, z, p, theta


def _meeting(one, angle, other, way):
    """Where straight lines through two points in two directions meet."""
    right = math.cos(angle) * math.sin(way) - math.sin(angle) * math.cos(way)
    far = ((other[0] - one[0]) * math.sin(way) - (other[1] - one[1]) * math.cos(way)) / right
    return one[0] + far * math.cos(angle), one[1] + far * math.sin(angle)
