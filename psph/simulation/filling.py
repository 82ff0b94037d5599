"""The numbers with which particles begin, in the rows of a store."""

import numpy as np

from psph.fields import APART, OF_MATERIAL, REFERENCE
from psph.kinds import kinds_in
from psph.particles.store import Store
from psph.physics.motion import ANCHOR
from psph.simulation.materials import Materials


def block_of(scene, materials: Materials, store: Store, species, position, velocity, density) -> np.ndarray:
    """Rows of ``store`` (rows, n) for particles of these rows of the table, ``species`` (n,), that begin
    there."""
    block = np.zeros((len(store.data), len(species)))
    starting = {"position": position, "velocity": velocity, "predicted_velocity": velocity}
    for name, values in (starting | {ANCHOR.name: position, REFERENCE.name: position}).items():
        if name in store:
            block[list(store.rows[name])] = values.T
    known = {"density": density}
    known |= {field.name: materials.values(field.name)[species] for field in OF_MATERIAL}
    known[APART.name] = materials.apart[species]
    for field in store.fields.values():
        if field.start:
            by_site = callable(field.start)
            known[field.name] = field.start(scene.layout.lattice, position) if by_site else field.start
    for name, values in known.items():
        if name in store:
            block[store.rows[name].start] = values
    for kind in kinds_in(scene):
        for name, values in kind.starts(store.fields, species, position):
            block[list(store.rows[name])] = values.T
    return block
