"""What a scene does not call for costs nothing: counted for every effect of the catalogue."""

import re
from typing import Literal, NamedTuple, get_origin, get_type_hints

import numba
import pytest
from drafts import SQUARE, draft
from long import long_but_for
from mpi4py import MPI

from psph.acts import IDEAL_GASES
from psph.engine.jit import FAST
from psph.output.ledger import Ledger
from psph.physics.catalogue import BUILT_IN, CATALOGUE, Entry
from psph.physics.solid.contact import SolidContact
from psph.runs.footprint import bytes_per_refresh
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation import pair_loops as loops_module
from psph.simulation import pairs
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

IN_PAIRS = {"density_rate", "radial", "shear", "push", "body", "start"}
"""Methods that the pair loop calls."""


class Loop:
    """The pair loop of this module's tests, compiled afresh and once for each type of a scene."""

    def __init__(self):
        self.loop = numba.njit(fastmath=FAST, error_model="numpy")(pairs.sum_over_neighbours.py_func)

    def signature(self, arguments):
        """The types of a call, compiled."""
        kinds = tuple(map(numba.typeof, arguments))
        self.loop.compile(kinds)
        return kinds

    def instructions(self, arguments) -> list[str]:
        """The instructions of a call, without their operands."""
        code = self.loop.inspect_asm(self.signature(arguments))
        operations = re.findall(r"^\s+([a-z][a-z0-9]+)\s", code, re.MULTILINE)
        return [op for op in operations if op not in ("movabsq", "leaq")]  # addresses of names


@pytest.fixture(scope="module")
def loop():
    return Loop()


class Footprint(NamedTuple):
    """What a scene's plan makes of the machine."""

    effects: set[type]
    calls: tuple
    arrays: tuple[str, ...]
    read: tuple[str, ...]
    halo: tuple[str, ...]
    sent: float


@pytest.fixture
def footprint(tmp_path, monkeypatch):
    """A function: (catalogue, overrides) → the Footprint of a plain square of fluid with them."""

    def make(catalogue, *overrides):
        calls = []
        monkeypatch.setattr(Simulation, "_start", lambda self: None)  # no step: types suffice
        monkeypatch.setattr(loops_module, "sum_over_neighbours", lambda *call: calls.append(call))
        scene = Scene(draft(tmp_path, SQUARE, *overrides))
        plan = make_plan(scene, BUILT_IN._replace(effects=tuple(catalogue)))
        store = create_particles(scene, plan, MPI.COMM_SELF)
        engine = Simulation(scene, plan, store, MPI.COMM_SELF, Ledger()).engine
        engine._fit_records()
        for one in plan.passes:
            engine.sum_columns(one, 0, store.owned)
        read = tuple(n for n, x in store.view()._asdict().items() if x is not None)
        halo = plan.refreshed + plan.ghost_fields
        effects = set(map(type, plan.effects))
        return Footprint(effects, tuple(calls), plan.arrays, read, halo, bytes_per_refresh(scene, plan, 2)[1])

    return make


def instructions(loop, footprint) -> int:
    """Of all passes together."""
    return sum(len(loop.instructions(call)) for call in footprint.calls)


def without(entry):
    """The catalogue before this effect existed."""
    return [other for other in CATALOGUE if other is not entry]


BEARS = ("DeviatoricForce", "Strength")
"""Effects of a stress that evolves, and cannot be without its rate."""

SOIL = (
    "soils.bank={shape={box={lower=[2.0,0.0],upper=[3.0,1.0]}}, density=1900.0, young=1e6, poisson=0.3, "
    "friction_angle=30.0, geostatic=false}"
)

TOGETHER = {
    "DeviatorRate": ("StressSlopes",),
    "ContactLine": ("ContactAngle",),
    "LineMemory": ("ContactAngle",),
    "SolidTurn": ("NoSlip",),
}
"""Effects that read what another writes, and are not there without it."""

BAR = "solids.bar={shape={box={lower=[2.0,0.0],upper=[3.0,1.0]}}, density=1900.0, young=1e6, poisson=0.3, no_slip=true}"

VISCOUS = "fluids.water.viscosity=0.001"

DRY = "walls.side={shape={box={lower=[-0.3,0.0],upper=[0.0,1.0]}}}"

STICKY = ("walls.side={shape={box={lower=[-0.3,0.0],upper=[0.0,1.0]}}, no_slip=true}", VISCOUS)
"""Overrides: a wall without slip, and the friction that it needs."""


CORRECTED = ("physics.gradient_correction=0.5",)

BESIDE = {
    "physics.central_friction": (VISCOUS,),
    "physics.laplacian_friction": (VISCOUS,),
    "physics.reconstructed_damping": CORRECTED,
    "physics.local_potential": CORRECTED,
    "physics.fourth_order_diffusion": CORRECTED,
}
"""What some effects need beside them."""


LARGER = {"in_tension": 3.0}
"""Values of keys that may not be as small as 0.1."""


