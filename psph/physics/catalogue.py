"""Every effect and the key of a case that calls for it.  A new effect is one line here."""

from typing import NamedTuple

from psph.physics.continuity import Continuity
from psph.physics.correction import GradientCorrection
from psph.physics.diffusion import DensityDiffusion
from psph.physics.filtering import ConservativeSmoothing
from psph.physics.gravity import CentralForce, Gravity
from psph.physics.potential import PairPotential
from psph.physics.pressure import (
    BackgroundPressure, DifferencePressure, MinimumPressure, SymmetricPressure, TensileControl,
)
from psph.physics.riemann import RiemannDissipation
from psph.physics.shifting import ParticleShifting, PositionShift
from psph.physics.slip import NoSlip
from psph.physics.state import Linear, Tait
from psph.physics.stress import ArtificialStress
from psph.physics.stress_points import StressPoints
from psph.physics.surface import FreeSurface, TensionFloor
from psph.physics.transport import GeneralisedTransportVelocity, TransportVelocity, XSPH
from psph.physics.viscosity import (
    ArtificialViscosity, CentralFriction, ImpactDamping, LaminarViscosity, PairDamping,
)
from psph.physics.walls import DryWall


class Entry(NamedTuple):
    """An effect and what calls for it.

    ``key`` is empty (every scene), a key of the case (present: the effect is on, and its value
    holds the effect's parameters), or ``key=name`` for one of several choices, the first of which
    is the default.  ``*`` stands for any name.
    """

    key: str
    effect: type


CATALOGUE = (
    Entry("", Continuity),
    Entry("physics.pressure_gradient=symmetric", SymmetricPressure),
    Entry("physics.pressure_gradient=minimum", MinimumPressure),
    Entry("physics.pressure_gradient=difference", DifferencePressure),
    Entry("physics.pressure_gradient=tensile_control", TensileControl),
    Entry("physics.pressure_gradient=stress_points", StressPoints),
    Entry("physics.artificial_stress", ArtificialStress),
    Entry("fluids.*.viscosity", LaminarViscosity),
    Entry("physics.central_friction", CentralFriction),
    Entry("walls.*.no_slip", NoSlip),
    Entry("walls.*.continues", DryWall),
    Entry("physics.artificial_viscosity", ArtificialViscosity),
    Entry("physics.pair_damping", PairDamping),
    Entry("physics.impact_damping", ImpactDamping),
    Entry("physics.riemann_dissipation", RiemannDissipation),
    Entry("physics.conservative_smoothing", ConservativeSmoothing),
    Entry("physics.pair_potential", PairPotential),
    Entry("physics.gravity", Gravity),
    Entry("physics.central_force", CentralForce),
    Entry("physics.free_surface", FreeSurface),
    Entry("physics.tension_floor", TensionFloor),
    Entry("physics.background_pressure", BackgroundPressure),
    Entry("physics.density_diffusion", DensityDiffusion),
    Entry("physics.particle_shifting", ParticleShifting),
    Entry("physics.position_shift", PositionShift),
    Entry("physics.xsph", XSPH),
    Entry("physics.transport_velocity", TransportVelocity),
    Entry("physics.generalised_transport_velocity", GeneralisedTransportVelocity),
    Entry("physics.gradient_correction", GradientCorrection),
)

EQUATIONS_OF_STATE = (
    Entry("physics.equation_of_state=linear", Linear),
    Entry("physics.equation_of_state=tait", Tait),
)
