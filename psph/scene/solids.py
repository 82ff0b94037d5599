"""What the elastic solids of a case are made of, and the planes that they may hit."""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from psph.fields import CROSSED, Field
from psph.particles.reach import Reach
from psph.physics.motion import WORK
from psph.physics.solid.compression import OF_HEAT
from psph.physics.solid.contact import OF_CONTACT, OF_FRICTION, REACH, SolidContact
from psph.physics.solid.cracks import OF_CRACKS
from psph.physics.solid.deformation import (
    DRAWN,
    HOURGLASS,
    INERTIA,
    OF_SOLIDS,
    REFERENCE,
    SHARED_HOURGLASS,
    SMOOTHING,
    STRESS_ZZ,
)
from psph.physics.solid.material import MADE_OF, Solid, calming_viscosity, is_heated, remembers, solid_of
from psph.physics.solid.plastic import OF_PLASTIC
from psph.physics.solid.shares import SHARE
from psph.scene.distance import endless, faces_of
from psph.scene.lattice import TOLERANCE

FLAT = 0.95
"""Length of the mean of the normals half a spacing around a particle from which no edge is near."""

DEEPEST = 4
"""Particles below a face that a wave along it moves, at most: the steepest ones do not reach deeper, however
thick a solid is (docs/coupling.md)."""

if TYPE_CHECKING:
    from psph.case.solids import Clamp
    from psph.scene.scene import Scene


class Grip(NamedTuple):
    """A clamp: the name of its ``solid``, its ``key`` in the table of that, and what the case says of it."""

    solid: str
    key: str
    table: "Clamp"


def grips_of(case) -> tuple[Grip, ...]:
    """The clamps of all solids of a case."""
    solids = case.updated | case.referred
    return tuple(Grip(name, key, one) for name, solid in solids.items() for key, one in solid.grips.items())


def solids_of(scene: "Scene") -> tuple[Solid, ...]:
    """The elastic solids of a scene, in the order of its case."""
    return tuple(
        solid_of(
            name,
            **{key: getattr(table, key) for key in MADE_OF},
            **_control(scene, table),
            damping=_damping(scene, number, table),
            johnson_cook=table.johnson_cook and dict(table.johnson_cook),
            mie_gruneisen=table.mie_gruneisen and dict(table.mie_gruneisen),
            length=SMOOTHING * scene.spacing,
        )
        for number, (name, table) in enumerate(scene.case.referred.items())
    )


def _control(scene: "Scene", table) -> dict[str, Any]:
    """The hourglass control of a solid: as given, or by default; ``shared`` where it is the default of bars.

    What is drawn out along an axis that repeats is a plate and has that of 2D, so that both do the same.
    """
    if table.hourglass is not None:
        return {"hourglass": table.hourglass, "shared": False}
    shared = scene.dimensions == 3 and not any(scene.periods)
    return {"hourglass": SHARED_HOURGLASS if shared else HOURGLASS, "shared": shared}


def _damping(scene: "Scene", number: int, table) -> float:
    """The viscosity η of a solid, Pa s: as given, or what calms it in a fluid."""
    if table.damping is not None or not scene.case.fluids:
        return table.damping or 0.0
    return calming(scene, number, table)


def impedance(scene: "Scene", number: int, table) -> float:
    """ρ_f c Δt/(ρ_s H) of a solid in a fluid: the part of its speed that it loses in a step Δt to sound.

    H is its thickness, or the depth to which waves along its face reach, 4 spacings.
    """
    density = max(fluid.density for fluid in scene.case.fluids.values())
    thickness = min(across(scene, number)[0], DEEPEST) * scene.spacing
    return density * scene.sound_speed * step_of_fluid(scene) / (table.density * thickness)


def calming(scene: "Scene", number: int, table) -> float:
    """η in Pa s that calms those waves of a solid in a fluid which a step of the fluid does not resolve."""
    share = impedance(scene, number, table)
    return calming_viscosity(table.young, table.poisson, share, step_of_fluid(scene))


def step_of_fluid(scene: "Scene") -> float:
    """The longest step of the fluid, s."""
    time = scene.case.time
    return time.step or time.cfl * scene.smoothing_length / scene.sound_speed


def across(scene: "Scene", number: int) -> tuple[int, int]:
    """The fewest particles that a solid has along an axis, its clamped part with it, and that axis."""
    return thinnest(scene, scene.layout.fluids + number)


