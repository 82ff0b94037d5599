"""What a whole time step makes of plane waves on a periodic lattice: von Neumann's analysis of the code itself.

One number of one particle is disturbed, and a step, or a few, spread it over its neighbours.  The lattice looks
the same from each of its sites, so the Fourier sum over the sites is the matrix that a step multiplies a wave by.
"""

import numpy as np
from invariances.running import begun
from invariances.units import exponents

SMALL = 1e-6
"""Size of a disturbance, in spacings, speeds of sound and rest densities."""

UNTOLD = ("listed_position",)
"""Says only where lists were made."""


def site_names(simulation) -> list[str]:
    """The fields that a particle carries from one step to the next."""
    return [name for name in simulation.store.rows if name not in UNTOLD]


def numbers(simulation, names) -> np.ndarray:
    """All of them, of the particles in the order of their ids: (n, numbers)."""
    store = simulation.store
    order = np.argsort(store.id[store.inner])
    rows = [row for name in names for row in store.rows[name]]
    return store.data[rows][:, store.inner][:, order].T


def put(simulation, names, values) -> None:
    """The reverse."""
    store = simulation.store
    rank = np.argsort(np.argsort(store.id[store.inner]))
    rows = [row for name in names for row in store.rows[name]]
    store.data[np.ix_(rows, np.arange(store.low, store.low + store.owned))] = values[rank].T


def size_of(unit, dx, sound, density, dimensions) -> float:
    """A unit in spacings, times that sound takes for one, and masses of a particle."""
    length, mass, time = exponents(unit, dimensions)
    return dx**length * (density * dx**dimensions) ** mass * (dx / sound) ** time


def amplification(tables, folder, step, steps=1) -> float:
    """The largest |λ| per step, of ``steps`` steps of ``step`` s, over all waves of a periodic lattice at rest."""
    case = {**tables, "time": {**tables["time"], "step": step}}
    simulation = begun(case, folder)
    for _ in range(steps):
        simulation.step()
    names = site_names(simulation)
    store, plan = simulation.store, simulation.plan
    dimensions, density = store.dimensions, float(store.owned_rows("density").mean())
    dx = tables["space"]["spacing"]
    sound = plan.extremes.sound_speed
    sizes = np.concatenate(
        [
            np.full(len(store.rows[name]), size_of(plan.fields[name].unit, dx, sound, density, dimensions))
            for name in names
        ]
    )
    rest, places = (
        numbers(simulation, names),
        store.owned_rows("position")[np.argsort(store.owned_rows("id"))],
    )
    middle = len(rest) // 2
    answers = np.zeros((len(sizes), *rest.shape))
    for number, size in enumerate(sizes):
        ends = []
        for sign in (1.0, -1.0):
            disturbed = rest.copy()
            disturbed[middle, number] += sign * SMALL * size
            put(simulation, names, disturbed)
            for _ in range(steps):
                simulation.step()
            ends.append(numbers(simulation, names))
        answers[number] = (ends[0] - ends[1]) / (2.0 * SMALL * size) / sizes * size
    counts = [
        round(length / dx) for length in np.subtract(tables["space"]["upper"], tables["space"]["lower"])
    ]
    grid = np.stack(np.meshgrid(*[np.arange(n) / n for n in counts], indexing="ij"), -1).reshape(
        -1, dimensions
    )
    offsets = (places - places[middle]) / dx
    phases = np.exp(-2j * np.pi * grid @ offsets.T)
    matrices = np.einsum("ks,asb->kba", phases, answers)
    return float(np.abs(np.linalg.eigvals(matrices)).max() ** (1.0 / steps))
