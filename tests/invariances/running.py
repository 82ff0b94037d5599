"""Runs scenes some steps, and compares what became of the particles that correspond."""

from typing import NamedTuple

import numpy as np
import tomli_w
from drafts import draft
from gauging import start

from psph.simulation.step import Simulation


class State(NamedTuple):
    """Of each particle, by its id: ``start`` and ``position`` (n, dim) in m, ``velocity`` (n, dim) in m/s,
    ``pressure`` (n,) in Pa and ``density`` (n,); of the run its ``time`` in s."""

    start: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    density: np.ndarray
    time: float


def begun(tables, folder) -> Simulation:
    """The simulation of a scene, at its start."""
    return start(draft(folder, tomli_w.dumps(tables)))


def by_id(simulation, name) -> np.ndarray:
    """A field in the order of the ids."""
    store = simulation.store
    return store.owned_rows(name)[np.argsort(store.owned_rows("id"))]


def after(tables, folder, steps) -> State:
    """The state of a scene after so many steps."""
    simulation = begun(tables, folder)
    start = by_id(simulation, "position")
    for _ in range(steps):
        simulation.step()
    rest = (by_id(simulation, name) for name in ("position", "velocity", "pressure", "density"))
    return State(start, *rest, simulation.time)


def matched(one: State, other: State, places) -> np.ndarray:
    """The row in ``other`` of each particle of ``one``, which starts where ``places`` (n, dim) say, m."""
    from scipy.spatial import cKDTree

    apart, rows = cKDTree(other.start).query(places)
    assert len(one.start) == len(other.start) and len(set(rows.tolist())) == len(rows)
    assert apart.max() < 1e-6 * np.ptp(other.start)
    return rows
