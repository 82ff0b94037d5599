"""Springs, dampers and mooring lines between bodies and points."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.vectors import Vector

STEP = 0.2
"""Time steps of at most this over the angular frequency of lines, and over the rate at which they damp."""


class SpringLine(NamedTuple):
    """A spring with a damper between two points: one ``at`` a point of a ``body``, one at an ``anchor``.

    ``body`` is its row; ``anchor`` a point in space where ``other`` is None, else one of the body of
    that row; points are given as they are at the start, m, three numbers.  Its tension is k (l − l₀) + ζ
    dl/dt with ``stiffness`` k in N/m, ``length`` l₀ in m and ``damping`` ζ in N s/m.  One that
    ``pulls_only`` is slack where it is shorter than l₀ and never pushes: a mooring line without weight.
    """

    name: str
    body: int
    at: Vector
    other: int | None
    anchor: Vector
    stiffness: float
    length: float
    damping: float
    pulls_only: bool


def pulls(lines: Sequence[SpringLine], bodies: Bodies) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forces, N, and torques about the reference points, N m, of all lines on the bodies (n, 3), and the
    tension of each line, N."""
    force, torque = np.zeros_like(bodies.place), np.zeros_like(bodies.place)
    tensions = np.zeros(len(lines))
    for number, line in enumerate(lines):
        (here, own), (there, its) = _ends(line, bodies)
        apart = there - here
        length = float(np.sqrt(apart @ apart))
        along = apart / length if length > 0.0 else apart
        tension = line.stiffness * (length - line.length) + line.damping * float((its - own) @ along)
        if line.pulls_only:
            tension = max(tension, 0.0) if length > line.length else 0.0
        pull = tension * along
        for row, point, sign in ((line.body, here, 1.0), (line.other, there, -1.0)):
            if row is not None:
                force[row] += sign * pull
                torque[row] += np.cross(point - bodies.place[row], sign * pull)
        tensions[number] = tension
    return force, torque, tensions


def longest_step(lines: Sequence[SpringLine], bodies: Bodies) -> float:
    """Δt ≤ 0.2/√λ for the springs and 0.2/λ for the dampers, s: λ the largest eigenvalue of M⁻¹K, at most.

    Bodies are joined by the sum of their lines, K_ab = Σ_l k_l √(y_la y_lb), with y what an end gives way by,
    1/kg.  One spring has λ = k/m.  Springs are stable up to 2/√λ, and dampers up to 1/λ: the rest is for
    accuracy, as a line that goes slack strikes.
    """
    rate = max(_joined(lines, bodies, "stiffness") ** 0.5, _joined(lines, bodies, "damping"))
    return STEP / rate if rate > 0.0 else float(np.inf)


def _joined(lines: Sequence[SpringLine], bodies: Bodies, what: str) -> float:
    """λ by the numbers of that name, 1/s² or 1/s."""
    whole = np.zeros((len(bodies.bodies),) * 2)
    for line in lines:
        ends = np.zeros(len(bodies.bodies))
        ends[line.body] = _yielding(bodies, line.body, line.at)
        if line.other is not None:
            ends[line.other] += _yielding(bodies, line.other, line.anchor)
        whole += getattr(line, what) * np.sqrt(np.outer(ends, ends))
    return float(np.linalg.eigvalsh(whole).max(initial=0.0))


def _ends(line: SpringLine, bodies: Bodies):
    """Place and velocity of both ends."""
    first = bodies.at(line.body, np.array(line.at))
    if line.other is None:
        return first, (np.array(line.anchor), np.zeros(3))
    return first, bodies.at(line.other, np.array(line.anchor))


def _yielding(bodies: Bodies, row: int, point: Vector) -> float:
    """Acceleration of a point of a body by a unit force on it at most, 1/kg."""
    arm2 = float(((np.array(point) - bodies.reference[row]) ** 2).sum())
    one = bodies.bodies[row]
    slid = 1.0 / one.mass if any(one.slides) else 0.0
    turned = 0.0
    if row in bodies.hinged:
        turned = arm2 / float(bodies.about[bodies.hinged == row][0])
    elif row in bodies.tumbling:
        turned = arm2 / float(bodies.moments[bodies.tumbling == row].min())
    return slid + turned
