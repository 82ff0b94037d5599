"""Elastic solids in fluids: the damping that calms what a step of the fluid does not resolve."""

from psph.acts import SOLIDS
from psph.physics.solid.material import ElasticSolid, calming_viscosity
from psph.scene.faces import thinnest
from psph.scene.parts.solid import ElasticPart
from psph.scene.speeds import Speeds

DEEPEST = 4
"""Particles below a face that a wave along it moves, at most: the steepest ones do not reach deeper, however
thick a solid is (docs/coupling.md)."""


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
    thickness = min(thinnest(speeds.census, speeds.layout.parts.solids[number])[0], DEEPEST)
    thickness *= speeds.layout.spacing
    return density * speeds.sound_speed * step_of_fluid(speeds) / (table.density * thickness)


def calming(speeds: Speeds, number: int, table) -> float:
    """η in Pa s that calms those waves of a solid in a fluid which a step of the fluid does not resolve."""
    share = impedance(speeds, number, table)
    return calming_viscosity(table.young, table.poisson, share, step_of_fluid(speeds))


def step_of_fluid(speeds: Speeds) -> float:
    """The longest step of the fluid, s."""
    time = speeds.layout.case.time
    return time.step or time.cfl * speeds.layout.smoothing_length / speeds.sound_speed
