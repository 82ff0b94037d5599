"""What effects say that they conserve, on hand-made particles and in a box of two fluids.

The claims stand at the effects themselves, as ``conserves``.
"""

import json
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from jobs import clean_environment
from physics.pairs import ONE_FOR_ALL, H, pair_of, sums_of, view
from physics.test_effects import made
from remedies import ENTRIES, remedy, using
from simulation.test_absence import calling_for

from psph.acts import FLUIDS, acts_on
from psph.composition.terms import displacement, push, radial, shear
from psph.fields import filled
from psph.physics.damping.acoustic import ByL, CorrectedDamper, VolumeDamper
from psph.physics.damping.reconstructed import DampingToEdges
from psph.physics.fluid.apparent import ApparentFriction, CentralApparentFriction, FluidAlone
from psph.physics.fluid.correction import VolumeCorrection
from psph.physics.fluid.friction import Apparent, CorrectedRub, Rub
from psph.physics.fluid.parting import Parting
from psph.physics.fluid.rheology import Granular, HerschelBulkley, Newtonian
from psph.physics.fluid.several import (
    CorrectedVolumeBackground,
    Mirroring,
    VolumeBackground,
    VolumeContinuity,
    VolumePressure,
)
from psph.physics.fluid.viscosity import (
    CentralNewtonianFriction,
    ImpactDamping,
    NewtonianFriction,
    PairDamping,
)
from psph.physics.fluid.weight import Steady
from psph.physics.gas.pressure import GasPressure, OfUnlikeMasses
from psph.physics.gas.shocks import KernelViscosity
from psph.physics.gas.softening import ChangingSoftening
from psph.physics.order.potential import (
    InDisorder,
    LocalPotential,
    OwnRoughness,
    StrongerInTension,
    neutral_potential,
)
from psph.physics.order.shifting import LatticeShift
from psph.physics.order.stress import NeighbourStress
from psph.physics.surface.contact import AtAngle, AtRememberedAngle, ContactAngle, ContactLine, HeldByWalls
from psph.physics.surface.tension import Blunt, SurfaceTension, TensionAmong, TensionOfOne, Tensions
from psph.smoothing import kernel

MOMENTUM, ANGULAR = "momentum", "angular momentum"
LAWS = (
    Newtonian(),
    HerschelBulkley(5.0, 0.3, 0.7, 0.1, 200.0),
    Granular(0.38, 0.64, 0.28, 1e-3, 2500.0, 1e-3, 50.0),
)
"""Of viscosities that differ between the particles of a crowd."""

DRIFT = 1e-13
"""Largest change of a momentum in a box, relative to that of one of its fluids."""


BLUNT = Blunt(1e9, 1.0 / (4.0 * H * H), 1.0, H)
AMONG = TensionAmong(0.1, 0.1, BLUNT, 1.0, (Tensions(0.3, (0.0, 0.5)),) * 3, (1.0, 2.0), (1.0, 1.0), 1.8)
"""Tension of the fluids of a crowd, the first of which has two particles."""

AT_WALLS = (ContactLine, ContactAngle, AtRememberedAngle)

IN_VOLUMES = (VolumePressure, VolumeCorrection, VolumeBackground, CorrectedVolumeBackground)
"""What several fluids feel in place of the forms of one."""


def claiming(what):
    """The effects of the catalogue that say that they conserve it."""
    return [e.effect for e in ENTRIES if what in getattr(e.effect, "conserves", ())]


