"""The exact flow around a wedge that enters still water at a constant speed, without gravity, as numbers.

O. Wagner (1932), Z. Angew. Math. Mech. 12, 193, and Z. N. Dobrovol'skaya (1969), J. Fluid Mech. 36, 805.  In z = (x +
iy)/Vt the flow stands still.  With its complex velocity w' the numbers w'' dz² are real on the faces and on the
axis of symmetry, imaginary on the free surface.  So w'' (dz/dt)² = C t^(−3/2)/(t − 1), with the fluid mapped to the upper
half of a plane t: the free surface to t < 0, the line of contact to 0, a face to 0 < t < 1, the tip to 1.  There
dz/dt = −iK (t − 1)^(β/π − ½) t^(−β/π) exp G(t), and G follows from the direction π + g(−t) of the free surface, for which

    dg/dτ = −C τ^(−3/2)/((1 + τ) |z'| ∫₀^τ |z'| dτ),   τ = −t,

since relative to the similar flow the surface moves along itself, from the line of contact where that rests.
"""

import numpy as np

NEAR, FAR = -30.0, 20.0
"""Logarithms of τ between which the surface is followed."""


def force_and_peak(deadrise: float, points: int = 300) -> tuple[float, float]:
    """F/(ρV³t) of both faces together and the largest p/(ρV²/2), of faces that rise by ``deadrise`` rad."""
    share = deadrise / np.pi
    edges = np.exp(np.linspace(NEAR, FAR, points + 1))
    tau, width = np.sqrt(edges[1:] * edges[:-1]), np.diff(edges)
    x = np.linspace(-30.0, 30.0, 2 * points)
    t, rest = 1.0 / (1.0 + np.exp(-x)), 1.0 / (1.0 + np.exp(x))  # t and 1 − t on a face
    step = t * rest * (x[1] - x[0])
    to_surface, to_face = _logarithms(tau, edges), _logarithms(-t, edges)

    def shape(g):
        """|z'|/K on the surface and on the face, the lengths before their first points, −C/K² and Q/CK."""
        first, changes = g[0] / np.pi, np.diff(g) / np.pi
        surface = (1.0 + tau) ** (share - 0.5) * tau ** (first - share) * np.exp(to_surface @ changes)
        face = rest ** (share - 0.5) * t ** (first - share) * np.exp(to_face @ changes)
        angle = 1.0 + first - share  # between surface and face, over π
        pull = 1.0 / (t**1.5 * rest * face)
        begun = surface[0] * tau[0] / angle, face[0] * t[0] / angle
        size = ((face * step).sum() + begun[1]) / (pull * step).sum()  # the tip moves with the wedge
        return surface, face, begun, size, pull

    def fault(g):
        surface, _, (begun, _), size, _ = shape(g)
        length = begun + np.cumsum(surface * width) - 0.5 * surface * width
        turned = size / (tau**1.5 * (1.0 + tau) * surface * length) * width
        return g + np.append(np.cumsum(turned[::-1])[::-1], 0.0)

    g = _newton(fault, np.interp(np.log(edges), [-4.0, 3.0], [deadrise - 0.94 * np.pi, 0.0]))
    surface, face, begun, size, pull = shape(g)
    middle = 0.5 * (g[1:] + g[:-1])
    fall = (np.sin(middle) * surface * width).sum() + np.sin(g[0]) * begun[0]  # from the contact to far away
    scale = 1.0 / (np.sin(deadrise) * ((face * step).sum() + begun[1]) + fall)  # K: far away y is 0, here −1
    along, drag = face * scale, size * pull * scale
    speed = np.cumsum((drag - along) * step) - 0.5 * (drag - along) * step - begun[1] * scale
    gained = -speed * drag * step
    pressure = np.cumsum(gained) - 0.5 * gained
    force = 2.0 * np.cos(deadrise) * (pressure * along * step).sum()
    return float(force), float(2.0 * pressure.max())


def _logarithms(points, edges):
    """The mean of ln|σ − τ| over σ in each cell, for each of the ``points`` τ: (points, cells)."""
    width, middle = np.diff(edges), np.sqrt(edges[1:] * edges[:-1])
    apart = edges[None, :] - points[:, None]
    whole = np.diff(apart * (np.log(np.abs(apart)) - 1.0), axis=1) / width
    rough = np.log(np.maximum(np.abs(middle - points[:, None]), 1e-300))
    return np.where(width > 1e-4 * np.abs(points)[:, None], whole, rough)


def _newton(fault, g, rounds=30, tried=12):
    """The zero of a function of a vector, from ``g`` on, by steps that are halved until they help."""
    off = fault(g)
    for _ in range(rounds):
        if np.abs(off).max() < 1e-9:
            return g
        slopes = np.stack([(fault(g + e) - off) / 1e-6 for e in 1e-6 * np.eye(len(g))], axis=1)
        way = np.linalg.solve(slopes, -off)
        for part in 0.5 ** np.arange(tried):
            trial = g + part * way
            found = fault(trial)
            if np.isfinite(found).all() and np.abs(found).max() < (1.0 - 0.1 * part) * np.abs(off).max():
                break
        g, off = trial, found
    raise ArithmeticError(f"the free surface is not found: {np.abs(off).max():.2g} is left")
