"""How high waves swing on a plane slope that they do not break on, by the linear theory of waves.

The potential obeys φ_n = ω²φ/g at the surface, φ_n = 0 at the bed and the slope, and φ_n = ikφ far off of what leaves; by
Green's third identity as in cases.radiation.
"""

import math

import numpy as np
from cases.radiation import G, influences, panels

from psph.theory.water_waves import wave_number


def shoreline(period: float, depth: float, cot: float, panel: float) -> float:
    """Amplitude of the shoreline over that of the waves that come; half of it is R/H.

    Panels are ``panel`` m long far from the slope and half of that on it; the shoreline is straight on from the last
    two of the surface.
    """
    w, toe, far = 2.0 * math.pi / period, -cot * depth, -cot * depth - 6.0 * depth
    k = wave_number(w, depth, G)
    sides = (  # around the water, anticlockwise
        ([(far, -depth), (toe, -depth)], panel),
        ([(toe, -depth), (0.0, 0.0)], 0.5 * panel),
        ([(0.0, 0.0), (toe, 0.0)], 0.5 * panel),
        ([(toe, 0.0), (far, 0.0)], panel),
        ([(far, 0.0), (far, -depth)], panel),
    )
    parts = [panels(*side) for side in sides]
    which = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    ends = np.concatenate(parts)
    middle, along = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    along /= length[:, None]
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    share = np.where(which == 4, 1j * k, np.where((which == 2) | (which == 3), w * w / G, 0.0))  # φ_n/φ
    high = np.cosh(k * (middle[:, 1] + depth)) / math.cosh(k * depth)
    wave = -1j * G / w * high * np.exp(1j * k * middle[:, 0])
    doubled, single = influences(middle, ends, along, out, length)
    potential = np.linalg.solve(doubled - single * share, single @ np.where(which == 4, -2j * k * wave, 0.0))
    last = np.abs(w / G * potential[which == 2][:2])
    return float(1.5 * last[0] - 0.5 * last[1])