def in_a_scene(effect, dim):
    """The form that acts in a scene: some effects of the catalogue are but their parameters."""
    forms = {
        "ApparentViscosity": lambda: ApparentFriction(LAWS, 1.0, FluidAlone(), Rub(Apparent())),
        "CentralFriction": CentralNewtonianFriction,
        "CorrectedRub": lambda: NewtonianFriction(CorrectedRub()),
        "LaminarViscosity": NewtonianFriction,
        "PairPotential": lambda: potential_of_unequal(dim),
        "ArtificialStress": lambda: NeighbourStress(0.2, 1e-4),
        "CentralApparentFriction": lambda: CentralApparentFriction(LAWS, 1.0, FluidAlone()),
        "PositionShift": lambda: LatticeShift(0.1, -1e-4, 1e-6),
        "VolumePressure": lambda: VolumePressure(Parting(), Mirroring(Steady((None,) * (dim - 1) + (-9.8,)))),
        "VolumeCorrection": lambda: VolumeCorrection(0.5, 1e-6, Mirroring(Steady((None,) * dim)), Parting()),
        "CorrectedVolumeBackground": lambda: CorrectedVolumeBackground(
            3000.0, Mirroring(Steady((None,) * dim))
        ),
        "VolumeBackground": lambda: VolumeBackground(3000.0),
        "VolumeDamper": lambda: VolumeDamper(0.3, Mirroring(Steady((None,) * dim)), ByL()),
        "ReconstructedDamping": lambda: DampingToEdges(0.3, 1e-4, 0.2),
        "SurfaceTension": lambda: TensionOfOne(0.1, 0.1, BLUNT, 1.0),
        "TensionAmong": lambda: AMONG,
        "ContactLine": lambda: HeldByWalls(0.1, BLUNT, 1.0),
        "ContactAngle": lambda: AtAngle(0.1, 0.3, BLUNT, 1.0, 1e9),
        "AtRememberedAngle": lambda: AtRememberedAngle(0.1, 0.3, BLUNT, 1.0, 1e9),
        "GasPressure": lambda: GasPressure(OfUnlikeMasses(kernel("wendland-c2", 1.0, dim))),
        "ShockViscosity": lambda: KernelViscosity(1.0, 2.0, kernel("wendland-c2", 1.0, dim)),
        "ChangingSoftening": lambda: ChangingSoftening(kernel("wendland-c2", 1.0, dim)),
        "LocalPotential": lambda: StrongerInTension(
            InDisorder(*neutral_potential(0.5, 50.0, 0.01, dim), OwnRoughness(12.5)), 3.0, 0.02
        ),
    }
    return forms.get(effect.__name__, lambda: made(effect, dim))()


def potential_of_unequal(dim):
    """The pair potential of a scene of several masses."""
    several = [SimpleNamespace(mass=mass) for mass in (1.0, 2.0)]
    scene = SimpleNamespace(species=several, sound_speed=50.0, spacing=0.01, dimensions=dim)
    return remedy("PairPotential")(0.5).in_scene(scene)


def test_the_two_ends_of_a_pair_differ_in_all_that_a_formula_reads():
    for name, entry in view(dim=3)._asdict().items():
        components = entry if isinstance(entry, tuple) else (entry,)
        assert all(x is not None for x in components), name
        alike = all(np.ndim(x) == 0 or x[0] == x[1] for x in components)
        assert alike == (name in ONE_FOR_ALL), name


def crowd(dim):
    """Three fluid particles that differ in everything and run into each other."""
    p = view(n=3, dim=dim)
    inward = tuple(u - 3000.0 * x for u, x in zip(p.velocity, p.position))
    p = p._replace(fluid=np.array([1.0, 2.0, 1.0]))
    return p._replace(is_fluid=np.ones(3), rubs=np.ones(3), mobile=np.ones(3), velocity=inward)


def rates(effect, p):
    """Forces (n, dim) N on particles that all are neighbours, and where the effect moves them, m/s."""
    n, dim = len(p.mass), len(p.position)
    if fields := filled(effect):
        values = np.array([sums_of(effect, p, k) for k in range(n)]).T
        ends = np.cumsum([field.width(dim) for field in fields])
        for field, rows in zip(fields, np.split(values.reshape(ends[-1], n), ends[:-1])):
            p = p._replace(**{field.name: tuple(rows) if field.composed else rows[0]})
    forces, moves = np.zeros((n, dim)), np.zeros((n, dim))
    for a in range(n):
        for b in set(range(n)) - {a}:
            i, j, pair = pair_of(p, a, b)
            along, drag = radial((effect,), i, j, pair), shear((effect,), i, j, pair)
            forces[a] += (along or 0.0) * np.array(pair.x_ij) + (drag or 0.0) * np.array(pair.u_ij)
            forces[a] += np.array(push((effect,), i, j, pair) or (0.0,) * dim)
        forces[a] *= p.mass[a]
        moves[a] = displacement((effect,), i, 1.0)
    return forces, moves


