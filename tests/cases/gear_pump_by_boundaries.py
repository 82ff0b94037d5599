"""The gear pump of run/cases in creeping flow, by boundary elements, at rest in each place of its wheels."""

import numpy as np
from cases.stokes_by_boundaries import closed, tractions

TEETH, TIP, ROOT, APART, GAP, HALF, END = 6, 0.02, 0.01, 0.016, 0.0015, 0.007, 0.032
"""Of a wheel: teeth, radii at their tips and roots, half the distance of the axes, and the gap to the casing; half the
width of the mouths, and how far they reach, m."""
WIDE = 0.003, 0.0015
"""Half the width of a tooth at its root and its tip, m."""
VISCOSITY, SPEED = 0.72, 10.0
"""Pa s; rad/s."""


def wheel(turned, middle):
    """Corners (n, 2), m, anticlockwise, of a wheel with a tooth at an angle, rad."""
    begin, root = np.arcsin(WIDE[0] / ROOT), np.sqrt(ROOT**2 - WIDE[0] ** 2)
    tooth = np.array([(root, -WIDE[0]), (TIP, -WIDE[1]), (TIP, WIDE[1]), (root, WIDE[0])])
    arc = np.linspace(begin, 2.0 * np.pi / TEETH - begin, 7)[1:-1]
    part = np.concatenate([tooth, ROOT * np.stack([np.cos(arc), np.sin(arc)], axis=1)]) @ (1.0, 1.0j)
    whole = np.outer(np.exp(1j * (turned + 2.0 * np.pi * np.arange(TEETH) / TEETH)), part).ravel()
    return np.stack([whole.real, middle + whole.imag], axis=1)


def casing(count=120):
    """Its corners (n, 2), m, anticlockwise, with the two mouths."""
    radius = TIP + GAP
    below = np.arcsin((APART - HALF) / radius)
    arc = radius * np.exp(1j * np.linspace(-below, np.pi + below, count)) + 1j * APART
    half = np.concatenate([[END + 1j * HALF], arc, [-END + 1j * HALF]])
    whole = np.concatenate([half, -half])
    return np.stack([whole.real, whole.imag], axis=1)


def rise(turned, speed, flow, size):
    """How far the pressure in the right mouth is above that in the left, Pa, where wheels turned by an angle, rad, turn
    with a ``speed``, rad/s, and a ``flow``, m²/s, goes to the right; of elements of about ``size`` m."""
    case = closed(casing(), size)
    middle, velocity = 0.5 * (case.begin + case.end), np.zeros_like(case.begin)
    ends = [np.flatnonzero(np.abs(middle[:, 0] - side * END) < 1e-9) for side in (1.0, -1.0)]
    for end in ends:
        velocity[end, 0] = 0.75 * flow / HALF * (1.0 - (middle[end, 1] / HALF) ** 2)
    upper = closed(wheel(-np.pi / 2 - turned, APART), size, -speed, (0.0, APART), inner=True)
    lower = closed(wheel(np.pi / 2 + np.pi / TEETH + turned, -APART), size, speed, (0.0, -APART), inner=True)
    force, _, length = tractions((case._replace(velocity=velocity), upper, lower), VISCOSITY)
    right, left = (float((force[end, 0] * length[end]).sum() / length[end].sum()) for end in ends)
    return -right - left


def delivered(size, places=4):
    """Volume by turn, m², between mouths of one pressure, and what a pressure of 1 Pa takes of it."""
    found = []
    for turned in np.pi / TEETH * np.arange(places) / places:  # half a tooth: then both have changed places
        own, by_flow = rise(turned, SPEED, 0.0, size), rise(turned, 0.0, 1e-3, size)
        found.append((-own / by_flow * 1e-3, -1e-3 / by_flow))
    return np.mean(found, axis=0) * 2.0 * np.pi / SPEED
