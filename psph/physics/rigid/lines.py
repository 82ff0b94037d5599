"""Springs, dampers and mooring lines between bodies, walls and points."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.chains import Chain, Hanging
from psph.vectors import Vector

STEP = 0.2
"""Time steps of at most this over the angular frequency of lines, and over the rate at which they damp."""

SAMPLED = 0.7
"""Over the angular frequency of a body on the end pieces of chains alone: longer steps sample how these swing
too seldom, and may feed it."""

KEPT = ("tensions", "tensions_far", "parted", "borne")
"""The arrays of a state."""


class SpringLine(NamedTuple):
    """A spring with a damper between two points: one ``at`` a point of a ``body``, one at an ``anchor``.

    ``body`` is its row; ``anchor`` a point in space where ``other`` is None, else one of the body of that
    row, or of what a ``leader`` has the pose of; points are given as they are at the start, m, three numbers,
    the anchor ``over``, whole periods, before that of the image that the line ends at. Its tension is k (l −
    l₀) + ζ dl/dt with ``stiffness`` k in N/m, ``length`` l₀ in m and ``damping`` ζ in N s/m. One that
    ``pulls_only`` is slack where it is shorter than l₀ and never pushes: a mooring line without weight. One
    that is a ``chain`` has weight. It parts where its tension is ``breaks``, N, or more.
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
    leader: Any = None
    chain: Chain | None = None
    breaks: float = np.inf
    over: Vector = (0.0, 0.0, 0.0)


class Strung(NamedTuple):
    """A line of a ``name`` as it is drawn: ``points`` (n, 3), m, and its ``tension``, N."""

    name: str
    points: np.ndarray
    tension: float


