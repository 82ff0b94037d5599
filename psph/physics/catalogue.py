"""Every effect, and the key of a case that switches it on.  A new effect is one line here."""

import sys
from functools import cache
from types import FunctionType
from typing import NamedTuple

from psph.fields import OF_EVERY_SCENE, OF_MATERIAL, OF_SCENE, Field, by_name, filled, fixed
from psph.physics.damping.acoustic import AcousticDamper
from psph.physics.damping.diffusion import DensityDiffusion, FourthOrderDiffusion
from psph.physics.damping.reconstructed import ReconstructedDamping
from psph.physics.fluid.absorbing import DampingZone, OtherDampingZone
from psph.physics.fluid.apparent import ApparentViscosity
from psph.physics.fluid.continuity import Continuity
from psph.physics.fluid.correction import GradientCorrection
from psph.physics.fluid.frame import MovingFrame
from psph.physics.fluid.gravity import CentralForce, Gravity
from psph.physics.fluid.pressure import (
    BackgroundPressure,
    DifferencePressure,
    MinimumPressure,
    SymmetricPressure,
    TensileControl,
)
from psph.physics.fluid.state import Linear, Tait
from psph.physics.fluid.summation import SummationDensity
from psph.physics.fluid.viscosity import (
    ArtificialViscosity,
    CentralFriction,
    ImpactDamping,
    LaminarViscosity,
    LaplacianFriction,
    PairDamping,
)
from psph.physics.gas.conduction import HeatConduction
from psph.physics.gas.heat import GasHeat
from psph.physics.gas.pressure import GasPressure
from psph.physics.gas.shocks import FastestSignal, ShockViscosity
from psph.physics.gas.softening import SofteningChange
from psph.physics.gas.switch import FlowOfGas
from psph.physics.order.potential import LocalPotential
from psph.physics.order.shifting import ParticleShifting, PositionShift
from psph.physics.order.stress import ArtificialStress
from psph.physics.self_gravity import SelfGravity, WholeAttraction
from psph.physics.solid.anvil import Anvils
from psph.physics.solid.contact import SolidContact
from psph.physics.solid.rubber import MooneyRivlin, Ogden
from psph.physics.solid.turn import SolidTurn
from psph.physics.stress.deviator import DeviatoricForce, DeviatorRate
from psph.physics.stress.faces import SmoothFace
from psph.physics.stress.spreading import StressSlopes
from psph.physics.stress.strength import Strength
from psph.physics.surface.contact import ContactAngle, ContactLine
from psph.physics.surface.free import FreeSurface, TensionFloor
from psph.physics.surface.hysteresis import LineMemory
from psph.physics.surface.tension import SurfaceTension
from psph.physics.walls.approach import WallApproach
from psph.physics.walls.conditions import EXTRAPOLATED, PENALTY, REPULSIVE
from psph.physics.walls.dry import DryWall
from psph.physics.walls.extrapolated import ExtrapolatedWall
from psph.physics.walls.penalty import PenaltyWall
from psph.physics.walls.repulsive import RepulsiveWall
from psph.physics.walls.slip import NoSlip


class Entry(NamedTuple):
    """An effect and what switches it on.

    ``key`` is empty (every scene), a key of the case (present: the effect is on, and its value
    holds the effect's parameters), or ``key=name`` for one of several choices, the first of which
    is the default.  ``*`` stands for any name, and ``|`` between two keys for either.
    """

    key: str
    effect: type


class Catalogue(NamedTuple):
    """Everything that a case can ask for."""

    effects: tuple[Entry, ...] = ()
    states: tuple[Entry, ...] = ()
    """Equations of state."""
    motions: tuple[Entry, ...] = ()
    """Ways in which a wall moves, ``walls.*.motion.NAME``: psph.physics.motion."""
    regions: tuple[Entry, ...] = ()
    """Where particles appear or vanish, ``regions.*.NAME``: psph.physics.region."""
    kernels: tuple[Entry, ...] = ()
    """Smoothing kernels beside those of psph.smoothing, ``space.kernel=NAME``."""
    tables: tuple[Entry, ...] = ()
    """Tables of numbers that a run writes as NAME.csv, ``tables.NAME``: psph.runs.record."""
    kinds: tuple[Entry, ...] = ()
    """Kinds of matter beside those of psph, ``KIND.*``: psph.kinds."""
    laws: tuple[Entry, ...] = ()
    """Laws of elasticity, ``solids.*.hyperelastic.NAME``: psph.physics.solid.rubber."""

    def with_more(self, other: "Catalogue") -> "Catalogue":
        """All that either of two offers."""
        return Catalogue(*(one + more for one, more in zip(self, other)))

    @property
    def fields(self) -> dict[str, Field]:
        """Every field that a particle can carry, by name: those of the step, and of each effect."""
        return _fields(tuple(entry.effect for entry in self.effects))


