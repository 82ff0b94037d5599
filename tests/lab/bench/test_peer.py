"""LAMMPS beside psph; its own words are tested without it."""

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from jobs import clean_environment

from psph.lab.bench import lammps_solid
from psph.lab.bench.block import Block
from psph.lab.bench.box import FluidBox
from psph.lab.bench.falling import Falling
from psph.lab.bench.lammps_fluid import commands, gathered
from psph.lab.bench.measure import BenchProblem, measure
from psph.lab.bench.peer import Peer, Processes
from psph.lab.bench.roofline import Ceiling
from psph.lab.bench.tank import Tank
from psph.lab.errors import BenchError
from psph.output.ledger import Ledger
from psph.parallel.reductions import alone
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

OWN_ENVIRONMENT = Path(__file__).parents[3] / "build/peers/environment/bin/python"
"""Where run/peers puts LAMMPS."""


@pytest.fixture
def python():
    """An interpreter that has LAMMPS."""
    if OWN_ENVIRONMENT.exists():
        return OWN_ENVIRONMENT
    pytest.importorskip("lammps")
    return Path(sys.executable)


def simulation_of(layout):
    scene = Scene(layout.case())
    plan = make_plan(scene)
    return scene, Simulation(scene, plan, layout.create(scene, plan, alone()), alone(), Ledger())


def test_a_box_in_its_words():
    layout = FluidBox.nearest(2, 20, 400)
    scene, simulation = simulation_of(layout)
    simulation.step()
    said = sum(commands(scene, simulation), [])
    support = 2.0 * scene.smoothing_length
    assert "boundary p p p" in said and "dimension 2" in said and "fix flat all enforce2d" in said
    assert f"pair_coeff * * 1000.0 50.0 0.05 {support!r}" in said  # α h is the same
    assert f"timestep {0.5 * simulation.dt!r}" in said and simulation.dt > 0.0
    [mass] = [float(line.split()[2]) for line in said if line.startswith("mass")]
    assert mass == pytest.approx(1000.0 / layout.sides**2)
    assert not any("np." in line or "tank" in line or "gravity" in line for line in said)


def test_a_tank_in_its_words():
    scene, simulation = simulation_of(Tank.nearest(2, 20, 1500))
    said = sum(commands(scene, simulation), [])
    assert "boundary s s p" in said and "fix stay tank sph/stationary" in said
    assert "fix fall water gravity 9.81 vector 0.0 -1.0 0.0" in said
    assert not any("np." in line for line in said)


def test_several_ranks_balance_their_load():
    scene, simulation = simulation_of(Tank.nearest(2, 20, 1500))
    assert not any("balance" in line for line in sum(commands(scene, simulation), []))
    two = SimpleNamespace(plan=simulation.plan, dt=simulation.dt, comm=SimpleNamespace(size=2))
    space, motion = commands(scene, two)
    assert not any("balance" in line for line in space)  # there are no particles yet
    assert motion[-2:] == [
        "balance 1.05 shift xy 20 1.01",
        "fix even all balance 100 1.05 shift xy 20 1.01",
    ]


