"""The loop that is composed from effects against the same sums written out by hand, and its instructions."""

import re

import numba
import numpy as np
import pytest
from mpi4py import MPI
from numba.core.codegen import JITCodeLibrary
from runs.resuming import fill_records

from psph.composition.space import softened
from psph.engine.jit import FAST, register_bits
from psph.engine.lean import Library
from psph.engine.simd import spread, total, turning, width_of
from psph.lab.bench import DAM
from psph.lab.bench.box import FluidBox
from psph.lab.bench.measure import LAYOUTS, BenchProblem, scene_of
from psph.lab.bench.price import DEFAULT, SETTINGS, USUAL
from psph.output.ledger import Ledger
from psph.physics.fluid.viscosity import ArtificialViscosity
from psph.scene import Scene
from psph.simulation import pair_loops as loops_module
from psph.simulation import pairs
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

READ = 8
"""Numbers of a neighbour: position, velocity, pressure, 1/ρ."""

turn = turning(READ)


def by_hand(
    first,
    last,
    records,
    low,
    begin,
    lengths,
    lists,
    x,
    y,
    z,
    u,
    v,
    w,
    pressure,
    volume,
    m,
    h,
    c,
    alpha,
    beta,
    inverse_h,
    kernel_alpha,
    softening,
    ax,
    ay,
    az,
    rate,
):
    """Continuity, symmetric pressure and artificial viscosity with Wendland's C2 in an open box."""
    front, half = -5.0 * kernel_alpha * inverse_h * inverse_h * m, 0.5 * inverse_h
    eta, ac, bh = 0.01 * h * h, alpha * c, beta * h
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        x_i, y_i, z_i, u_i, v_i, w_i, p_i, q_i = (x[k], y[k], z[k], u[k], v[k], w[k], pressure[k], volume[k])
        own = p_i * q_i * q_i
        sx, sy, sz = spread(0.0, records), spread(0.0, records), spread(0.0, records)
        sr = spread(0.0, records)
        end = begin[row] + np.uint64(lengths[row])
        for n in range(begin[row], end, width_of(records)):
            j = turn(records, lists, n)
            dx, dy, dz = x_i - j[0], y_i - j[1], z_i - j[2]
            du, dv, dw = u_i - j[3], v_i - j[4], w_i - j[5]
            p_j, q_j = j[6], j[7]
            r2 = dx * dx + dy * dy + dz * dz + softened(softening, end - n)
            approach = du * dx + dv * dy + dw * dz
            a = max(1.0 - np.sqrt(r2) * half, 0.0)
            g = front * (a * a * a)
            mu = min(approach, 0.0) / ((r2 + eta) * (q_i + q_j))
            friction = 2.0 * h * q_i * (q_j * mu) * (ac - bh * ((q_i + q_j) * mu))
            f = g * (friction - (own + p_j * q_j * q_j))
            sx, sy, sz = sx + f * dx, sy + f * dy, sz + f * dz
            sr = sr + g * approach
        ax[k], ay[k], az[k], rate[k] = total(sx), total(sy), total(sz), total(sr)


@pytest.fixture(scope="module")
def simulation():
    """A shifted 3D box in motion, its axes open as far as pairs are concerned."""
    scene = Scene(FluidBox.nearest(3, 57, 3000).case().model_copy(update={"precision": "double"}))
    open_box = scene.case.model_copy(update={"space": scene.case.space.model_copy(update={"periodic": ()})})
    scene = Scene(open_box)
    plan = make_plan(scene)
    simulation = Simulation(
        scene, plan, FluidBox.nearest(3, 57, 3000).create(scene, plan, MPI.COMM_SELF), MPI.COMM_SELF, Ledger()
    )
    for component in simulation.store["predicted_velocity"]:
        component[simulation.store.inner] = np.random.default_rng(1).uniform(
            -1.0, 1.0, simulation.store.owned
        )
    fill_records(simulation)
    return simulation


def call_by_hand(s: Simulation) -> tuple:
    """What ``by_hand`` takes; its last four arrays are filled."""
    store, lists, kernel = s.store, s.domain.lists, s.plan.kernel
    [friction] = [e for e in s.plan.effects if isinstance(e, ArtificialViscosity)]
    c = store.constants
    return (
        store.low,
        store.low + store.owned,
        s.engine.records[-1].table,
        store.low,
        lists.begin,
        lists.lengths,
        lists.lists,
        *store["position"],
        *store["predicted_velocity"],
        store["pressure"],
        store["specific_volume"],
        c["mass"],
        c["smoothing_length"],
        c["sound_speed"],
        friction.alpha,
        friction.beta,
        kernel.inverse_h,
        kernel.alpha,
        s.engine.softening,
        *(np.zeros_like(store["pressure"]) for _ in range(4)),
    )


def in_the_loop(code: str) -> int:
    """How many instructions the innermost loop with a root in it has."""
    return len(innermost(code))