@cache
def methods_of_effects() -> frozenset[str]:
    """Names of the methods that effects have: those of psph's own, and of their forms in the same rooms,
    which share a method with one of them."""
    rooms = {entry.effect.__module__ for entry in CATALOGUE}
    known = {name for entry in CATALOGUE for name in methods(entry.effect)}
    kinds = (kind for room in rooms for kind in vars(sys.modules[room]).values() if isinstance(kind, type))
    forms = (methods(kind) for kind in kinds if kind.__module__ in rooms)
    return frozenset(known.union(*(own for own in forms if known.intersection(own))))


def methods(kind: type) -> list[str]:
    """The public methods that a class defines itself."""
    own = (name for name, value in vars(kind).items() if isinstance(value, (FunctionType, staticmethod)))
    return [name for name in own if not name.startswith("_")]


@cache
def _fields(effects: tuple[type, ...]) -> dict[str, Field]:
    written = [field for effect in effects for field in (*filled(effect), *fixed(effect))]
    more = [getattr(e, of) for e in effects for of in ("marks", "remembers") if hasattr(e, of)]
    return by_name(OF_EVERY_SCENE, OF_MATERIAL, OF_SCENE, written, more)


CATALOGUE = (
    Entry("", Continuity),
    Entry("physics.pressure_gradient=symmetric", SymmetricPressure),
    Entry("physics.pressure_gradient=minimum", MinimumPressure),
    Entry("physics.pressure_gradient=difference", DifferencePressure),
    Entry("physics.pressure_gradient=tensile_control", TensileControl),
    Entry("physics.artificial_stress", ArtificialStress),
    Entry("soils.*|solids.*.description=updated", DeviatorRate),
    Entry("soils.*|solids.*.description=updated", DeviatoricForce),
    Entry("soils.*|solids.*.description=updated", SmoothFace),
    Entry("soils.*", StressSlopes),
    Entry("soils.*", Strength),
    Entry("fluids.*.viscosity", LaminarViscosity),
    Entry("physics.central_friction", CentralFriction),
    Entry("physics.laplacian_friction", LaplacianFriction),
    Entry("fluids.*.rheology", ApparentViscosity),
    Entry("fluids.*.surface_tension|fluids.*.interfacial_tension", SurfaceTension),
    Entry("fluids.*.surface_tension|fluids.*.interfacial_tension", ContactLine),
    Entry("walls.*.contact_angle", LineMemory),
    Entry("walls.*.contact_angle", ContactAngle),
    Entry("walls.*.no_slip|solids.*.no_slip", NoSlip),
    Entry("solids.*.no_slip", SolidTurn),
    Entry("walls.*.continues", DryWall),
    Entry(f"walls.*.condition={EXTRAPOLATED}", ExtrapolatedWall),
    Entry(f"walls.*.condition={REPULSIVE}", RepulsiveWall),
    Entry(f"walls.*.condition={PENALTY}", PenaltyWall),
    Entry("physics.artificial_viscosity", ArtificialViscosity),
    Entry("physics.pair_damping", PairDamping),
    Entry("physics.reconstructed_damping", ReconstructedDamping),
    Entry("physics.acoustic_damper", AcousticDamper),
    Entry("physics.impact_damping", ImpactDamping),
    Entry("physics.local_potential", LocalPotential),
    Entry("physics.gravity", Gravity),
    Entry("physics.central_force", CentralForce),
    Entry("physics.self_gravity", SelfGravity),
    Entry("physics.self_gravity", WholeAttraction),
    Entry("physics.self_gravity", SofteningChange),
    Entry("physics.damping_zone", DampingZone),
    Entry("physics.other_damping_zone", OtherDampingZone),
    Entry("frame.motion", MovingFrame),
    Entry("ideal_gases.*", GasPressure),
    Entry("physics.shock_viscosity", ShockViscosity),
    Entry("ideal_gases.*", FlowOfGas),
    Entry("physics.heat_conduction", HeatConduction),
    Entry("ideal_gases.*", GasHeat),
    Entry("ideal_gases.*", FastestSignal),
    Entry("anvils.*", Anvils),
    Entry("physics.contact", SolidContact),
    Entry("physics.free_surface", FreeSurface),
    Entry("physics.tension_floor", TensionFloor),
    Entry("physics.wall_approach", WallApproach),
    Entry("physics.background_pressure", BackgroundPressure),
    Entry("physics.density_diffusion", DensityDiffusion),
    Entry("physics.fourth_order_diffusion", FourthOrderDiffusion),
    Entry("physics.summation_density", SummationDensity),
    Entry("physics.particle_shifting", ParticleShifting),
    Entry("physics.position_shift", PositionShift),
    Entry("physics.gradient_correction", GradientCorrection),
)

EQUATIONS_OF_STATE = (
    Entry("physics.equation_of_state=linear", Linear),
    Entry("physics.equation_of_state=tait", Tait),
)

ELASTIC_LAWS = (
    Entry("solids.*.hyperelastic.mooney_rivlin", MooneyRivlin),
    Entry("solids.*.hyperelastic.ogden", Ogden),
)

BUILT_IN = Catalogue(CATALOGUE, EQUATIONS_OF_STATE)
