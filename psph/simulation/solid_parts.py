"""What solids have beside their stress, each imported late: most have none of it."""

from psph.physics.solid.contact import FACE
from psph.physics.solid.deformation import DRAWN
from psph.simulation.solid_plan import solid_plan


def parts_of(scene, plan, store, comm) -> tuple:
    """What moves clamps, pulls parts of solids, carries faces that touch, and cuts bonds; None for each that
    a plan has no use for."""
    own = solid_plan(plan)
    clamps = loads = faces = cracks = None
    if own.grips.any():
        from psph.simulation.clamps import Clamps

        clamps = Clamps(scene, plan, store)
    if DRAWN.name in store:
        from psph.simulation.solid_loads import SolidLoads

        loads = SolidLoads(scene, store, comm)
    if FACE.name in store:
        from psph.simulation.solid_faces import SolidFaces

        faces = SolidFaces(scene, store)
    if own.cracks:
        from psph.simulation.solid_cracks import Cracks

        cracks = Cracks(scene, plan, store)
    return clamps, loads, faces, cracks