def test_its_cuts_follow_the_water(python):
    """The water stands in the first third of a tank; without balancing its second rank has walls alone."""
    scene, simulation = simulation_of(Tank.nearest(2, 20, 6000))
    two = SimpleNamespace(plan=simulation.plan, dt=simulation.dt or 1e-5, comm=SimpleNamespace(size=2))
    space, motion = commands(scene, two)
    processes = Processes(python, 2, set())
    try:
        processes.ask("commands", space)
        before = processes.ask("atoms", gathered(simulation))
        processes.ask("commands", [*motion, f"neighbor {0.2 * scene.smoothing_length!r} bin", "run 0"])
        after = [len(state["id"]) // 4 for state in processes.ask("state", ())]
    finally:
        processes.end()
    assert sum(after) == sum(before) and max(before) > 1.15 * min(before)
    assert max(after) < 1.06 * min(after)


@pytest.mark.parametrize(
    ("problem", "dim", "neighbours"),
    [("box", 2, 20), ("box", 3, 57), ("falling", 2, 20), ("block", 3, 57)],
)
def test_they_take_turns(python, problem, dim, neighbours):
    result = measure(
        BenchProblem(problem, dim, 3000, neighbours, "double"), alone(), Ceiling(1e10, 1e10), python
    )
    peer = result["peer"]
    assert peer["name"] == "LAMMPS" and int(peer["version"]) > 20200101 and peer["ranks"] == 1
    assert peer["ratio"] > 0.0 and peer["skin"] in peer["skins_tried"]
    pairs = peer["particle_steps_per_second"] * result["neighbours"]
    assert peer["pairs_per_second"] == pytest.approx(pairs, rel=1e-2)


def test_it_simulates_the_same(python):
    scene, simulation = simulation_of(Falling.nearest(2, 20, 3000))
    simulation.step()
    before = rows(gathered(simulation), "x")
    space, motion = commands(scene, simulation)
    processes = Processes(python, 1, set())
    try:
        processes.ask("commands", space)
        processes.ask("atoms", gathered(simulation))
        processes.ask("commands", [*motion, f"neighbor {0.2 * scene.smoothing_length!r} bin"])
        end = simulation.time + 40 * simulation.dt
        processes.ask("commands", ["run 80 post no"])
        [theirs] = processes.ask("state", ("x",))
    finally:
        processes.end()
    while simulation.time < end - 1e-9:
        simulation.step()
    ours = rows(gathered(simulation), "x")
    order = np.argsort(np.frombuffer(theirs["id"], np.int32))
    theirs = rows(theirs, "x")[order]
    way, apart = (np.linalg.norm(ours - other, axis=1) for other in (before, theirs))
    water = way > 0.0
    assert water.sum() > 500 and (apart[~water] == 0.0).all()
    assert np.median(apart[water]) < 0.1 * np.median(way[water])


def test_a_block_in_its_words():
    scene, simulation = simulation_of(Block.nearest(3, 57, 216))
    said = sum(lammps_solid.commands(scene, simulation), [])
    [solids] = simulation.engine.kinds
    assert solids.pairs() == round(216 * solids.neighbours) > 216 * 20
    dx = 1.0 / 6.0
    assert "atom_style smd" in said and "fix move tlsph smd/integrate_tlsph" in said
    assert (
        "pair_coeff 1 1 *COMMON 1100.0 17000000.0 0.45 0.06 0.0 10.0 1.0 *STRENGTH_LINEAR *EOS_LINEAR *END"
        in said
    )
    given = {line.split()[3]: float(line.split()[4]) for line in said if line.startswith("set group all")}
    assert given == pytest.approx(
        {
            "volume": dx**3,
            "smd/mass/density": 1100.0,
            "diameter": 2.0 * 2.0**0.5 * dx,
            "smd/contact/radius": 0.5 * dx,
        }
    )


def test_it_turns_the_same_block_with_the_same_neighbours(python):
    scene, simulation = simulation_of(Block.nearest(3, 57, 512))
    simulation.step()
    begun = lammps_solid.gathered(simulation)
    space, motion = lammps_solid.commands(scene, simulation)
    processes = Processes(python, 1, set())
    reach = lammps_solid.support(scene, simulation)
    try:
        processes.ask("commands", space)
        processes.ask("atoms", begun)
        processes.ask("commands", [*motion, f"neighbor {0.1 * reach!r} bin", "run 160 post no"])
        [theirs] = processes.ask("state", lammps_solid.CHECKED)
    finally:
        processes.end()
    end = simulation.time + 80 * simulation.dt
    while simulation.time < end - 1e-9:
        simulation.step()
    ours, before = (rows(state, "x") for state in (lammps_solid.gathered(simulation), begun))
    order = np.argsort(np.frombuffer(theirs["id"], np.int32))
    way = np.linalg.norm(ours - before, axis=1)
    apart = np.linalg.norm(ours - rows(theirs, "x")[order], axis=1)
    assert np.median(apart) < 0.05 * np.median(way)


def test_places_tell_of_a_block_that_flies_apart():
    scene, simulation = simulation_of(Block.nearest(2, 20, 36))
    whole = lammps_solid.gathered(simulation)
    assert lammps_solid.blown_up(scene, [whole]) == ""
    x = rows(whole, "x").copy()
    x[3, 0] = 10.0
    assert "a particle is at 14" in lammps_solid.blown_up(scene, [whole, {"x": x.tobytes()}])
    x[3, 0] = np.nan
    assert lammps_solid.blown_up(scene, [{"x": x.tobytes()}])


def rows(state, name):
    """A vector of all particles, (n, 3)."""
    return np.frombuffer(state[name]).reshape(-1, 3)


def test_a_blow_up_is_said(python):
    scene, simulation = simulation_of(FluidBox.nearest(2, 20, 400))
    with Peer(python, scene, simulation, FluidBox.peer) as peer:
        peer.check()
        peer._processes.ask("commands", ["set group all sph/rho 500.0"])
        with pytest.raises(BenchError, match="LAMMPS blew up: densities of 0.5 to 0.5 of"):
            peer.check()


def test_its_ranks_are_its_own(python):
    processes = Processes(python, 2, set())
    try:
        assert len(processes.ask("version")) == 2
        with pytest.raises(BenchError, match="LAMMPS: ERROR: Unknown command: nonsense"):
            processes.ask("commands", ["nonsense"])
    finally:
        processes.end()


def test_without_lammps_it_says_what_to_do():
    if importlib.util.find_spec("lammps"):
        pytest.skip("LAMMPS is here")
    job = subprocess.run(
        [sys.executable, *["-m", "psph", "bench", "--dimensions", "2", "--particles", "400", "--peer"]],
        capture_output=True,
        text=True,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
    )
    assert job.returncode == 2 and len(job.stderr.strip().splitlines()) == 1
    assert "No module named 'lammps'" in job.stderr and "pip install psph[peer]" in job.stderr


def test_a_python_that_is_not_there(tmp_path):
    scene, simulation = simulation_of(FluidBox.nearest(2, 20, 400))
    with pytest.raises(BenchError, match="bench --peer: .*nowhere: No such file.*psph\\[peer\\]"):
        Peer(tmp_path / "nowhere", scene, simulation, FluidBox.peer)
