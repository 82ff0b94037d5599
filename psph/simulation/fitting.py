"""Walls and bodies that are fitted: from sites of the lattice their particles go to rows along their faces.

What lies beyond a face is filled, by the particles of another part or as a half-space would be, whose way out
of the crowd is known; and no particle stays nearer to such a face than half a spacing.  Zhu, Zhang & Hu
(2021), J. Comput. Phys. 444, 110547, pack particles into shapes by such steps.
"""

import numpy as np

from psph.fields import Field
from psph.scene.fitting import beyond, fitted_parts
from psph.scene.layout import NONE
from psph.scene.particles import ParticleSet, settled_at
from psph.simulation.along_faces import INSIDE, SIDE, Along
from psph.simulation.relaxing import Resting, domain_of, places_in, settle, sites_beside

BEHIND = 2**50
"""Ids of sites come behind all others."""

WET = Field("wet", "1", "1 of those with the state of their places, 0 of dry ones")


def fitted(scene, found: ParticleSet, comm) -> ParticleSet:
    """The particles ``found`` of a scene, of which each rank has a part: those of fitted walls and bodies
    stand along their faces, on whichever rank, with the state that the scene has there; collective."""
    parts = fitted_parts(scene.layout)
    if not parts:
        return found
    moving, solid = np.isin(found.material, parts), np.zeros(NONE + 1, bool)
    solid[[one.number for one in scene.layout.parts if not one.flows]] = True
    own = found.where(moving)
    # Sites of the parts themselves, where what lies beyond the faces begins, count to nobody.
    sites = Resting.of(own.id + BEHIND, np.full(len(own.id), NONE), own.position)
    around = sites_beside(scene, comm, parts, ~solid).and_also(sites)
    around = around.filled_by(beyond(scene.layout, parts, around.position))
    still = sites_beside(scene, comm, parts, solid).and_also(around)
    domain = domain_of(scene, comm, own, still, (*SIDE, WET))
    as_placed = settled_at(scene.starts, own.id, own.material, own.position)
    domain.store[WET.name][domain.store.inner][: len(own.id)] = own.density == as_placed.density
    settle(scene, domain, Along(scene.layout, parts, INSIDE))
    store = domain.store
    free = store["whose"][store.inner] >= 0.0
    there = settled_at(scene.starts, *places_in(domain))
    dry = store[WET.name][store.inner][free] == 0.0
    there.density[dry] = [scene.species[one].density for one in there.material[dry]]
    return found.where(~moving).joined(there)
