"""Elastic solids in fluids: the damping that calms what a step of the fluid does not resolve."""

from psph.acts import SOLIDS
from psph.physics.solid.material import ElasticSolid, calming_viscosity
from psph.scene.faces import thinnest
from psph.scene.parts.solid import ElasticPart
from psph.scene.speeds import Speeds

DEEPEST = 4
"""Particles below a face that a wave along it moves, at most: the steepest ones do not reach deeper, however
thick a solid is (docs/coupling.md)."""

BREATHING, FROM, TO = 4.0, 0.5, 1.0
"""A face of what swells and shrinks, or through which a wave passes, moves a quarter of the matter that one
does which goes to and fro with all of its thickness.  Steps leave such waves unresolved where one goes in
a step more than ``FROM`` spacings, and less than ``TO`` thicknesses."""

RUBBING = 24.0
"""Fluid that sticks to a solid answers to it as if it were faster by so many ν/dx."""


def damped_solids(speeds: Speeds) -> tuple[ElasticSolid, ...]:
    """The elastic solids of a scene, with the viscosity η of each in Pa s: as given, or what calms it in a
    fluid."""
    parts = [part for part in speeds.layout.parts if isinstance(part, ElasticPart)]
    return tuple(
        part.made._replace(viscosity=_damping(speeds, number, part.table))
        for number, part in enumerate(parts)
    )


def solids_of(starts) -> tuple[ElasticSolid, ...]:
    """What the elastic solids of a scene are made of, by its fourth value (psph.scene.starts)."""
    return starts.materials.get(SOLIDS, ())


def _damping(speeds: Speeds, number: int, table) -> float:
    if table.damping is not None or not speeds.layout.case.fluids:
        return table.damping or 0.0
    return calming(speeds, number, table)


def impedance(speeds: Speeds, number: int, table) -> float:
    """ρ_f c Δt/(ρ_s H) of a solid in a fluid: the part of its speed that it loses in a step Δt to sound.

    H is its thickness, or the depth to which waves along its face reach, 4 spacings.
    """
    density = max(fluid.density for fluid in speeds.layout.case.fluids.values())
    thickness = speeds.layout.spacing * min(_rows(speeds, number), DEEPEST)
    return density * speeds.sound_speed * step_of_fluid(speeds) / (table.density * thickness)


def calming(speeds: Speeds, number: int, table) -> float:
    """η in Pa s that calms those waves of a solid in a fluid which a step of the fluid does not resolve."""
    share, step = impedance(speeds, number, table), step_of_fluid(speeds)
    if _breathes(speeds, number, table.wave_speed * step):
        share *= BREATHING
    if table.no_slip:
        share *= 1.0 + RUBBING * _thickest(speeds) / (speeds.sound_speed * speeds.layout.spacing)
    return calming_viscosity(table.young, table.poisson, share, step)


def _breathes(speeds: Speeds, number: int, way: float) -> bool:
    """Whether a step leaves waves across a solid unresolved, which go so far in it, m."""
    spacing = speeds.layout.spacing
    return FROM * spacing < way < TO * spacing * _rows(speeds, number)


def _thickest(speeds: Speeds) -> float:
    """The largest kinematic viscosity that a fluid may have, m²/s."""
    fluids = speeds.layout.case.fluids.values()
    return max(one.rheology.law.largest / one.density if one.rheology else one.viscosity for one in fluids)


def _rows(speeds: Speeds, number: int) -> int:
    """Of particles across a solid where it is thinnest."""
    return thinnest(speeds.census, speeds.layout.parts.solids[number])[0]


def step_of_fluid(speeds: Speeds) -> float:
    """The longest step of the fluid, s."""
    time = speeds.layout.case.time
    return time.step or time.cfl * speeds.layout.smoothing_length / speeds.sound_speed