@pytest.mark.parametrize("dim", (1, 2, 3))
@pytest.mark.parametrize(
    "effect",
    [
        *claiming(MOMENTUM),
        CorrectedRub,
        CorrectedDamper,
        VolumeDamper,
        TensionAmong,
        AtRememberedAngle,
        *IN_VOLUMES,
        ChangingSoftening,
    ],
)
def test_forces_between_different_particles_sum_up_to_nothing(effect, dim):
    p = crowd(dim)
    if effect in AT_WALLS:
        p = p._replace(is_fluid=np.array([1.0, 0.0, 1.0]))
    forces, moves = rates(in_a_scene(effect, dim), p)
    point = dim == 1 and effect in (SurfaceTension, TensionAmong, *AT_WALLS)  # it has no tension
    assert np.abs(forces).max() + np.abs(moves).max() > 0.0 or point
    assert np.abs(forces.sum(axis=0)).max() <= 1e-13 * np.abs(forces).max()


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize(
    "effect",
    [*claiming(ANGULAR), CentralApparentFriction, VolumePressure, VolumeBackground, ChangingSoftening],
)
def test_torques_between_different_particles_sum_up_to_nothing(effect, dim):
    p = crowd(dim)
    forces, moves = rates(in_a_scene(effect, dim), p)
    turned = np.einsum("kn,nl->kl", p.position, forces)
    turned += np.einsum("nk,ln,n->kl", moves, p.velocity, p.mass)  # d/dt Σ m x u of the move
    assert np.abs(turned).max() > 0.0
    assert np.abs(turned - turned.T).max() <= 1e-12 * np.abs(turned).max()


@pytest.mark.parametrize("own, other", ((1.0, 1000.0), (1000.0, 1.0)))
@pytest.mark.parametrize("effect", (PairDamping, ImpactDamping, LocalPotential))
def test_no_numerical_force_is_stronger_beside_another_fluid_than_in_ones_own(effect, own, other):
    """So air beside water is not blown up, and the limits of the time step hold; water hardly feels air."""
    one, volume, strengths = in_a_scene(effect, 2), 1e-4, {}
    for beside in (own, other):
        rho = np.array([own, beside])
        p = crowd(2)._replace(rest_density=rho, specific_volume=1.0 / rho, mass=volume * rho)
        strengths[beside] = abs(one.radial(*pair_of(p, 0, 1)))
    assert strengths[own] > 0.0
    assert strengths[other] == pytest.approx(min(1.0, other / own) * strengths[own], rel=1e-12)


IN_PLAIN_PYTHON = """
import json, sys
from pathlib import Path
from physics.test_conservation import after_steps

for line in sys.stdin:
    print(json.dumps(after_steps(Path(sys.argv[1]), *json.loads(line))), flush=True)
"""