def calling_for(entry) -> list[str]:
    """Overrides that call for the effect of an entry."""
    key, _, choice = entry.key.partition("|")[0].partition("=")
    if entry.effect.__name__ in ("ContactLine", "ContactAngle", "LineMemory"):
        slippery = STICKY[0].replace(", no_slip=true", "")
        angle = "{advancing=70.0,receding=50.0}" if entry.effect.__name__ == "LineMemory" else "60.0"
        return [slippery, "fluids.water.surface_tension=0.001", f"walls.side.contact_angle={angle}"]
    if key == "physics.wall_approach":
        return [DRY, f"{key}=2.2"]
    if key.startswith("walls."):
        return [*STICKY, *(["walls.side.no_slip=false", f"walls.side.condition={choice}"] if choice else [])]
    if choice:
        return [f"{key}={choice}"]
    if key == "fluids.*.rheology":
        return ["fluids.water.rheology.bingham={yield_stress=1.0, plastic_viscosity=0.1}"]
    if key == "soils.*":
        return [SOIL]
    if key.startswith("solids.*"):
        return [BAR, VISCOUS]
    if "*" in key:
        return [f"{key.replace('*', 'water')}=0.001"]
    if key == "frame.motion":
        return ["frame.motion={translation=[0.2, 0.2]}"]
    if key.endswith("damping_zone"):
        return [f"{key}={{begin=0.1, end=0.4}}"]
    hints = {n: hint for n, hint in get_type_hints(entry.effect).items() if get_origin(hint) is not Literal}
    values = {n: [0.1, 0.1] if get_origin(hint) is tuple else LARGER.get(n, 0.1) for n, hint in hints.items()}
    table = f"{key}={{{', '.join(f'{name}={value}' for name, value in values.items())}}}"
    return [table, *BESIDE.get(key, ())]


def not_calling_for(entry) -> list[str]:
    """Overrides of a scene that lacks the effect of an entry; none do where it is a choice."""
    key, _, choice = entry.key.partition("|")[0].partition("=")
    if "*" in key:
        return []
    others = [e.key for e in without(entry) if choice and e.key.startswith(f"{key}=")]
    return others[:1]


def name_of(entry):
    return entry.effect.__name__


SHORT = ("FreeSurface", "ArtificialViscosity", "PairDamping")
WET = [one for one in CATALOGUE if not one.key.startswith("anvils.") and one.effect is not SolidContact]
"""Anvils and contact are there for scenes of solids alone: tests/simulation/test_contact.py."""
OF_GASES = [one for one in CATALOGUE if getattr(one.effect, "acts", ()) == (IDEAL_GASES,)]
IN_SPACE = [one for one in CATALOGUE if one.key == "physics.self_gravity"]
READS_BACK = ("SmoothFace", "StressSlopes")
ALONE = [one for one in WET if one not in (*OF_GASES, *IN_SPACE) and one.effect.__name__ not in READS_BACK]
"""Without those of ideal gases, which are no fluid, those that need three dimensions
(tests/simulation/test_attraction.py), and those that a rate of stress reads and that read that stress."""

KEYED, ALL = (long_but_for(SHORT, entries, name_of) for entries in ([e for e in CATALOGUE if e.key], ALONE))


@pytest.mark.parametrize("entry", KEYED, ids=name_of)
def test_an_absent_effect_leaves_everything_as_it_was_before_it_existed(entry, footprint, loop):
    scene = not_calling_for(entry)
    after, before = footprint(CATALOGUE, *scene), footprint(without(entry), *scene)
    assert entry.effect not in after.effects
    assert after._replace(calls=()) == before._replace(calls=())
    assert [*map(loop.signature, after.calls)] == [*map(loop.signature, before.calls)]  # the very same code


@pytest.mark.parametrize("entry", ALL, ids=name_of)
def test_a_present_effect_costs_instructions(entry, footprint, loop):
    scene = calling_for(entry) if entry.key else []
    shared = () if entry.effect.__name__ != "DeviatorRate" else BEARS
    gone = TOGETHER.get(entry.effect.__name__, ())
    present = [e for e in CATALOGUE if e.effect.__name__ not in shared]
    absent = [e for e in present if e is not entry and e.effect.__name__ not in gone]
    on, off = (footprint(catalogue, *scene) for catalogue in (present, absent))
    added = on.effects - off.effects  # the effect, or its form for the scene, and those that go with it
    assert off.effects < on.effects and len(added) == 1 + len(gone)
    more = instructions(loop, on) - instructions(loop, off)
    assert more > 0 or not any(IN_PAIRS & vars(one).keys() for one in added)
    assert set(off.arrays) <= set(on.arrays) and set(off.read) <= set(on.read)
    assert on.sent >= off.sent


class Buoyancy(NamedTuple):
    """An effect that nobody asks for, and that reads what nobody else does."""

    strength: float = 1.0

    def radial(self, i, j, pair):
        """Something costly."""
        return self.strength * (i.viscosity + j.viscosity) * pair.w


def test_an_effect_of_its_own_costs_what_it_reads(footprint, loop):
    """Compiled afresh on both sides, with two fluids: instructions, arrays and messages."""
    oil = "fluids.oil={shape={box={lower=[2.0,0.0],upper=[3.0,1.0]}}, viscosity=1e-2}"
    longer = [*CATALOGUE, Entry("fluids.*.viscosity", Buoyancy)]
    absent, before = footprint(longer), footprint(CATALOGUE)
    [there], [here] = absent.calls, before.calls
    assert Loop().instructions(there) == loop.instructions(here)
    assert absent.sent == before.sent and absent.arrays == before.arrays
    plain = CATALOGUE[:3]
    on, off = footprint([*plain, longer[-1]], oil), footprint(plain, oil)
    assert instructions(loop, on) > instructions(loop, off)
    assert set(on.arrays) - set(off.arrays) == {"viscosity"}
    assert set(on.halo) - set(off.halo) == {"viscosity"}
