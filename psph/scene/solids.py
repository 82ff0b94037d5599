"""What particles carry because a scene has elastic solids."""

import math

from psph.fields import CROSSED, Field
from psph.physics.motion import WORK
from psph.physics.solid.compression import OF_HEAT
from psph.physics.solid.contact import MET, OF_CONTACT, OF_FRICTION, SolidContact
from psph.physics.solid.cracks import OF_CRACKS
from psph.physics.solid.deformation import DRAWN, INERTIA, OF_SOLIDS, PULLED, PUSHED, STRESS_ZZ
from psph.physics.solid.material import is_heated, relaxing, yields
from psph.physics.solid.plastic import OF_PLASTIC
from psph.physics.solid.shares import SHARE
from psph.physics.solid.viscous import RELAXED
from psph.scene.calming import solids_of
from psph.scene.gauging import followed_fields
from psph.scene.scene import Scene


def solid_fields(scene: Scene) -> tuple[Field, ...]:
    """What particles carry because the scene has solids, and these yield, crack, have loads or stand in a
    fluid."""
    across = tuple(field for field in followed_fields(scene) if field == CROSSED)
    loads = [load for table in scene.case.solids.values() for load in table.loads.values()]
    followed = [PULLED, PUSHED] if any(load.pressure is not None for load in loads) else []
    lasting = OF_PLASTIC if yields(solids_of(scene.starts)) else ()
    lasting += RELAXED[: relaxing(solids_of(scene.starts))]
    lasting += OF_HEAT if is_heated(solids_of(scene.starts)) else ()
    plane = [STRESS_ZZ] if scene.dimensions == 2 else []
    shares = [SHARE] if any(one.shared for one in solids_of(scene.starts)) else []
    wet = [INERTIA] if scene.case.flowing else []
    cracks = OF_CRACKS if any(one.critical_stretch < math.inf for one in solids_of(scene.starts)) else ()
    meeting = OF_CONTACT if meets(scene) else ()
    meeting += OF_FRICTION if meeting and scene.physics.contact.friction else ()
    meeting += (MET,) if meeting and scene.case.flowing else ()
    own = (*OF_SOLIDS, *plane, *shares, *across, *lasting, *cracks, *meeting)
    return (*own, *([DRAWN, *followed, WORK] if loads else []), *wet)


def meets(scene: Scene) -> bool:
    """Whether elastic solids of a scene feel each other or walls."""
    return scene.physics.contact is not None and SolidContact().in_scene(scene) is not None
