"""Diagnostics of a run: energies, momentum, largest speed, density error."""

from collections.abc import Callable, Sequence

import numpy as np
from mpi4py import MPI

from psph.fields import BUFFER, FLUID, WALL
from psph.parallel.reductions import Contribution, exact_sums
from psph.particles.store import Store
from psph.rows import projected

LED = (WALL, BUFFER)
"""Kinds of particles that forces do not move."""


def columns(dimensions: int, of_kinds: Sequence[str] = ()) -> list[str]:
    """Columns of log.csv, with those ``of_kinds`` of matter (psph.kinds)."""
    momentum = [f"momentum_{axis}" for axis in "xyz"[:dimensions]]
    return [
        "time",
        "step",
        "dt",
        "kinetic_energy",
        "potential_energy",
        *of_kinds,
        *momentum,
        "largest_speed",
        "density_error",
    ]


def logged(store: Store, gravity: Sequence[float], potential: np.ndarray | float = 0.0) -> Contribution:
    """What this rank adds to the numbers of log.csv: terms of Σ m v²/2 (J), Σ m (φ − g·x) (J) and Σ m v
    (kg m/s) of fluids and solids, per metre of depth in 2D, and the largest |ρ/ρ₀ − 1| of the fluid.

    ``potential`` φ (n,), J/kg, is that of other forces than ``gravity``.
    """
    flows, moves = store.kinds == FLUID, ~np.isin(store.kinds, LED)
    moved = _members(store, moves)
    fluid = moved if (flows == moves).all() else _members(store, flows)
    mass, speeds = (_of(store, name, moved) for name in (_inert(store), "velocity"))
    terms = np.empty((2 + len(speeds), len(moved)))
    np.multiply(0.5 * mass, np.add.reduce(np.square(speeds), axis=0), out=terms[0])
    pulls = {axis: pull for axis, pull in enumerate(gravity) if pull}
    places = np.array([store.shown("position").T[axis][moved] for axis in pulls])
    level = projected(places.T, list(pulls.values())) if pulls else 0.0
    np.multiply(mass, (potential if np.ndim(potential) == 0 else potential[moved]) - level, out=terms[1])
    np.multiply(mass, speeds, out=terms[2:])
    ratio = _of(store, "density", fluid) / _of(store, "rest_density", fluid)
    return Contribution(terms.T, [float(np.abs(ratio - 1.0).max(initial=0.0))])


def _members(store: Store, which: np.ndarray) -> np.ndarray:
    """The owned particles (m,) of the groups where ``which`` (groups,) is true."""
    group = store.shown("group")
    return np.flatnonzero(
        np.logical_or.reduce([group == one for one in np.flatnonzero(which)], initial=False)
    )


def _of(store: Store, name: str, which: np.ndarray) -> np.ndarray:
    """Values of the owned particles ``which`` (m,), a row for each component of a field with several; the
    number that all share."""
    if name not in store.rows:
        return store.constants[name]
    shown = store.shown(name)
    return np.array([row[which] for row in shown.T]) if shown.ndim > 1 else shown[which]


def total_energy(
    comm: MPI.Comm,
    store: Store,
    gravity: Sequence[float],
    compressed: Callable,
    led: np.ndarray,
    potential: np.ndarray | float = 0.0,
) -> float:
    """Σ m (v²/2 + φ − g·x) of fluids and solids and Σ m u of all particles, J.

    ``potential`` φ (n,), J/kg, is that of other forces than ``gravity``.

    Groups that are ``led`` (groups,) move as they are told: they count as walls.  ``compressed`` takes
    densities and rest densities (n,) and gives u, J/kg.  NaN where a density is below zero.  The same bits on
    any number of ranks; collective.
    """
    inner = store.inner
    moved = sum(
        x[inner] * -g + 0.5 * v[inner] ** 2 for x, v, g in zip(store["position"], store["velocity"], gravity)
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        stored = compressed(store.shown("density"), store.shown("rest_density"))
    moves = ~np.isin(store.shown("kind"), LED) & ~led[store.shown("group")]
    moving = store.shown(_inert(store)) * np.where(moves, moved + potential, 0.0)
    energy = moving + store.shown("mass") * stored
    return float(exact_sums(comm, energy[:, None])[0])


def work_done(comm: MPI.Comm, store: Store) -> float:
    """Energy that moving walls and frames have given since the start, J; the same bits on any number of
    ranks, collective."""
    return float(exact_sums(comm, store.shown("work")[:, None])[0])


def moving_mass(comm: MPI.Comm, store: Store) -> float:
    """Mass of fluids and solids, kg; the same bits on any number of ranks, collective."""
    mass = np.where(np.isin(store.shown("kind"), LED), 0.0, store.shown(_inert(store)))
    return float(exact_sums(comm, mass[:, None])[0])


def true_mass(store: Store) -> np.ndarray:
    """The mass (owned,) that forces move, kg: a copy."""
    return store.owned_rows(_inert(store))


def _inert(store: Store) -> str:
    """The name of the mass that forces move: in a fluid solids show another one."""
    return "inertia" if "inertia" in store else "mass"
