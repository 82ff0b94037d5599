"""Mooring lines with weight: masses on a string of elastic pieces, which hang in water and lie on a bed.

M. Hall & A. Goupee, Ocean Eng. 104, 590 (2015): the model of MoorDyn.  All vectors have three numbers.
"""

import math
from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise, inside
from psph.vectors import Vector

SUNK = 1e-3
"""Of a piece: how deep it lies in the bed by its own weight."""

YIELDS = 4e-4
"""Of the stiffness of a piece: that of the bed under it at least, where nothing weighs."""

SOFTEST, STIFFER = 10.0, 4.0
"""Weights of a line that its stiffness is at first, where its shape at rest is sought, and the factor by
which it then grows to what it is."""

CALM = 1e-11
"""Of the weight and the tension of a line: what is left of the forces on a mass at rest."""

TRIALS = 400
"""Of a shape at rest, at most, for each stiffness; some ten do."""


class Chain(NamedTuple):
    """What a line with weight is, by metre of its ``length`` L without tension, m, in n equal ``pieces``.

    ``mass`` kg/m, ``displaced`` water kg/m, ``added`` mass of water across it kg/m; ``stiffness`` EA in N;
    ``damping`` of pieces as part of critical; ``drag`` ½ρC_n d and ``skin`` ½ρC_t πd in kg/m².  ``pull`` is
    gravity, m/s²; what lies below ``level``, m along ``up``, is in water.  The bed is a plane through ``bed``
    with ``normal`` and ``bearing`` (N/m² by depth; 0: there is none), and rubs with ``friction``.
    """

    pieces: int
    length: float
    mass: float
    stiffness: float
    damping: float
    displaced: float
    added: float
    drag: float
    skin: float
    pull: Vector
    up: Vector
    level: float
    bed: Vector
    normal: Vector
    bearing: float
    friction: float

    @property
    def longest_step(self) -> float:
        """Δt = (√(1 + ζ²) − ζ)/ω, s, half of what the fastest swing of pieces, ω² = 4EA/(m l²) + k/m, stands
        with the damping ζ and the bed's k."""
        each, zeta = self.length / self.pieces, self.damping
        rate = math.sqrt((4.0 * self.stiffness / each**2 + self.bearing) / self.mass)
        return (math.sqrt(1.0 + zeta * zeta) - zeta) / rate


def bearing_of(mass: float, pull: Vector, stiffness: float, each: float) -> float:
    """Of a bed that pieces of ``each`` m sink into by a thousandth of that, N/m² by depth."""
    return max(mass * math.hypot(*pull) / (SUNK * each), YIELDS * stiffness / each**2)


class Hanging:
    """The state of a line that is a ``chain`` (:class:`Chain`) between two ``ends`` (2, 3), m, which begin
    with the velocities ``going`` (2, 3), m/s: at rest between them.

    ``place`` m and ``velocity`` m/s (n + 1, 3) are of its masses, the ends among them; ``pulls`` (2, 3), N,
    are what it does to what holds its ends, and ``most`` the largest tension within the last step, N.
    """

    def __init__(self, chain: Chain, ends: np.ndarray, going: np.ndarray):
        self.chain = chain
        share = np.linspace(0.0, 1.0, chain.pieces + 1)[:, None]
        self.place = at_rest(chain, ends)
        self.velocity = (1.0 - share) * going[0] + share * going[1]
        self.pulls, self.most = np.zeros((2, 3)), 0.0
        self.advance(ends, going, 0.0)

    def advance(self, ends: np.ndarray, going: np.ndarray, dt: float) -> None:
        """Go on by ``dt`` s, in which the ends come to ``ends`` with the velocities ``going``, in equal steps
        of its own."""
        parts = math.ceil(dt / self.chain.longest_step)
        told = np.array([[self.place[[0, -1]], self.velocity[[0, -1]]], [ends, going]])
        self.most = swing(self.chain, self.place, self.velocity, told, dt, parts, self.pulls)

    def state(self) -> dict:
        """What the next step rests on, as lists of numbers."""
        return {"place": self.place.tolist(), "velocity": self.velocity.tolist()}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self.place, self.velocity = (
            np.reshape(state[name], self.place.shape).astype(float) for name in ("place", "velocity")
        )
        self.advance(self.place[[0, -1]], self.velocity[[0, -1]], 0.0)