def thinnest(scene: "Scene", material: int) -> tuple[int, int]:
    """The same of any material that moves freely."""
    layout = scene.layout
    parts = [material, *(n for n, of in enumerate(layout.clamps, layout.movers) if of == material)]
    low, high = scene.census.lowest[parts].min(axis=0), scene.census.highest[parts].max(axis=0)
    counts = np.rint((high - low) / scene.spacing).astype(int) + 1
    for d, period in enumerate(scene.periods):
        if period is not None and (counts[d] + TOLERANCE) * scene.spacing > period:
            counts[d] = np.iinfo(int).max  # it goes on
    axis = int(counts.argmin())
    return int(counts[axis]), axis


def anvils_of(case) -> tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]:
    """A point of each anvil of a case in m, and the unit vector out of it."""
    tables = case.anvils.values()
    return tuple((one.at, tuple(n / math.hypot(*one.normal) for n in one.normal)) for one in tables)


def modulus_shown(scene: "Scene", material: int) -> float:
    """The P-wave modulus ρ₀c_l² by which a contact with a material is stiff, Pa: of a solid its own,
    of a wall beside solids the largest of theirs, of a fluid 0."""
    if material < scene.layout.fluids or not scene.elastic_solids:
        return 0.0
    own, every = scene.layout.elastic_of(material), scene.elastic_solids
    return max(one.density * one.wave_speed**2 for one in (every if own is None else every[own : own + 1]))


def reach_of_contact(whole: Reach, spacing: float) -> Reach:
    """Of a scene of solids alone: they feel each other within two of the ``spacing`` in m, and what a
    kernel's ``whole`` reach has beyond that is skin, one spacing at least."""
    return Reach(REACH * spacing, max(whole.cutoff - REACH * spacing, spacing))


def solid_fields(scene: "Scene") -> tuple[Field, ...]:
    """What particles carry because the scene has solids, and these yield, crack, have loads or stand in a
    fluid."""
    gauges = scene.case.gauges.values()
    followed = any(gauge.displacement for gauge in gauges)
    counted = followed or any(gauge.reaction or gauge.force for gauge in gauges)
    across = (CROSSED,) if counted and any(scene.periods) else ()
    if not scene.elastic_solids:
        return (REFERENCE, *across) if followed else ()
    loaded = any(table.loads for table in scene.case.solids.values())
    lasting = OF_PLASTIC if remembers(scene.elastic_solids) else ()
    lasting += OF_HEAT if is_heated(scene.elastic_solids) else ()
    plane = [STRESS_ZZ] if scene.dimensions == 2 else []
    shares = [SHARE] if any(one.shared for one in scene.elastic_solids) else []
    wet = [INERTIA] if scene.case.flowing else []
    cracks = OF_CRACKS if any(one.critical_stretch < math.inf for one in scene.elastic_solids) else ()
    meeting = OF_CONTACT if meets(scene) else ()
    meeting += OF_FRICTION if meeting and scene.physics.contact.friction else ()
    own = (*OF_SOLIDS, *plane, *shares, *across, *lasting, *cracks, *meeting)
    return (*own, *([DRAWN, WORK] if loaded else []), *wet)


def meets(scene: "Scene") -> bool:
    """Whether elastic solids of a scene feel each other or walls."""
    return scene.physics.contact is not None and SolidContact().in_scene(scene) is not None


def drawn_faces(scene: "Scene", species: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of particles of these ``species`` (n,) that begin at ``position`` (n, dim) the normals (n, dim) of the
    drawn faces nearest to them, zeros within half a spacing of an edge, and their depths (n,) below, in
    spacings.

    What cracks gets new faces: its particles have none, and half a spacing of depth.
    """
    normal, depth = np.zeros_like(position), np.full(len(position), 0.5)
    for number in np.unique(species):
        own = scene.layout.elastic_of(int(number))
        if scene.layout.solid_of(int(number)) == 0 or own is not None and may_crack(scene, own):
            continue
        drawn = scene.parts[number if own is None else scene.layout.fluids + own].shape
        shape = endless(drawn, scene.lower, scene.upper, scene.periods)
        rows = species == number
        found = faces_of(shape, position[rows])
        mean = np.zeros_like(found.normal)
        for d in range(scene.dimensions):
            for way in (-0.5, 0.5):
                beside = position[rows].copy()
                beside[:, d] += way * scene.spacing
                mean += faces_of(shape, beside).normal / (2.0 * scene.dimensions)
        alike = np.sqrt((mean**2).sum(axis=1))
        normal[rows], depth[rows] = (
            np.where(alike[:, None] > FLAT, found.normal, 0.0),
            -found.away / scene.spacing,
        )
    return normal, depth


def may_crack(scene: "Scene", number: int) -> bool:
    """Whether bonds of an elastic solid may be cut."""
    return scene.elastic_solids[number].critical_stretch < math.inf
