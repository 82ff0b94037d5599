"""The numbers with which particles begin, in the rows of a store."""

import numpy as np

from psph.fields import APART, OF_MATERIAL
from psph.particles.store import Store
from psph.physics.motion import ANCHOR
from psph.physics.solid.contact import COVER, FACE
from psph.physics.solid.deformation import REFERENCE
from psph.physics.stress.deviator import DEVIATOR
from psph.physics.stress.faces import OF_FACES
from psph.scene.faces import drawn_faces
from psph.scene.smooth import smooth_faces
from psph.simulation.materials import Materials


def block_of(scene, materials: Materials, store: Store, species, position, velocity, density) -> np.ndarray:
    """Rows of ``store`` (rows, n) for particles of these rows of the table, ``species`` (n,), that begin
    there."""
    block = np.zeros((len(store.data), len(species)))
    starting = {"position": position, "velocity": velocity, "predicted_velocity": velocity}
    for name, values in (starting | {ANCHOR.name: position, REFERENCE.name: position}).items():
        if name in store:
            block[list(store.rows[name])] = values.T
    if DEVIATOR.name in store:
        for name in (DEVIATOR.name, f"predicted_{DEVIATOR.name}"):
            block[list(store.rows[name])] = scene.stressed.deviator(species, position).T
    if FACE.name in store:
        normal, depth = drawn_faces(scene.layout, species, position)
        block[list(store.rows[FACE.name])], block[store.rows[COVER.name].start] = normal.T, depth
    if any(field.name in store for field in OF_FACES):
        normal = smooth_faces(scene, species, position)
        for field in OF_FACES:
            if field.name in store:
                block[list(store.rows[field.name])] = normal.T
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
    return block