def at_rest(chain: Chain, ends: np.ndarray) -> np.ndarray:
    """Where the masses of a ``chain`` (n + 1, 3), m, are at rest between its ``ends`` (2, 3), m.

    The least of a convex energy: it is found for a soft line, then for ever stiffer ones.
    """
    place, weight = _hung(chain, ends), chain.mass * chain.length * math.hypot(*chain.pull)
    stretched = chain.stiffness * max(math.dist(*ends) / chain.length - 1.0, 0.0)
    enough = CALM * (weight + stretched)
    softer = SOFTEST * weight
    while 0.0 < softer < chain.stiffness:
        calm(chain._replace(stiffness=softer), place, 1e6 * enough)
        softer *= STIFFER
    calm(chain, place, enough)
    return place


def _hung(chain: Chain, ends: np.ndarray) -> np.ndarray:
    """A first shape: straight, or with a corner in its middle below the ends."""
    share = np.linspace(0.0, 1.0, chain.pieces + 1)[:, None]
    place = (1.0 - share) * ends[0] + share * ends[1]
    way, down = ends[1] - ends[0], np.array(chain.pull)
    if not (slack := chain.length**2 - float(way @ way)) > 0.0 or not down.any():
        return place
    across = down * float(way @ way) - way * float(way @ down)
    if np.sqrt(across @ across) <= 1e-9 * np.sqrt(down @ down) * float(way @ way):
        across = down
    sag = 0.5 * math.sqrt(slack) / float(np.sqrt(across @ across))
    place += sag * (1.0 - np.abs(2.0 * share - 1.0)) * across
    if chain.bearing > 0.0:
        normal = np.array(chain.normal)
        under = np.minimum((place - chain.bed) @ normal, 0.0)[:, None]
        place[1:-1] -= (under * normal)[1:-1]
    return place


@inside
def _along(a, b, i):
    """a·b of the rows ``i`` of a, and b of three numbers."""
    return a[i, 0] * b[0] + a[i, 1] * b[1] + a[i, 2] * b[2]


@inside
def _wet(chain, place, i):
    """The part of the mass ``i`` that is in water."""
    return min(max(0.5 + (chain.level - _along(place, chain.up, i)) * chain.pieces / chain.length, 0.0), 1.0)


@inside
def _depth(chain, place, i):
    """How deep the mass ``i`` is in the bed, m; the ends are in none."""
    if chain.bearing == 0.0 or i == 0 or i == chain.pieces:
        return 0.0
    b, n = chain.bed, chain.normal
    up = (place[i, 0] - b[0]) * n[0] + (place[i, 1] - b[1]) * n[1] + (place[i, 2] - b[2]) * n[2]
    return max(-up, 0.0)


@inside
def _push(chain, place, velocity, i):
    """How the bed pushes the mass ``i``, N: k d − √(km) ḋ by length, never a pull."""
    depth, each = _depth(chain, place, i), chain.length / chain.pieces
    if depth == 0.0:
        return 0.0
    damped = np.sqrt(chain.bearing * chain.mass) * _along(velocity, chain.normal, i)
    return max(chain.bearing * depth - damped, 0.0) * each


@inside
def _loads(chain, place, velocity, force):
    """Fill ``force`` (n + 1, 3), N, of pieces, weight and bed; returns the largest tension, N."""
    n, each, most = chain.pieces, chain.length / chain.pieces, 0.0
    damped = chain.damping * np.sqrt(chain.stiffness * chain.mass)
    for i in range(n + 1):
        share = 0.5 * each if i == 0 or i == n else each
        weight, push = (
            share * (chain.mass - chain.displaced * _wet(chain, place, i)),
            _push(chain, place, velocity, i),
        )
        for d in range(3):
            force[i, d] = weight * chain.pull[d] + push * chain.normal[d]
    for k in range(n):
        x, y, z = (
            place[k + 1, 0] - place[k, 0],
            place[k + 1, 1] - place[k, 1],
            place[k + 1, 2] - place[k, 2],
        )
        long = np.sqrt(x * x + y * y + z * z)
        if long > each:
            t = x / long, y / long, z / long
            rate = _along(velocity, t, k + 1) - _along(velocity, t, k)
            tension = max(chain.stiffness * (long / each - 1.0) + damped * rate, 0.0)
            most = max(most, tension)
            for d in range(3):
                force[k, d] += tension * t[d]
                force[k + 1, d] -= tension * t[d]
    return most