class Lines:
    """The ``lines`` of the ``bodies`` of a scene, and their state, the same on every rank.

    ``tensions`` and ``tensions_far`` (n,), N, are those at their bodies and at their anchors; ``parted``
    (n,), s, the time at which each has parted, infinite of one that holds, and ``borne`` (n,) the tension at
    which it did, N.
    """

    def __init__(self, lines: Sequence[SpringLine], bodies: Bodies):
        self.lines = tuple(lines)
        self.tensions, self.tensions_far, self.borne = np.zeros((3, len(self.lines)))
        self.parted = np.full(len(self.lines), np.inf)
        self._hanging = {
            number: Hanging(line.chain, *ends_of(line, bodies, 0.0))
            for number, line in enumerate(self.lines)
            if line.chain
        }

    def pulls(self, bodies: Bodies, time: float, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Forces, N, and torques about the reference points, N m, of all lines on the bodies (n, 3) at
        ``time``, s, the end of a step of ``dt`` s."""
        force, torque = np.zeros_like(bodies.place), np.zeros_like(bodies.place)
        for number, line in enumerate(self.lines):
            if self.parted[number] <= time:
                continue
            ends, going = ends_of(line, bodies, time)
            on_ends, most = self._borne(number, ends, going, dt)
            if most >= line.breaks:
                self.parted[number], self.borne[number] = time, most
                on_ends, self.tensions[number], self.tensions_far[number] = np.zeros((2, 3)), 0.0, 0.0
            ends[1] -= line.over
            for row, point, pull in zip((line.body, line.other), ends, on_ends):
                if row is not None:
                    force[row] += pull
                    torque[row] += np.cross(point - bodies.place[row], pull)
        return force, torque

    def parting(self, number: int) -> str:
        """When and how one has parted."""
        return (
            f"bodies.{self.lines[number].name.replace('.', '.lines.', 1)} has parted at "
            f"{self.parted[number]:.6g} s, pulled with {self.borne[number]:.4g} N"
        )

    def shapes(self, bodies: Bodies, time: float) -> Iterator[Strung]:
        """Those that have not parted, as they are at ``time``, s."""
        for number, line in enumerate(self.lines):
            if self.parted[number] > time:
                ends = ends_of(line, bodies, time)[0]
                points = self._hanging[number].place if line.chain else ends
                yield Strung(line.name, points, float(self.tensions[number]))

    def state(self) -> dict:
        """What the next steps rest on, and what is told of this one, as lists of numbers."""
        kept = {name: getattr(self, name).tolist() for name in KEPT}
        kept["parted"] = [None if np.isinf(time) else time for time in kept["parted"]]
        return kept | {"hanging": [one.state() for one in self._hanging.values()]}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        for name in KEPT:
            kept = [np.inf if one is None else one for one in state[name]]
            setattr(self, name, np.array(kept, dtype=float))
        for one, kept in zip(self._hanging.values(), state["hanging"], strict=True):
            one.restore(kept)

    def _borne(self, number: int, ends: np.ndarray, going: np.ndarray, dt: float) -> tuple[np.ndarray, float]:
        """What a line does to its ends (2, 3), N, and its largest tension in the step, N."""
        line = self.lines[number]
        if line.chain:
            hung = self._hanging[number]
            hung.advance(ends, going, dt)
            found = np.sqrt((hung.pulls**2).sum(axis=1))
            self.tensions[number], self.tensions_far[number] = found
            return hung.pulls, max(hung.most, float(found.max()))
        apart = ends[1] - ends[0]
        length = float(np.sqrt(apart @ apart))
        along = apart / length if length > 0.0 else apart
        tension = line.stiffness * (length - line.length)
        tension += line.damping * float((going[1] - going[0]) @ along)
        if line.pulls_only:
            tension = max(tension, 0.0) if length > line.length else 0.0
        self.tensions[number] = self.tensions_far[number] = tension
        return np.array([tension * along, -tension * along]), tension


def longest_step(lines: Sequence[SpringLine], bodies: Bodies) -> float:
    """Δt ≤ 0.2/√λ for the springs and 0.2/λ for the dampers, s: λ the largest eigenvalue of M⁻¹K, at most;
    and 0.7/√λ by the end pieces of chains.

    Bodies are joined by the sum of their lines, K_ab = Σ_l k_l √(y_la y_lb), with y what an end gives way by,
    1/kg.  One spring has λ = k/m.  Springs are stable up to 2/√λ, and dampers up to 1/λ: the rest is for
    accuracy, as a line that goes slack strikes.
    """
    stiff, share = [line.stiffness for line in lines], (STEP / SAMPLED) ** 2
    pieces = [line.stiffness * share * line.chain.pieces if line.chain else 0.0 for line in lines]
    rates = [_joined(lines, bodies, one) ** 0.5 for one in (stiff, pieces)]
    rate = max(*rates, _joined(lines, bodies, [line.damping for line in lines]))
    return STEP / rate if rate > 0.0 else float(np.inf)


def ends_of(line: SpringLine, bodies: Bodies, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Place, m, and velocity, m/s, of both ends (2, 3) at ``time``, s."""
    first, there = bodies.at(line.body, np.array(line.at)), np.array(line.anchor)
    if line.other is not None:
        last = bodies.at(line.other, there)
    elif line.leader is not None:
        pose = line.leader.pose(time)
        last = np.array(pose.place(line.anchor)), np.array(pose.velocity_of(line.anchor))
    else:
        last = there, np.zeros(3)
    return np.array([first[0], last[0] + line.over]), np.array([first[1], last[1]])


def _joined(lines: Sequence[SpringLine], bodies: Bodies, by: Sequence[float]) -> float:
    """λ by a number of each line, 1/s² or 1/s."""
    whole = np.zeros((len(bodies.bodies),) * 2)
    for line, one in zip(lines, by):
        ends = np.zeros(len(bodies.bodies))
        ends[line.body] = _yielding(bodies, line.body, line.at)
        if line.other is not None:
            ends[line.other] += _yielding(bodies, line.other, line.anchor)
        whole += one * np.sqrt(np.outer(ends, ends))
    return float(np.linalg.eigvalsh(whole).max(initial=0.0))


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