def innermost(code: str) -> list[str]:
    """The instructions of the innermost loop with a root in it."""
    lines = [line.strip() for line in code.splitlines()]
    labels = {line[:-1]: n for n, line in enumerate(lines) if re.fullmatch(r"\.?L\w+:", line)}
    loops = []
    for n, line in enumerate(lines):
        jump = re.fullmatch(r"j\w+\s+(\.?L\w+)", line)
        if jump and labels.get(jump[1], n) < n:
            body = lines[labels[jump[1]] : n + 1]
            if any("sqrt" in one for one in body):
                loops.append([one for one in body if re.match(r"[a-z]", one)])
    return min(loops, key=len)


def test_composed_is_as_lean_as_by_hand_and_gives_the_same(simulation):
    options = {"fastmath": FAST, "error_model": "numpy"}
    hand, composed = numba.njit(**options)(by_hand), numba.njit(**options)(pairs.sum_over_neighbours.py_func)
    calls = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("psph.simulation.cpu.in_threads", lambda f, *call: calls.append((f, call)))
        store, last = simulation.store, simulation.plan.passes[-1]
        simulation.engine.sum_columns(last, store.low, store.low + store.owned)
    [(_, call)] = calls
    hand_call = call_by_hand(simulation)
    hand(*hand_call)
    composed(*call)
    inner = simulation.store.inner
    theirs = (*simulation.store["acceleration"], simulation.store["density_rate"])
    for ours, other in zip(hand_call[-4:], theirs):
        assert np.abs(other[inner]).max() > 0.0
        assert np.abs(ours - other)[inner].max() < 1e-12 * np.abs(other[inner]).max()
    [hand_code], [composed_code] = hand.inspect_asm().values(), composed.inspect_asm().values()
    lean, made = in_the_loop(hand_code), in_the_loop(composed_code)
    assert 60 < lean < 120 and made <= 1.05 * lean, (made, lean)


COUNTED = {
    512: {(2, USUAL): 105, (2, DEFAULT): 240, (3, USUAL): 112, (3, DEFAULT): 330},
    256: {(2, USUAL): 79, (2, DEFAULT): 291, (3, USUAL): 93, (3, DEFAULT): 398},
}
"""Instructions that a group of neighbours takes, as many as a register holds numbers, by its bits:
dam breaks in 2D and 3D under plain SPH and under the default scheme."""


MIDWAY = {512: {2: 140, 3: 186}, 256: {2: 142, 3: 176}}
"""The same of the pass at the middle of a step of the default scheme, for what moves freely, by dimension."""


ASTRAY = {512: {DEFAULT}, 256: {USUAL, DEFAULT}}
"""Whose loops, as numba compiles them, cross a cache line on their way to the stack: with 16 registers, as
256 bits bring them, plain SPH too."""


REGISTERS = {512: "zmm", 256: "ymm"}
"""How assembly calls the widest registers, by their bits."""


@pytest.mark.parametrize(("dim", "setting"), COUNTED[512])
def test_the_standard_loops_take_no_more_instructions_than_counted(dim, setting, monkeypatch):
    """What the pace rests on, and what no other job on the machine can change.  What goes to the stack and
    back does so within a cache line: without psph.engine.lean it would not."""
    calls = []
    monkeypatch.setattr(loops_module, "sum_over_neighbours", lambda *call: calls.append(call))
    neighbours = {2: 20, 3: 57}[dim]
    layout = LAYOUTS[DAM](dim, neighbours, 1500)
    scene = scene_of(BenchProblem(DAM, dim, 1500, neighbours, "double"), layout, SETTINGS[setting])
    plan = make_plan(scene)
    store = layout.create(scene, plan, MPI.COMM_SELF)
    Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())  # its start sums once: types suffice
    [pushed, *_] = [call for call in calls if call[-1].acceleration is not None]
    code = compiled_for(pushed)
    made = in_the_loop(code)
    counted = COUNTED[register_bits()]
    if setting == DEFAULT:
        free = [
            call for call in calls if call[-1].acceleration is None and call[2].effects == plan.midway.on_free
        ]
        assert 100 < in_the_loop(compiled_for(free[0])) <= MIDWAY[register_bits()][dim]
    assert 50 < made <= counted[dim, setting], made
    kept = [one for one in innermost(code) if re.match(rf"vmov[au]p[sd].*{REGISTERS[register_bits()]}", one)]
    to_stack = [one for one in kept if re.search(r"%r[sb]p\)", one)]
    assert not [one for one in to_stack if one.startswith("vmovu")]
    with monkeypatch.context() as patch:  # the control: as numba does it
        patch.setattr(Library, "add_ir_module", JITCodeLibrary.add_ir_module)
        lines = innermost(compiled_for(pushed))
    astray = [one for one in lines if re.match(r"vmovu.*%rsp\)", one)]
    assert bool(astray) == (setting in ASTRAY[register_bits()])


def compiled_for(call) -> str:
    """The assembly of the pair loop for the arguments of a call."""
    loop = numba.njit(fastmath=FAST, error_model="numpy")(pairs.sum_over_neighbours.py_func)
    kinds = tuple(map(numba.typeof, call))
    loop.compile(kinds)
    return loop.inspect_asm(kinds)
