"""What a case could once ask of psph itself and is in files beside psph's own cases now."""

from psph.case.errors import dotted
from psph.case.findings import Location

FOLDER = "run/remedies"
"""Where they are in the folder of psph's sources."""

DEPARTED = {
    "physics.conservative_smoothing": "conservative_smoothing.py",
    "physics.generalised_transport_velocity": "transport.py",
    "physics.pair_potential": "pair_potential.py",
    "physics.pressure_gradient=stress_points": "stress_points.py",
    "physics.riemann_dissipation": "riemann_dissipation.py",
    "physics.transport_velocity": "transport.py",
    "physics.xsph": "transport.py",
    "space.kernel=quadratic": "kernels.py",
    "space.kernel=spiky": "kernels.py",
}
"""The file of each key, or of a choice of one, that left the catalogue for want of a case that it helps."""


def departed(loc: Location, value: object = None) -> str:
    """Where a key, or a choice of one, stands now, and what to do; empty where psph never had it."""
    file = DEPARTED.get(dotted(loc) if value is None else f"{dotted(loc)}={value}")
    if file is None:
        return ""
    return f'is in a file of its own; copy {FOLDER}/{file} beside the case, and give use = ["{file}"]'