@inside
def _kick(chain, place, velocity, force, i, h):
    """Let the force and the drag of still water act on the mass ``i`` for ``h`` s, drag without a limit of
    the step; and the friction of the bed, at most until it rests."""
    each, wet = chain.length / chain.pieces, _wet(chain, place, i)
    x, y, z = (
        place[i + 1, 0] - place[i - 1, 0],
        place[i + 1, 1] - place[i - 1, 1],
        place[i + 1, 2] - place[i - 1, 2],
    )
    long = np.sqrt(x * x + y * y + z * z)
    t = (x / long, y / long, z / long) if long > 0.0 else (0.0, 0.0, 0.0)
    light, heavy = each * chain.mass, each * (chain.mass + chain.added * wet)
    pulled, went = _along(force, t, i), _along(velocity, t, i)
    goes, across = went + h * pulled / light, np.empty(3)
    for d in range(3):
        across[d] = velocity[i, d] - went * t[d] + h * (force[i, d] - pulled * t[d]) / heavy
    speed = np.sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2])
    goes /= 1.0 + h * each * chain.skin * wet * abs(goes) / light
    slower = 1.0 + h * each * chain.drag * wet * speed / heavy
    for d in range(3):
        velocity[i, d] = goes * t[d] + across[d] / slower
    rubs = chain.friction * _push(chain, place, velocity, i) * h / light
    if rubs > 0.0:
        rises = _along(velocity, chain.normal, i)
        for d in range(3):
            across[d] = velocity[i, d] - rises * chain.normal[d]
        speed = np.sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2])
        left = max(1.0 - rubs / speed, 0.0) if speed > 0.0 else 0.0
        for d in range(3):
            velocity[i, d] = rises * chain.normal[d] + left * across[d]


@elementwise
def swing(chain, place, velocity, told, dt, parts, pulls):
    """Kick and drift the masses by ``dt`` s in so many ``parts``, their ends as cubic curves between what is
    ``told``: places and velocities (2, 2, 2, 3) before and after.  Fills the ``pulls`` (2, 3) on the ends, N;
    returns the largest tension on the way, N."""
    n, force, most = chain.pieces, np.empty_like(place), 0.0
    h = dt / max(parts, 1)
    for part in range(parts):
        most = max(most, _loads(chain, place, velocity, force))
        for i in range(1, n):
            _kick(chain, place, velocity, force, i, h)
        for i in range(1, n):
            for d in range(3):
                place[i, d] += h * velocity[i, d]
        s = (part + 1.0) / parts
        for end in range(2):
            for d in range(3):
                x, v, y, w = told[0, 0, end, d], told[0, 1, end, d], told[1, 0, end, d], told[1, 1, end, d]
                there = x + s * s * (3.0 - 2.0 * s) * (y - x)
                there += s * (1.0 - s) * ((1.0 - s) * v - s * w) * dt
                velocity[end * n, d] = (there - place[end * n, d]) / h
                place[end * n, d] = there
    for end in range(2):
        place[end * n] = told[1, 0, end]
        velocity[end * n] = told[1, 1, end]
    most = max(most, _loads(chain, place, velocity, force))
    for end in range(2):
        pulls[end] = force[end * n]
    return most


@inside
def _held(chain, place):
    """What :func:`calm` makes least, J: energies of stretch, weight, and depth in the bed."""
    n, each, found = chain.pieces, chain.length / chain.pieces, 0.0
    for i in range(1, n):
        up = (chain.level - _along(place, chain.up, i)) / each + 0.5
        lifted = 0.0 if up <= 0.0 else each * (0.5 * up * up if up < 1.0 else up - 0.5)
        pull = np.sqrt(chain.pull[0] ** 2 + chain.pull[1] ** 2 + chain.pull[2] ** 2)
        if np.isinf(up):
            found -= each * (chain.mass - chain.displaced) * _along(place, chain.pull, i)
        else:
            found -= each * chain.mass * _along(place, chain.pull, i) - each * chain.displaced * pull * lifted
        found += 0.5 * chain.bearing * each * _depth(chain, place, i) ** 2
    for k in range(n):
        x, y, z = (
            place[k + 1, 0] - place[k, 0],
            place[k + 1, 1] - place[k, 1],
            place[k + 1, 2] - place[k, 2],
        )
        stretch = max(np.sqrt(x * x + y * y + z * z) - each, 0.0)
        found += 0.5 * chain.stiffness / each * stretch * stretch
    return found