BOX = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.1, periodic = ["x", "y"], lower = [0.0, 0.0], upper = [1.2, 0.8] }
physics.sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.8] }
jitter = 0.2
velocity = [0.5, 0.1]
[fluids.oil]
shape.box = { lower = [0.6, 0.0], upper = [1.2, 0.8] }
density = %r
jitter = 0.2
seed = 2
velocity = [-0.5, 0.2]
"""


BETWEEN = {"SurfaceTension": ["fluids.water.interfacial_tension={oil=5.0}"]}
"""What some ask of two fluids."""


def after_steps(folder, scheme, density, overrides, steps=4):
    """Momentum (2,) of a box of two fluids before and after some steps, and what the effects claim."""
    from drafts import draft
    from mpi4py import MPI

    from psph.output.ledger import Ledger
    from psph.runs.setup import create_particles
    from psph.scene import Scene
    from psph.simulation.plan import make_plan
    from psph.simulation.step import Simulation

    scene = Scene(draft(folder, f'scheme = "{scheme}"' + BOX % density, *overrides))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)

    def momentum():
        return (store.owned_rows("mass") @ store.owned_rows("velocity")).tolist()

    before = momentum()
    box = Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())
    for _ in range(steps):
        box.step()
    claims = {type(e).__name__: list(getattr(e, "conserves", ())) for e in plan.effects}
    return before, momentum(), claims


def boxes():
    """For each effect that claims momentum a box with it, and whole schemes: name, arguments."""
    for entry in ENTRIES:
        effect = entry.effect
        fits = FLUIDS in acts_on(effect) and effect not in AT_WALLS
        if fits and MOMENTUM in getattr(effect, "conserves", ()):
            overrides = [
                o for text in calling_for(entry) for o in (text, text.replace("fluids.water", "fluids.oil"))
            ]
            overrides += BETWEEN.get(effect.__name__, [])
            yield effect.__name__, ("sph", 800.0, [*using(effect), *sorted(set(overrides))])
    yield "the stable scheme", ("stable", 800.0, [])
    yield "the stable scheme, a light fluid", ("stable", 200.0, [])


def test_two_fluids_in_a_box_keep_their_momentum(tmp_path):
    """In plain Python: it takes a fraction of the time that compiling every effect would."""
    named = dict(boxes())
    job = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", IN_PLAIN_PYTHON, tmp_path],
        capture_output=True,
        text=True,
        input="\n".join(map(json.dumps, named.values())),
        env=clean_environment() | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert job.returncode == 0, job.stderr
    drifts = {}
    for name, line in zip(named, job.stdout.splitlines(), strict=True):
        before, after, claims = json.loads(line)
        assert sum(MOMENTUM in claim for claim in claims.values()) >= 1
        drifts[name] = np.abs(np.subtract(after, before)).max() / 240.0  # kg m/s of the water
    assert len(drifts) > 15
    assert {name: d for name, d in drifts.items() if not d < DRIFT} == {}


@pytest.mark.parametrize("dim", (1, 2, 3))
@pytest.mark.parametrize("beside_a_wall", (False, True))
def test_pressure_of_several_fluids_does_the_work_that_compression_takes(dim, beside_a_wall):
    """Σ m a·u + Σ m p/ρ² dρ/dt = 0 over three fluids of 1000 : 100 : 1, and with a wall that continues one."""
    p = crowd(dim)._replace(rest_density=np.array([1000.0, 100.0, 1.0]))
    p = p._replace(specific_volume=1.0 / (p.rest_density * np.array([1.01, 0.98, 1.03])))
    p = p._replace(mass=0.97e-4 / p.specific_volume, pressure=np.array([700.0, 900.0, 400.0]))
    if beside_a_wall:
        p = p._replace(is_fluid=np.array([1.0, 1.0, 0.0]), rest_density=np.array([1000.0, 100.0, 1000.0]))
    facing = Mirroring(Steady((None,) * dim))
    for force, compressed in (
        (VolumePressure(Parting(), facing), VolumeContinuity(facing)),
        (VolumeCorrection(0.5, 1e-6, facing, Parting()), VolumeCorrection(0.5, 1e-6, facing, Parting())),
    ):
        work = taken = 0.0
        for a in range(3):
            for b in {0, 1, 2} - {a}:
                i, j, pair = pair_of(p, a, b)
                pushed = (radial((force,), i, j, pair) or 0.0) * np.array(pair.x_ij)
                pushed = pushed + np.array(push((force,), i, j, pair) or (0.0,) * dim)
                work += p.mass[a] * pushed @ np.array(i.velocity)
                rate = compressed.density_rate(i, j, pair)
                taken += p.mass[a] * p.pressure[a] * p.specific_volume[a] ** 2 * rate
        assert abs(taken) > 0.0 and work == pytest.approx(-taken, rel=1e-12)