@inside
def _stiff(chain, place, matrix):
    """Fill the band (3(n − 1), 6) of second derivatives of the energy, N/m: the entry k of a row j stands in
    row j + k."""
    n, each = chain.pieces, chain.length / chain.pieces
    matrix[:] = 0.0
    pull = np.sqrt(chain.pull[0] ** 2 + chain.pull[1] ** 2 + chain.pull[2] ** 2)
    for k in range(n):
        t = place[k + 1] - place[k]
        long = np.sqrt((t**2).sum())
        if not long > each:
            continue
        t /= long
        sideways = chain.stiffness * (1.0 / each - 1.0 / long)
        lengthways = chain.stiffness / each - sideways
        for d in range(3):
            for e in range(3):
                part = lengthways * t[d] * t[e] + (sideways if d == e else 0.0)
                for i in (k, k + 1):
                    if 0 < i < n and e >= d:
                        matrix[3 * (i - 1) + d, e - d] += part
                if 0 < k < n - 1:
                    matrix[3 * (k - 1) + d, 3 + e - d] -= part
    for i in range(1, n):
        lifts = chain.displaced * pull if 0.0 < _wet(chain, place, i) < 1.0 else 0.0
        bears = chain.bearing * each if _depth(chain, place, i) > 0.0 else 0.0
        for d in range(3):
            for e in range(d, 3):
                part = bears * chain.normal[d] * chain.normal[e] + lifts * chain.up[d] * chain.up[e]
                matrix[3 * (i - 1) + d, e - d] += part


@inside
def _solve(matrix, extra, x):
    """Solve (A + ``extra``) y = ``x`` in its place, with the band of A (:func:`_stiff`), by L D Lᵀ."""
    m = len(x)
    for j in range(m):
        matrix[j, 0] += extra
    for j in range(m):
        for k in range(1, min(6, m - j)):
            factor = matrix[j, k] / matrix[j, 0]
            for other in range(k, min(6, m - j)):
                matrix[j + k, other - k] -= factor * matrix[j, other]
            x[j + k] -= factor * x[j]
    for j in range(m - 1, -1, -1):
        for k in range(1, min(6, m - j)):
            x[j] -= matrix[j, k] * x[j + k]
        x[j] /= matrix[j, 0]


@elementwise
def calm(chain, place, enough):
    """Bring the masses at ``place`` (n + 1, 3), m, to rest, where no force on one is more than ``enough``, N;
    returns the largest that is left.  Newton's steps, the shorter the less they bring (Levenberg 1944)."""
    n, each = chain.pieces, chain.length / chain.pieces
    still, force, beyond = np.zeros_like(place), np.empty_like(place), place.copy()
    matrix, step = np.empty((3 * (n - 1), 6)), np.empty(3 * (n - 1))
    _loads(chain, place, still, force)
    left, held = np.abs(force[1:n]).max(), _held(chain, place)
    extra = 0.1 * chain.stiffness / each
    for _ in range(TRIALS):
        if left <= enough:
            break
        _stiff(chain, place, matrix)
        for i in range(1, n):
            for d in range(3):
                step[3 * (i - 1) + d] = force[i, d]
        _solve(matrix, extra, step)
        for i in range(1, n):
            for d in range(3):
                beyond[i, d] = place[i, d] + step[3 * (i - 1) + d]
        less = _held(chain, beyond)
        _loads(chain, beyond, still, force)
        then = np.abs(force[1:n]).max()
        if less < held or then < left:
            place[:], held, left = beyond, less, then
            extra *= 0.2
        else:
            _loads(chain, place, still, force)
            extra *= 5.0
    return left
